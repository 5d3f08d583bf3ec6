// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/own_headers.h"

#include "tests/structure/rooms.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace spherule {
std::vector<std::string> missing_own_headers(const Sources& sources) {
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
    const std::set<const Source*> seen = with_included(sources, file);
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
