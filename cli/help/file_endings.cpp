// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/file_endings.h"

#include <initializer_list>
#include <map>

namespace spherule {
namespace {

FileEndings joined(std::initializer_list<FileEndings> lists) {
  FileEndings all;
  for (const FileEndings& one : lists) all.insert(all.end(), one.begin(), one.end());
  return all;
}

}  // namespace

const FileEndings& mesh_endings() {
  static const FileEndings kEndings = {"stl", "obj", "ply", "off", "dae", "3mf", "gltf", "glb"};
  return kEndings;
}

FileEndings endings_for(const std::string& argument) {
  static const FileEndings kModel = joined({mesh_endings(), {"step", "stp", "iges", "igs"}});
  static const FileEndings kSpheres = {"json", "yml", "yaml", "xrdf", "urdf", "srdf"};
  static const std::map<std::string, FileEndings> kOfArguments = {
      {"mesh", kModel},
      {"more", joined({kModel, {"json"}})},
      {"urdf", {"urdf", "xacro"}},
      {"srdf", {"srdf"}},
      {"a", {"tree"}},
      {"b", {"tree"}},
      {"scene", {"json"}},
      {"trajectory", {"csv", "txt"}},
      {"spheres", kSpheres}};
  const auto found = kOfArguments.find(argument);
  return found == kOfArguments.end() ? FileEndings{} : found->second;
}

}  // namespace spherule
