// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// JSON texts, with what nlohmann's parser lets pass refused.

#include "base/error.h"
#include "base/text.h"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

inline constexpr std::size_t kDeepestJson = 200;
inline constexpr std::size_t kMostOrderedKeys = std::size_t{1} << 13;

// A value that is destroyed without memory being allocated: nlohmann's own destructor lists the
// elements of arrays and objects first, and ends the process where there is no memory for that.
template <class Json>
class JsonDocument : public Json {
 public:
  explicit JsonDocument(Json root) : Json(std::move(root)) {}
  JsonDocument(JsonDocument&&) noexcept = default;
  JsonDocument& operator=(JsonDocument&&) noexcept = default;
  // Iterators throw only for values without parts.
  ~JsonDocument() { dismantle(*this); }  // NOLINT(bugprone-exception-escape)

 private:
  // From the leaves to the root, at most kDeepestJson deep.
  static void dismantle(Json& value) {
    if (!value.is_structured()) return;
    for (Json& part : value) dismantle(part);
    value.clear();
  }
};

// The value of a JSON text; Json is nlohmann::json or nlohmann::ordered_json. What is no JSON is
// refused, so is what is nested deeper than kDeepestJson, a key that an object holds twice, of
// which nlohmann's parser would silently keep the last, and more than kMostOrderedKeys keys of an
// ordered object, as it searches them one after the other: `refuse(reason)` has to throw.
template <class Json>
JsonDocument<Json> parse_json(std::string_view text,
                              const std::function<void(const std::string&)>& refuse);

// A value of a document and where that is, for messages: an Error names the file and says what
// `place` is not. Refers to both.
template <class Json>
class JsonValue {
 public:
  // `place` is empty for the whole document.
  JsonValue(const Json& json, const std::string& file, std::string place = {})
      : json_(json), file_(file), place_(std::move(place)) {}

  JsonValue(const Json&&, const std::string&, std::string = {}) = delete;
  JsonValue(const Json&, const std::string&&, std::string = {}) = delete;

  const Json& json() const { return json_; }
  const std::string& place() const { return place_; }

  // Throws Error: "PLACE: REASON", or of the value itself "PLACE FAULT".
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(file_, place_.empty() ? reason : place_ + ": " + reason);
  }
  void unless(bool good, const std::string& reason) const {
    if (!good) refuse(reason);
  }
  [[noreturn]] void blame(const std::string& fault) const {
    throw Error(file_, place_.empty() ? fault : place_ + " " + fault);
  }
  void expect(bool good, const std::string& fault) const {
    if (!good) blame(fault);
  }

  // An object with no keys but these.
  void require_keys(std::initializer_list<std::string_view> keys) const {
    expect(json_.is_object(), "is not an object");
    for (const auto& [key, value] : json_.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      const std::vector<std::string> known(keys.begin(), keys.end());
      refuse("the key " + in_quotes(key) + " is not known here" + did_you_mean(key, known));
    }
  }
  // A member of an object, if it is there, or which has to be.
  std::optional<JsonValue> find(const char* key) const {
    expect(json_.is_object(), "is not an object");
    const auto found = json_.find(key);
    if (found == json_.end()) return std::nullopt;
    const std::string name = std::string("\"") + key + "\"";
    return JsonValue(*found, file_, place_.empty() ? name : place_ + ": " + name);
  }
  bool has(const char* key) const { return json_.contains(key); }
  JsonValue at(const char* key) const {
    const std::optional<JsonValue> found = find(key);
    if (!found) refuse(std::string("\"") + key + "\" is missing");
    return *found;
  }
  // Calls `take` with each element of a list, whose places are `what` and their numbers.
  template <class Take>
  void each(const std::string& what, const Take& take) const {
    expect(json_.is_array(), "is not a list");
    std::size_t index = 0;
    for (const Json& item : json_) take(JsonValue(item, file_, what + std::to_string(index++)));
  }
  // The same value at another place, and a part of it at the same place.
  JsonValue placed(std::string place) const { return JsonValue(json_, file_, std::move(place)); }
  JsonValue part(const Json& json) const { return JsonValue(json, file_, place_); }

  double number() const {
    expect(json_.is_number(), "is not a number");
    return json_.template get<double>();
  }
  std::string text() const {
    expect(json_.is_string(), "is not a text");
    return json_.template get<std::string>();
  }
  bool truth() const {
    expect(json_.is_boolean(), "is not true or false");
    return json_.template get<bool>();
  }
  // A list of so many numbers, which `what` describes.
  template <std::size_t kCount>
  std::array<double, kCount> numbers(const std::string& what) const {
    expect(json_.is_array() && json_.size() == kCount, "is not " + what);
    std::array<double, kCount> result{};
    for (std::size_t i = 0; i < kCount; ++i) result[i] = part(json_[i]).number();
    return result;
  }

 private:
  const Json& json_;
  const std::string& file_;
  std::string place_;
};

}  // namespace spherule::internal
