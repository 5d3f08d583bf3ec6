// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/option_record.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "simplifier/types/zones.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

template <typename Enum, std::size_t N>
using Names = std::array<std::pair<Enum, const char*>, N>;

constexpr Names<CoverMethod, 2> kMethods{
    {{CoverMethod::kCover, "cover"}, {CoverMethod::kPaper, "paper"}}};
constexpr Names<ExternalPlacement, 3> kPlacements{{{ExternalPlacement::kReachable, "reachable"},
                                                   {ExternalPlacement::kRandom, "random"},
                                                   {ExternalPlacement::kNone, "none"}}};

template <typename Enum, std::size_t N>
Enum named(const char* option, const Names<Enum, N>& names, const std::string& wanted) {
  for (const auto& [candidate, name] : names) {
    if (wanted == name) return candidate;
  }
  throw Error(option, "unknown value '" + wanted + "'");
}

template <typename Enum, std::size_t N>
std::vector<std::string> all_of(const Names<Enum, N>& names) {
  std::vector<std::string> all;
  for (const auto& entry : names) all.emplace_back(entry.second);
  return all;
}

template <typename Enum, std::size_t N>
std::string name_of(const Names<Enum, N>& names, Enum value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  throw Error("option", "unknown value");
}

// Reads the option `key` into `value` if it is in the record.
class Reader {
 public:
  explicit Reader(const std::map<std::string, OptionValue>& record) : record_(record) {}

  // A length.
  void length(const char* key, double& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    if (const auto* whole = std::get_if<std::int64_t>(found)) {
      value = static_cast<double>(*whole);
    } else if (const auto* real = std::get_if<double>(found)) {
      value = *real;
    } else {
      throw Error(key, "must be a number");
    }
    if (!(value >= 0.0 && value <= kMaxCoordinate)) {
      throw Error(key, "must be finite and not negative");
    }
  }

  template <typename Integer>
  void count(const char* key, Integer& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* whole = std::get_if<std::int64_t>(found);
    if (whole == nullptr || *whole < 0) throw Error(key, "must be a whole number, not negative");
    if (!std::in_range<Integer>(*whole)) throw Error(key, "is too large");
    value = static_cast<Integer>(*whole);
  }

  template <typename Enum, std::size_t N>
  void choice(const char* key, const Names<Enum, N>& names, Enum& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* text = std::get_if<std::string>(found);
    if (text == nullptr) throw Error(key, "must be a name");
    value = named(key, names, *text);
  }

  // Of stage 2.
  void method(const char* key, SimplifyOptions& options) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* text = std::get_if<std::string>(found);
    if (text == nullptr || text->empty()) throw Error(key, "must be a name");
    const auto is_named = [&](const auto& entry) { return *text == entry.second; };
    if (std::any_of(kMethods.begin(), kMethods.end(), is_named)) {
      options.method = method_named(*text);
    } else {
      options.stage2_method = Stage2Method{.name = *text};
    }
  }

  void flag(const char* key, bool& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* truth = std::get_if<bool>(found);
    if (truth == nullptr) throw Error(key, "must be true or false");
    value = *truth;
  }

  // The text of a zone file.
  void zones(const char* key, std::vector<Zone>& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* text = std::get_if<std::string>(found);
    if (text == nullptr) throw Error(key, "must be the text of a zone file");
    value = parse_zones(*text, key);
  }

  void levels(const char* key, std::vector<double>& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* text = std::get_if<std::string>(found);
    if (text == nullptr) throw Error(key, "must be a text");
    value = levels_named(*text);
  }

 private:
  const OptionValue* find(const char* key) const {
    const auto it = record_.find(key);
    return it == record_.end() ? nullptr : &it->second;
  }

  const std::map<std::string, OptionValue>& record_;
};

}  // namespace

std::vector<std::string> method_names() {
  return all_of(kMethods);
}

CoverMethod method_named(const std::string& name) {
  return named("method", kMethods, name);
}

std::vector<std::string> placement_names() {
  return all_of(kPlacements);
}

ExternalPlacement placement_named(const std::string& name) {
  return named("external", kPlacements, name);
}

std::vector<double> levels_named(const std::string& text) {
  std::vector<double> levels;
  std::string_view rest = text;
  for (;;) {
    const std::string_view number = rest.substr(0, rest.find(','));
    const std::optional<double> level = internal::finite_number(number);
    if (!level || !is_usable_coordinate(*level)) {
      throw Error("levels", internal::in_quotes(number) + " is not a number");
    }
    levels.push_back(*level);
    if (number.size() == rest.size()) return levels;
    rest.remove_prefix(number.size() + 1);
  }
}

std::string name_of_levels(std::span<const double> levels) {
  std::string text;
  for (const double level : levels) {
    if (!text.empty()) text += ',';
    text += internal::number_text(level);
  }
  return text;
}

std::map<std::string, OptionValue> option_record(const SimplifyOptions& options, double scale) {
  std::map<std::string, OptionValue> record{
      {"scale", scale},
      {"max-error", options.max_error},
      {"min-external", options.min_external_diameter},
      {"tightness", options.tightness},
      {"padding", options.padding},
      {"min-radius", options.min_radius},
      {"method",
       options.stage2_method ? options.stage2_method->name : name_of(kMethods, options.method)},
      {"external", name_of(kPlacements, options.external)},
      {"external-limit", static_cast<std::int64_t>(options.external_limit)},
      {"min-internal", options.min_internal_diameter},
      {"seed", static_cast<std::int64_t>(options.seed)},
      {"effort", std::int64_t{options.effort}},
      {"seconds", options.seconds}};
  // Absent where they are not used.
  if (!options.zones.empty()) record["zones"] = zones_text(options.zones);
  if (options.keep_concave_edges) record["keep-concave-edges"] = true;
  if (!options.levels.empty()) record["levels"] = name_of_levels(options.levels);
  return record;
}

SimplifyOptions options_from_record(const std::map<std::string, OptionValue>& record) {
  SimplifyOptions options;
  const Reader read(record);
  read.length("max-error", options.max_error);
  read.length("min-external", options.min_external_diameter);
  // Files without it were made before stage 1 was made tighter than its grid.
  options.tightness = ExternalOptions::kNoTightness;
  read.length("tightness", options.tightness);
  read.length("padding", options.padding);
  read.length("min-radius", options.min_radius);
  read.method("method", options);
  read.choice("external", kPlacements, options.external);
  read.count("external-limit", options.external_limit);
  read.length("min-internal", options.min_internal_diameter);
  read.count("seed", options.seed);
  read.count("effort", options.effort);
  read.length("seconds", options.seconds);
  read.zones("zones", options.zones);
  read.flag("keep-concave-edges", options.keep_concave_edges);
  read.levels("levels", options.levels);
  return options;
}

}  // namespace spherule
