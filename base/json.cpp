// SPDX-License-Identifier: BSD-3-Clause
#include "base/json.h"

#include "base/parser_fault.h"

#include <nlohmann/json.hpp>

#include <set>
#include <type_traits>
#include <vector>

namespace spherule::internal {
namespace {

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

}  // namespace

template <class Json>
JsonDocument<Json> parse_json(std::string_view text,
                              const std::function<void(const std::string&)>& refuse) {
  constexpr bool kIsOrdered = std::is_same_v<Json, nlohmann::ordered_json>;
  JsonCheck<Json> check(kIsOrdered ? kMostOrderedKeys : ~std::size_t{0});
  Json::sax_parse(text, &check);
  if (!check.fault().empty()) refuse(check.fault());
  return JsonDocument<Json>(Json::parse(text));
}

template JsonDocument<nlohmann::json> parse_json(std::string_view,
                                                 const std::function<void(const std::string&)>&);
template JsonDocument<nlohmann::ordered_json> parse_json(
    std::string_view, const std::function<void(const std::string&)>&);

}  // namespace spherule::internal
