// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// JSON texts, with what nlohmann's parser lets pass refused.
//
// @code{.cpp}
// #include <spherule/spheretree/error.h>
// #include <spherule/spheretree/parse_json.h>
// #include <nlohmann/json.hpp>
// #include <cassert>
//
// const auto refuse = [](const std::string& reason) { throw spherule::Error("text", reason); };
// const std::string text = R"({"radius": 2.5})";
// const auto document = spherule::internal::parse_json<nlohmann::json>(text, refuse);
// assert(document.root()["radius"] == 2.5);
// @endcode

#include "spheretree/parser_fault.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

inline constexpr int kDeepestJson = 200;

// A JSON document that is destroyed without memory being allocated: nlohmann's own destructor lists
// the elements of arrays and objects first, and ends the process where there is no memory for that.
template <class Json>
class JsonDocument {
 public:
  explicit JsonDocument(Json root) : root_(std::move(root)) {}
  JsonDocument(JsonDocument&&) noexcept = default;
  JsonDocument& operator=(JsonDocument&&) = delete;
  ~JsonDocument() { dismantle(root_); }

  const Json& root() const { return root_; }

 private:
  // From the leaves to the root, at most kDeepestJson deep.
  static void dismantle(Json& value) {
    if (value.is_structured()) {
      for (Json& part : value) dismantle(part);
      value.clear();
    }
  }

  Json root_;
};

// The document of a JSON text; Json is nlohmann::json or its like. What is no JSON is refused, so
// is what is nested deeper than kDeepestJson, and a key that an object holds twice, of which
// nlohmann's parser would silently keep the last: `refuse(reason)` has to throw.
template <class Json, class Refuse>
JsonDocument<Json> parse_json(std::string_view text, const Refuse& refuse) {
  using Event = typename Json::parse_event_t;
  std::vector<std::set<std::string>> keys;  // of the object at each depth
  std::string duplicate;
  const auto watch = [&](int depth, Event event, const Json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    if (depth > kDeepestJson) refuse("is nested too deeply");
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
    refuse(json_fault(error.what()));
  }
  if (!duplicate.empty()) refuse("the key " + duplicate + " appears twice");
  return JsonDocument<Json>(std::move(document));
}

}  // namespace spherule::internal
