// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The text of a URDF file, and the names of files in it.

#include <filesystem>
#include <string>
#include <string_view>

namespace spherule::internal {

// The text of a URDF file; of one for xacro (its name ends in .xacro), what `xacro`, as the PATH
// has it, makes of it without arguments. What xacro has to say goes to standard error. Throws
// Error, naming the file, where it cannot be read, or there is no such program or it fails.
std::string urdf_text(const std::filesystem::path& path);

// The name of a mesh or texture as a URDF gives it, told apart by what stands in front: package://
// and file:// can be followed, other schemes cannot, and anything else is a path.
struct MeshName {
  enum class Kind { kPath, kFile, kPackage, kOtherScheme };
  Kind kind = Kind::kPath;
  std::string_view scheme;  // "file://", "package://" or nothing
  std::string_view rest;    // what stands behind it
};

// Refers to `name`.
inline MeshName mesh_name(std::string_view name) {
  const auto with = [&](MeshName::Kind kind, std::string_view scheme) {
    return MeshName{kind, name.substr(0, scheme.size()), name.substr(scheme.size())};
  };
  constexpr std::string_view kPackage = "package://";
  constexpr std::string_view kFile = "file://";
  if (name.starts_with(kPackage)) return with(MeshName::Kind::kPackage, kPackage);
  if (name.starts_with(kFile)) return with(MeshName::Kind::kFile, kFile);
  const bool has_scheme = name.find("://") != std::string_view::npos;
  return with(has_scheme ? MeshName::Kind::kOtherScheme : MeshName::Kind::kPath, {});
}

}  // namespace spherule::internal
