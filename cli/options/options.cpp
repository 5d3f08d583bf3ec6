// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/options.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/help/help.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>

namespace spherule {
namespace {

template <class IsGood>
std::string check(const std::string& text, const char* fault, IsGood is_good) {
  char* stop = nullptr;
  const double value = std::strtod(text.c_str(), &stop);
  if (stop == text.c_str() || *stop != '\0') return {};
  return std::isfinite(value) && is_good(value) ? "" : fault;
}

constexpr std::int64_t kMostShards = 1'000'000;

std::optional<Shard> shard_in(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos) return std::nullopt;
  const std::optional<std::int64_t> index = internal::whole_number(text.substr(0, slash));
  const std::optional<std::int64_t> of = internal::whole_number(text.substr(slash + 1));
  if (!index || !of || *index < 1 || *index > *of || *of > kMostShards) return std::nullopt;
  return Shard{static_cast<std::size_t>(*index), static_cast<std::size_t>(*of)};
}

std::string all_symbols() {
  std::string text;
  for (const LengthUnit& unit : length_units())
    text.append(text.empty() ? "" : ", ") += unit.symbol;
  return text;
}

std::string not_a_length(std::string_view text) {
  return "'" + std::string(text) + "' is not a number or a length with a unit (" + all_symbols() +
         ")";
}

}  // namespace

std::string check_not_negative(const std::string& text) {
  return check(text, "must be finite and not negative", [](double x) { return x >= 0.0; });
}

std::string check_positive(const std::string& text) {
  return check(text, "must be finite and above 0", [](double x) { return x > 0.0; });
}

CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& help) {
  return command.add_option(names, file, help)->type_name(kFile);
}

CLI::Option* add_file(CLI::App& command, const std::string& names, std::vector<std::string>& files,
                      const std::string& help) {
  return command.add_option(names, files, help)->type_name(kFile);
}

void add_file_argument(CLI::App& command, const std::string& name, std::string& file,
                       const std::string& help) {
  add_file(command, name, file, help)->required();
}

void add_file_argument(CLI::App& command, const std::string& name, std::vector<std::string>& files,
                       const std::string& help) {
  add_file(command, name, files, help)->required();
}

void repeat(const CLI::App& command, std::initializer_list<const char*> options,
            std::vector<std::string>& words) {
  for (const char* name : options) {
    const CLI::Option* option = command.get_option(name);
    const bool is_flag = option->get_type_size() == 0;
    for (const std::string& value : option->results()) {
      words.emplace_back(name);
      if (!is_flag) words.push_back(value);
    }
  }
}

void add_threads_option(CLI::App& command, int& threads, const std::string& result) {
  command.add_option("--threads", threads, "Threads, 0: all; " + result)->check(check_not_negative);
}

void add_search_options(CLI::App& command, const SearchOptions& options,
                        const std::string& effort_means, const std::string& seconds_mean) {
  // Without the check CLI11 takes -1 for the largest number; files store 63 bits.
  command.add_option("--seed", options.seed, "Seed of everything random")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  auto* effort = command.add_option("--effort", options.effort, effort_means);
  effort->check(check_not_negative);
  command
      .add_option_function<double>(
          "--seconds",
          [options](double seconds) {
            options.seconds = seconds;
            options.effort = std::numeric_limits<int>::max();
          },
          seconds_mean)
      ->check(check_positive)
      ->excludes(effort);
  add_threads_option(command, options.threads);
}

void add_external_spheres_flag(CLI::App& command, ReportContent& content) {
  command.add_flag_callback(
      "--external-spheres", [&content] { content = ReportContent::kAll; },
      "List every external sphere in the report, about 100 bytes each: for view, and for who wants "
      "to check what was simplified away");
}

ShardRange range_of(const Shard& shard, std::size_t count) {
  // As many as fit in each, and one more in the first ones.
  const std::size_t least = count / shard.of;
  const std::size_t more = count % shard.of;
  const std::size_t before = shard.index - 1;
  return {before * least + std::min(before, more), least + (before < more ? 1 : 0)};
}

bool is_dealt_to(const Shard& shard, std::size_t thing) {
  return thing % shard.of == shard.index - 1;
}

CLI::Option* add_shard_option(CLI::App& command, const std::string& help, Shard& shard) {
  return command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = *shard_in(text); }, help)
      ->check([](const std::string& text) {
        return shard_in(text) ? "" : "'" + text + "' is no shard: I/N with 1 <= I <= N, 3/8 say";
      })
      ->type_name("I/N");
}

LengthContext metres() {
  return {"", unit_named("m")->micrometres};
}

double converted(const Length& length, const std::string& option, const LengthContext& context) {
  if (length.unit == nullptr) return length.value;
  if (!context.micrometres) {
    throw Error(option, std::string("is in ") + length.unit->plural + ", but " + context.file +
                            " states no unit: say --units mm, or whatever its numbers are in");
  }
  return in_units_of(*context.micrometres, length);
}

std::string check_length(const std::string& text) {
  const std::optional<Length> length = parse_length(text);
  if (!length) return not_a_length(text);
  return std::isfinite(length->value) && length->value >= 0.0 ? ""
                                                              : "must be finite and not negative";
}

std::string check_positive_length(const std::string& text) {
  std::string fault = check_length(text);
  if (fault.empty() && !(parse_length(text)->value > 0.0)) fault = "must be above 0";
  return fault;
}

CLI::Option* LengthOptions::add(CLI::App& command, const std::string& names,
                                const std::string& help,
                                std::string (*fault_of)(const std::string&),
                                std::function<void(double)> set) {
  const auto take = [this, names, set = std::move(set)](const std::string& text) {
    const std::optional<Length> length = parse_length(text);
    if (!length) return;  // the check has refused it
    if (length->unit == nullptr) {
      set(length->value);
    } else {
      pending_.push_back({names, *length, set});
    }
  };
  return command.add_option_function<std::string>(names, take, help)
      ->type_name(kLength)
      ->check(fault_of);
}

void LengthOptions::convert(const LengthContext& context) const {
  for (const Pending& one : pending_) one.set(converted(one.length, one.option, context));
}

std::vector<double> lengths_in(const std::string& text, const std::string& option,
                               const LengthContext& context) {
  std::vector<double> lengths;
  std::string_view rest = text;
  for (;;) {
    const std::string_view one = rest.substr(0, rest.find(','));
    const std::optional<Length> length = parse_length(one);
    if (!length || !std::isfinite(length->value)) throw Error(option, not_a_length(one));
    lengths.push_back(converted(*length, option, context));
    if (one.size() == rest.size()) return lengths;
    rest.remove_prefix(one.size() + 1);
  }
}

}  // namespace spherule
