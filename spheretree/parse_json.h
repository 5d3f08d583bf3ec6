// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// The document of a JSON text; Json is nlohmann::json or its like. What is no JSON is refused, and
// so is a key that an object holds twice, of which nlohmann's parser would silently keep the last:
// `refuse(reason)` has to throw.
template <class Json, class Refuse>
Json parse_json(std::string_view text, const Refuse& refuse) {
  using Event = typename Json::parse_event_t;
  std::vector<std::set<std::string>> keys;  // of the object at each depth
  std::string duplicate;
  const auto watch = [&](int depth, Event event, const Json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    if (event == Event::object_start) {
      keys.resize(level + 1);
      keys[level].clear();
    } else if (event == Event::key) {
      const auto& key = parsed.template get_ref<const std::string&>();
      if (!keys[level - 1].insert(key).second && duplicate.empty()) duplicate = "\"" + key + "\"";
    }
    return true;
  };
  Json document;
  try {
    document = Json::parse(text, watch);
  } catch (const typename Json::exception& error) {
    refuse(std::string("is not JSON: ") + error.what());
  }
  if (!duplicate.empty()) refuse("the key " + duplicate + " appears twice");
  return document;
}

}  // namespace spherule::internal
