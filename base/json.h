// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// JSON texts, with what nlohmann's parser lets pass refused.

#include "base/parser_fault.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

inline constexpr std::size_t kDeepestJson = 200;
inline constexpr std::size_t kMostOrderedKeys = std::size_t{1} << 13;

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

// What nlohmann's parser would let pass: nesting, keys that are there twice, and more keys of an
// object than `max_keys`. An event handler: a filter of its parser would search each array again
// after every object in it.
template <class Json>
class JsonCheck : public Json::json_sax_t {
 public:
  explicit JsonCheck(std::size_t max_keys) : max_keys_(max_keys) {}

  // The first fault; empty where there is none.
  const std::string& fault() const { return fault_; }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(typename Json::number_integer_t) override { return true; }
  bool number_unsigned(typename Json::number_unsigned_t) override { return true; }
  bool number_float(typename Json::number_float_t, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(typename Json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool key(std::string& key) override {
    std::set<std::string>& known = keys_.back();
    if (!known.insert(key).second) return refuse("the key \"" + key + "\" appears twice");
    return known.size() <= max_keys_ || refuse("an object has too many keys");
  }
  bool parse_error(std::size_t, const std::string&,
                   const typename Json::exception& error) override {
    return refuse(json_fault(error.what()));
  }

 private:
  bool open() {
    keys_.emplace_back();
    return keys_.size() <= kDeepestJson || refuse("is nested too deeply");
  }
  bool close() {
    keys_.pop_back();
    return true;
  }
  bool refuse(const std::string& fault) {
    fault_ = fault;
    return false;
  }

  std::size_t max_keys_;
  std::vector<std::set<std::string>> keys_;  // of the open objects; none of an array
  std::string fault_;
};

// The document of a JSON text; Json is nlohmann::json or its like. What is no JSON is refused, so
// is what is nested deeper than kDeepestJson, a key that an object holds twice, of which nlohmann's
// parser would silently keep the last, and more than kMostOrderedKeys keys of an object where Json
// keeps their order, as it searches them one after the other: `refuse(reason)` has to throw.
template <class Json, class Refuse>
JsonDocument<Json> parse_json(std::string_view text, const Refuse& refuse) {
  // An ordered object is a vector.
  constexpr bool is_ordered = requires(typename Json::object_t object) {
    object.capacity();
  };
  JsonCheck<Json> check(is_ordered ? kMostOrderedKeys : ~std::size_t{0});
  Json::sax_parse(text, &check);
  if (!check.fault().empty()) refuse(check.fault());
  return JsonDocument<Json>(Json::parse(text));
}

}  // namespace spherule::internal
