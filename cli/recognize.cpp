// SPDX-License-Identifier: BSD-3-Clause
#include "cli/recognize.h"

#include "spheretree/atomic_file.h"

#include <string>
#include <string_view>

namespace spherule {
namespace {

// What the two formats of the library begin with or hold (docs/tree-file.md, sphere_file.h).
constexpr std::string_view kTreeStart = "\x89SPT";
constexpr std::string_view kSphereFormat = "\"spherule-spheres\"";

}  // namespace

FileKind recognize(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (bytes.starts_with(kTreeStart)) return FileKind::kTree;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool is_object = first != std::string::npos && bytes[first] == '{';
  if (is_object && bytes.find(kSphereFormat) != std::string::npos) return FileKind::kSpheres;
  return FileKind::kMesh;
}

}  // namespace spherule
