// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"
#include "spheretree/error.h"

#include <array>
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

  void number(const char* key, double& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    if (const auto* whole = std::get_if<std::int64_t>(found)) {
      value = static_cast<double>(*whole);
    } else if (const auto* real = std::get_if<double>(found)) {
      value = *real;
    } else {
      throw Error(key, "must be a number");
    }
  }

  template <typename Integer>
  void count(const char* key, Integer& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* whole = std::get_if<std::int64_t>(found);
    if (whole == nullptr || *whole < 0) throw Error(key, "must be a whole number, not negative");
    value = static_cast<Integer>(*whole);
  }

  template <typename Enum, std::size_t N>
  void choice(const char* key, const Names<Enum, N>& names, Enum& value) const {
    const OptionValue* found = find(key);
    if (found == nullptr) return;
    const auto* text = std::get_if<std::string>(found);
    for (const auto& [candidate, name] : names) {
      if (text != nullptr && *text == name) {
        value = candidate;
        return;
      }
    }
    throw Error(key, "unknown value");
  }

 private:
  const OptionValue* find(const char* key) const {
    const auto it = record_.find(key);
    return it == record_.end() ? nullptr : &it->second;
  }

  const std::map<std::string, OptionValue>& record_;
};

}  // namespace

std::map<std::string, OptionValue> option_record(const SimplifyOptions& options, double scale) {
  return {{"scale", scale},
          {"max-error", options.max_error},
          {"min-external", options.min_external_diameter},
          {"padding", options.padding},
          {"min-radius", options.min_radius},
          {"method", name_of(kMethods, options.method)},
          {"external", name_of(kPlacements, options.external)},
          {"external-limit", static_cast<std::int64_t>(options.external_limit)},
          {"min-internal", options.min_internal_diameter},
          {"seed", static_cast<std::int64_t>(options.seed)}};
}

SimplifyOptions options_from_record(const std::map<std::string, OptionValue>& record) {
  SimplifyOptions options;
  const Reader read(record);
  read.number("max-error", options.max_error);
  read.number("min-external", options.min_external_diameter);
  read.number("padding", options.padding);
  read.number("min-radius", options.min_radius);
  read.choice("method", kMethods, options.method);
  read.choice("external", kPlacements, options.external);
  read.count("external-limit", options.external_limit);
  read.number("min-internal", options.min_internal_diameter);
  read.count("seed", options.seed);
  return options;
}

SphereFile sphere_file(const Simplification& simplification, double scale) {
  return {simplification.cover.spheres, record(simplification.certificate),
          option_record(simplification.options, scale)};
}

}  // namespace spherule
