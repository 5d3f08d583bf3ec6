// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace spherule {

// Notices keys that an object of a JSON text holds twice; nlohmann's parser would silently keep the
// last. Json is nlohmann::json or its like; see() is to be called from the parser's callback.
template <class Json>
class DuplicateKeys {
 public:
  // For nlohmann's parser to call at every event. Throws what is thrown for a key that is there
  // twice.
  void see(int depth, typename Json::parse_event_t event, const Json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    if (event == Json::parse_event_t::object_start) {
      keys_.resize(level + 1);
      keys_[level].clear();
    } else if (event == Json::parse_event_t::key) {
      const auto& key = parsed.template get_ref<const std::string&>();
      if (!keys_[level - 1].insert(key).second && duplicate_.empty())
        duplicate_ = "\"" + key + "\"";
    }
  }

  // The first key that is there twice, in quotes; empty if there is none.
  const std::string& duplicate() const { return duplicate_; }

 private:
  std::vector<std::set<std::string>> keys_;
  std::string duplicate_;
};

}  // namespace spherule
