// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/rules.h"

#include "tests/structure/repository.h"
#include "tests/structure/rooms.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <span>
#include <sstream>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// The first part of an include in angle brackets (its end, for what begins with a dot), and the
// third party it stands for. What is not listed and has a slash or ends in .h is unknown, and so
// refused.
struct Prefix {
  std::string_view start;
  std::string_view third_party;
};
constexpr Prefix kPrefixes[] = {{"Eigen/", "Eigen"},
                                {"nlohmann/", "nlohmann"},
                                {"assimp/", "assimp"},
                                {"zlib.h", "zlib"},
                                {"tbb/", "tbb"},
                                {"oneapi/tbb/", "tbb"},
                                {"fcl/", "fcl"},
                                {"ccd/", "ccd"},
                                {"CLI/", "CLI"},
                                {"gtest/", "gtest"},
                                {"gmock/", "gmock"},
                                {"benchmark/", "benchmark"},
                                {"boost/", "boost"},
                                {"gmp", "gmp"},
                                {"mpfr", "gmp"},
                                {"kdl/", "kdl"},
                                {"console_bridge/", "urdfdom"},
                                {"urdf_parser/", "urdfdom"},
                                {"urdf_model/", "urdfdom"},
                                {"tinyxml2.h", "tinyxml2"},
                                {"yaml-cpp/", "yaml-cpp"},
                                {"ompl/", "ompl"},
                                {"bullet/", "bullet"},
                                {"LinearMath/", "bullet"},
                                {"hacd", "bullet"},
                                {"meshoptimizer.h", "meshoptimizer"},
                                {"openvdb/", "openvdb"},
                                {"libqhull", "qhull"},
                                {".hxx", "opencascade"},
                                {"pybind11/", "pybind11"},
                                {"mpi.h", "mpi"},
                                {"spherule/", "spherule"}};

// Of the machine rather than of the language: allowed everywhere, or in one folder only.
constexpr std::string_view kSystemHeaders[] = {
    "fcntl.h",     "semaphore.h",    "signal.h",    "spawn.h",    "stdlib.h",
    "unistd.h",    "sys/stat.h",     "sys/types.h", "sys/wait.h", "sys/file.h",
    "sys/prctl.h", "sys/resource.h", "dlfcn.h"};
constexpr std::string_view kSimdHeaders[] = {"emmintrin.h", "immintrin.h", "arm_neon.h", "cpuid.h"};
constexpr std::string_view kSimdFolders[] = {"collide/kernels/", "collide/mechanism/",
                                             "collide/meshes/", "collide/search/"};

template <class Range>
bool contains(const Range& range, std::string_view value) {
  return std::find(std::begin(range), std::end(range), value) != std::end(range);
}

std::string check_own_include(const Room& room, std::string_view target) {
  const Room* included = room_of(target);
  if (!included) return "does not start at the root of the project";
  if (!may_include(&room, included)) {
    return "points the wrong way: " + std::string(room.folder) + " may not include " +
           std::string(included->folder);
  }
  const std::string_view library = library_of(target);
  const bool sees_internals = room.folder == "tests" || room.folder == "bench" ||
                              room.folder == "simplifier/baseline" ||
                              room.folder == "simplifier/cad" || room.folder == "python";
  if (library != library_of(room.folder) && target.find("/internal/") != std::string_view::npos &&
      !sees_internals) {
    return "is private to " + std::string(library);
  }
  return {};
}

std::string check_foreign_include(const std::string& path, const Room& room,
                                  std::string_view target) {
  if (contains(kSystemHeaders, target)) return {};
  if (contains(kSimdHeaders, target)) {
    const bool is_there =
        std::any_of(std::begin(kSimdFolders), std::end(kSimdFolders),
                    [&](std::string_view folder) { return path.starts_with(folder); });
    return is_there ? "" : "is for the kernels of collide/ only";
  }
  for (const auto& [start, third_party] : kPrefixes) {
    if (!(start.starts_with('.') ? target.ends_with(start) : target.starts_with(start))) continue;
    if (contains(room.third_parties, third_party)) return {};
    std::string files;
    for (const auto& [name, file] : room.files_that_see) {
      if (name != third_party) continue;
      if (path == file) return {};
      files += files.empty() ? std::string(file) : " and " + std::string(file);
    }
    if (!files.empty()) return "is for " + files + " only";
    return "is a third party that " + std::string(room.folder) + " may not see";
  }
  const bool standard = target.find_first_of("/.") == std::string_view::npos;
  return standard ? "" : "is not a header that the rules know";
}

bool is_source(const fs::path& path) {
  static const std::set<std::string> kExtensions = {".h",   ".cpp", ".cmake", ".in", ".py",
                                                    ".pyi", ".js",  ".css",   ".sh"};
  const std::string name = path.filename().string();
  return kExtensions.contains(path.extension().string()) || name == "CMakeLists.txt" ||
         name == "run";
}

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

std::vector<std::string> check_file(const std::string& path, std::string_view text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">].*)");
  std::vector<std::string> problems;
  const auto report = [&](std::size_t line, const std::string& what) {
    problems.push_back(path + ":" + std::to_string(line) + ": " + what);
  };
  const std::vector<std::string> lines = split_lines(text);
  // A script starts with the program that runs it.
  const std::size_t spdx = !lines.empty() && lines[0].starts_with("#!") ? 1 : 0;
  if (lines.size() <= spdx ||
      lines[spdx].find("SPDX-License-Identifier: BSD-3-Clause") == std::string::npos) {
    report(spdx + 1, "the licence line is missing");
  }
  if (lines.size() > kMaxLines) {
    report(lines.size(), "is longer than " + std::to_string(kMaxLines) + " lines");
  }
  if (!is_cpp(path)) return problems;

  if (path.ends_with(".h") &&
      std::find(lines.begin(), lines.end(), "#pragma once") == lines.end()) {
    report(1, "#pragma once is missing");
  }
  const Room* room = room_of(path);
  if (!room) {
    report(1, "stands in no room of the project");
    return problems;
  }
  // nlohmann's operator[] and push_back() make an object or array of a null before they have memory
  // for it; where that fails, the value's destructor ends the process.
  static const std::regex kNullJson(R"(\b(Json|json|ordered_json) \w*[a-z];)");
  const bool is_installed = room->folder != "tests" && room->folder != "bench";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (is_installed && std::regex_search(lines[i], kNullJson)) {
      report(i + 1, "a JSON value has to begin as object() or array()");
    }
    std::smatch match;
    if (!std::regex_match(lines[i], match, kInclude)) continue;
    const std::string target = match[2];
    const std::string problem = match[1] == "\"" ? check_own_include(*room, target)
                                                 : check_foreign_include(path, *room, target);
    if (!problem.empty()) report(i + 1, "\"" + target + "\" " + problem);
  }
  return problems;
}

std::vector<std::string> check_first_include(const std::string& path, std::string_view text) {
  const std::string own = path.substr(0, path.rfind('.')) + ".h";
  const std::size_t first = text.find("\n#include ");
  if (first != text.npos && text.substr(first).starts_with("\n#include \"" + own + "\"")) return {};
  return {path + ": does not include " + own + " before all others"};
}

std::vector<std::string> check_public_headers(const std::string& folder, std::string_view cmake,
                                              const std::vector<std::string>& headers) {
  static const std::regex kList(R"(\bHEADERS\s([^)]*?)\bSOURCES\b)");
  const std::string text(cmake);
  std::smatch match;
  if (!std::regex_search(text, match, kList)) {
    return {folder + "/CMakeLists.txt: lists no HEADERS before SOURCES"};
  }
  // Some are added where another library is there.
  static const std::regex kMore(R"(\bFILE_SET\s+HEADERS\s+FILES\s([^)]*)\))");
  std::string names = match[1];
  for (std::sregex_iterator more(text.begin(), text.end(), kMore), end; more != end; ++more) {
    names.append(" ").append((*more)[1]);
  }
  std::istringstream list(names);
  const std::set<std::string> listed{std::istream_iterator<std::string>(list), {}};
  std::vector<std::string> problems;
  for (const std::string& header : headers) {
    const Room* room = room_of(folder + "/" + header);
    const bool is_private =
        (room && room->is_private) || ("/" + header).find("/internal/") != std::string::npos;
    if (is_private == listed.contains(header)) {
      problems.push_back(folder + "/" + header +
                         (is_private ? ": is private and must not be in HEADERS"
                                     : ": is neither in HEADERS nor in a private room"));
    }
  }
  return problems;
}

std::vector<std::string> check_sources(const fs::path& root, std::size_t& files) {
  std::vector<std::string> problems;
  files = 0;
  std::map<std::string, std::string> libraries;  // CMakeLists.txt of each, by folder
  std::vector<std::string> headers;
  const auto check = [&](const std::string& name) {
    const fs::path path = root / name;
    const std::string text = text_of(path);
    auto found = check_file(name, text);
    problems.insert(problems.end(), found.begin(), found.end());
    if (name.ends_with(".cpp") && fs::exists(fs::path(path).replace_extension(".h"))) {
      found = check_first_include(name, text);
      problems.insert(problems.end(), found.begin(), found.end());
    }
    ++files;
    if (name.ends_with(".h")) headers.push_back(name);
    if (name.ends_with("/CMakeLists.txt") && text.find("\nspherule_library(") != text.npos) {
      libraries.emplace(fs::path(name).parent_path().generic_string(), text);
    }
  };
  check("CMakeLists.txt");
  for (const std::string& file : files_of_sources(root)) {
    if (is_source(file)) check(file);
  }
  std::map<std::string, std::vector<std::string>> headers_of;
  for (const std::string& header : headers) {
    fs::path folder = fs::path(header).parent_path();  // and up to the innermost library
    while (!folder.empty() && !libraries.contains(folder.generic_string())) {
      folder = folder.parent_path();
    }
    if (folder.empty()) continue;
    headers_of[folder.generic_string()].push_back(
        header.substr(folder.generic_string().size() + 1));
  }
  for (const auto& [folder, cmake] : libraries) {
    const auto found = check_public_headers(folder, cmake, headers_of[folder]);
    problems.insert(problems.end(), found.begin(), found.end());
  }
  return problems;
}

}  // namespace spherule
