// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/repository.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

namespace spherule {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> files_of_sources(const fs::path& root) {
  std::vector<std::string> files;
  for (const char* folder : {".ci", "adapters", "bench", "cli", "collide", "examples", "mesh",
                             "python", "robot", "simplifier", "spheretree", "tests"}) {
    for (auto entry = fs::recursive_directory_iterator(root / folder);
         entry != fs::recursive_directory_iterator(); ++entry) {
      if (entry->path() == root / "bench" / "out") entry.disable_recursion_pending();
      if (!entry->is_regular_file()) continue;
      files.push_back(fs::relative(entry->path(), root).generic_string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_cpp(std::string_view path) {
  return path.ends_with(".h") || path.ends_with(".cpp");
}

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex kInclude(R"re((?:^|\n) *# *include +([<"])([^>"]+))re");
  constexpr std::string_view kInstalled = "spherule/";
  std::vector<Include> includes;
  for (std::sregex_iterator at(text.begin(), text.end(), kInclude), end; at != end; ++at) {
    std::string target = (*at)[2];
    const bool is_installed = target.starts_with(kInstalled);
    if (is_installed) target.erase(0, kInstalled.size());
    includes.push_back({target, is_installed || (*at)[1] == "\""});
  }
  return includes;
}

}  // namespace spherule
