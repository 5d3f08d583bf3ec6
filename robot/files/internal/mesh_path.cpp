// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/mesh_path.h"

#include "robot/files/internal/xml_file.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <system_error>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// One that cannot be read is the root of nothing that is searched for.
std::string package_name(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!is_file(manifest)) return {};
  try {
    const XmlFile file(manifest, "package");
    const auto element = file.root().child("name");
    return element ? std::string(element->text()) : std::string();
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

MeshPaths::MeshPaths(const fs::path& urdf, const UrdfOptions& options)
    : folder_(fs::absolute(urdf).parent_path()), packages_(options.packages) {}

fs::path MeshPaths::package_root(const std::string& package) {
  if (above_.empty()) {
    for (fs::path at = folder_;; at = at.parent_path()) {
      above_.emplace_back(at, package_name(at));
      if (at == at.parent_path()) break;
    }
  }
  if (!missing_.contains(package)) {
    for (const auto& [folder, name] : above_) {
      if (name == package) return folder;
      if (package_name(folder / package) == package) return folder / package;
    }
    missing_.insert(package);
  }
  throw Error("package://" + package,
              "the folder of this package is not given (--package " + package +
                  "=FOLDER, UrdfOptions::packages), and no package.xml of that name stands in a "
                  "folder above the URDF file or beside one of them");
}

fs::path MeshPaths::find(const std::string& name) {
  constexpr std::string_view kPackage = "package://";
  constexpr std::string_view kFile = "file://";
  const std::string_view view = name;
  fs::path path;
  if (view.starts_with(kPackage)) {
    const std::size_t slash = std::min(view.find('/', kPackage.size()), view.size());
    const std::string package(view.substr(kPackage.size(), slash - kPackage.size()));
    if (package.empty()) throw Error(name, "it names no package");
    auto root = packages_.find(package);
    if (root == packages_.end()) root = packages_.emplace(package, package_root(package)).first;
    path = root->second / view.substr(std::min(slash + 1, view.size()));
  } else if (view.starts_with(kFile)) {
    path = folder_ / view.substr(kFile.size());
  } else if (view.find("://") != std::string_view::npos) {
    throw Error(name, "only package:// and file:// can be followed");
  } else {
    path = folder_ / view;
  }
  path = path.lexically_normal();
  if (!is_file(path)) throw Error(name, "there is no such file: " + path.string());
  return path;
}

}  // namespace spherule::internal
