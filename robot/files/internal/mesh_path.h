// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/files/urdf.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

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
