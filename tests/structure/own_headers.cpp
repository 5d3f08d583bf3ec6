// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/own_headers.h"

#include "tests/structure/repository.h"
#include "tests/structure/rooms.h"
#include "tests/structure/source_names.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace spherule {
namespace {

struct Source {
  SourceNames names;
  std::vector<std::string> includes;
};
using Sources = std::map<std::string, Source>;

Source read(const std::filesystem::path& file) {
  const std::string text = text_of(file);
  Source source{names_in(text), {}};
  for (const Include& include : includes_of(text)) {
    if (include.is_ours) source.includes.push_back(include.target);
  }
  return source;
}

// A file and what it includes, as far as it is among the sources.
void collect(const std::string& name, const Sources& sources, std::set<const Source*>& seen) {
  const auto source = sources.find(name);
  if (source == sources.end() || !seen.insert(&source->second).second) return;
  for (const std::string& included : source->second.includes) collect(included, sources, seen);
}

}  // namespace

std::vector<std::string> missing_own_headers(const std::filesystem::path& root,
                                             const std::vector<std::string>& files) {
  Sources sources;
  for (const std::string& file : files) sources.emplace(file, read(root / file));
  std::map<std::string, std::vector<std::string>, std::less<>> headers_of;
  std::map<std::string, std::vector<std::string>, std::less<>> headers_of_function;
  for (const auto& [name, source] : sources) {
    if (!name.ends_with(".h")) continue;
    for (const std::string& offered : source.names.offered) headers_of[offered].push_back(name);
    for (const std::string& function : source.names.offered_functions) {
      headers_of_function[function].push_back(name);
    }
  }
  std::vector<std::string> missing;
  for (const auto& [file, source] : sources) {
    std::set<const Source*> seen;
    collect(file, sources, seen);
    const auto look = [&, &file = file](const auto& uses, const auto& headers) {
      for (const std::string& name : uses) {
        const auto known = headers.find(name);
        if (known == headers.end()) continue;
        const auto declares = [&](const Source* s) { return s->names.declared.contains(name); };
        if (std::any_of(seen.begin(), seen.end(), declares)) continue;
        const auto is_reachable = [&](const std::string& header) {
          return may_include(room_of(file), room_of(header));
        };
        const auto header = std::find_if(known->second.begin(), known->second.end(), is_reachable);
        if (header != known->second.end()) {
          missing.push_back(file + ": " + name + " needs " + *header);
        }
      }
    };
    look(source.names.used, headers_of);
    look(source.names.called, headers_of_function);
  }
  return missing;
}

}  // namespace spherule
