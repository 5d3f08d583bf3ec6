// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/urdf_files.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "robot/files/xml_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// As the package.xml of the folder says; empty where there is none that can be read.
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

// The file `rest` below a folder: of that name or, as in a URL, of the name that it escapes. A
// percent sign that begins no escape stays.
fs::path below(const fs::path& folder, std::string_view rest) {
  const fs::path path = folder / rest;
  const fs::path meant = folder / percent_decoded(rest).text;
  return !is_file(path) && is_file(meant) ? meant : path;
}

}  // namespace

bool is_xacro(const std::filesystem::path& path) {
  return path.extension() == ".xacro";
}

std::string urdf_text(const std::filesystem::path& path) {
  if (!is_xacro(path)) return read_file(path);
  const std::string file = path.string();
  // So that a name that begins with a dash is no option.
  const std::array<std::string, 1> arguments = {path.is_relative() ? "./" + file : file};
  ProgramOutput output = run_program("xacro", arguments, STDOUT_FILENO);
  if (!output.not_started.empty()) {
    throw Error(file, "needs the program xacro, which makes a URDF of it and cannot be run: " +
                          output.not_started);
  }
  if (WIFSIGNALED(output.status)) throw Error(file, "xacro was ended by a signal");
  if (WEXITSTATUS(output.status) != 0) {
    throw Error(file, "xacro makes no URDF of it (exit code " +
                          std::to_string(WEXITSTATUS(output.status)) + ")");
  }
  return std::move(output.bytes);
}

MeshPaths::MeshPaths(const fs::path& urdf, const UrdfOptions& options)
    : folder_(absolute_path(urdf).parent_path()), packages_(options.packages) {}

fs::path MeshPaths::package_root(const std::string& package) {
  if (!missing_.contains(package)) {
    std::size_t height = 0;
    for (fs::path at = folder_;; at = at.parent_path()) {
      if (height == above_.size()) above_.push_back(package_name(at));
      if (above_[height++] == package) return at;
      if (package_name(at / package) == package) return at / package;
      if (at == at.parent_path()) break;
    }
    missing_.insert(package);
  }
  throw Error("package://" + package,
              "the folder of this package is not given (--package " + package +
                  "=FOLDER, UrdfOptions::packages), and no package.xml of that name stands in a "
                  "folder above the URDF file or beside one of them");
}

fs::path MeshPaths::in_package(const std::string& name, std::string_view rest) {
  const std::size_t begin = std::min(rest.find_first_not_of('/'), rest.size());
  const std::size_t slash = std::min(rest.find('/', begin), rest.size());
  const std::string package(rest.substr(begin, slash - begin));
  if (package.empty()) throw Error(name, "it names no package");
  auto root = packages_.find(package);
  if (root == packages_.end()) root = packages_.emplace(package, package_root(package)).first;
  return below(root->second, rest.substr(std::min(slash + 1, rest.size())));
}

fs::path MeshPaths::find(const std::string& name) {
  const MeshName given = mesh_name(name);
  fs::path path;
  switch (given.kind) {
    case MeshName::Kind::kPackage:
      path = in_package(name, given.rest);
      break;
    case MeshName::Kind::kFile:
      path = below(folder_, given.rest);
      break;
    case MeshName::Kind::kPath:
      path = folder_ / given.rest;
      break;
    case MeshName::Kind::kOtherScheme:
      throw Error(name, "only package:// and file:// can be followed");
  }
  path = path.lexically_normal();
  if (is_file(path)) return path;
  if (name.find("$(") != name.npos || name.find("${") != name.npos) throw Error(name, kIsForXacro);
  throw Error(name, "there is no such file: " + path.string());
}

}  // namespace spherule::internal
