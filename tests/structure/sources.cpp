// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/sources.h"

namespace spherule {
namespace {

void collect(const Sources& sources, const std::string& file, std::set<const Source*>& seen) {
  const auto source = sources.find(file);
  if (source == sources.end() || !seen.insert(&source->second).second) return;
  for (const Include& include : source->second.includes) {
    if (include.is_ours) collect(sources, include.target, seen);
  }
}

}  // namespace

Sources read_sources(const std::filesystem::path& root, const std::vector<std::string>& files) {
  Sources sources;
  for (const std::string& file : files) {
    const std::string text = text_of(root / file);
    sources.emplace(file, Source{names_in(text), includes_of(text)});
  }
  return sources;
}

Sources all_sources(const std::filesystem::path& root) {
  std::vector<std::string> files = files_of_sources(root);
  std::erase_if(files, [](const std::string& file) { return !is_cpp(file); });
  return read_sources(root, files);
}

std::set<const Source*> with_included(const Sources& sources, const std::string& file) {
  std::set<const Source*> seen;
  collect(sources, file, seen);
  return seen;
}

}  // namespace spherule
