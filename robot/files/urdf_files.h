// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The text of a URDF file, and the files that it names.

#include "robot/files/urdf.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// Why a file of another name is refused that holds what only that program understands.
inline constexpr const char* kIsForXacro =
    "this is for xacro, which makes a URDF of it: rename the file, so that it ends in .xacro";

// Whether the name of the file says that it is one for the program `xacro`: it ends in .xacro.
bool is_xacro(const std::filesystem::path& path);

// The text of a URDF file; of one for xacro, what `xacro`, as the PATH has it, makes of it without
// arguments. What xacro has to say goes to standard error. Throws Error, naming the file, where it
// cannot be read, or there is no such program or it fails.
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

// Where the files are that a URDF file names.
class MeshPaths {
 public:
  MeshPaths(const std::filesystem::path& urdf, const UrdfOptions& options);

  // Throws Error, whose subject is the name, for a file or package that cannot be found.
  std::filesystem::path find(const std::string& name);

 private:
  // Of `name`, what stands behind package://: a package and a file in it.
  std::filesystem::path in_package(const std::string& name, std::string_view rest);
  std::filesystem::path package_root(const std::string& package);

  std::filesystem::path folder_;
  // The packages that the folder of the file and those above it are, often none, as far as known.
  std::vector<std::string> above_;
  std::set<std::string> missing_;
  std::map<std::string, std::filesystem::path> packages_;  // given, and found since
};

}  // namespace spherule::internal
