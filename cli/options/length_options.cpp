// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/length_options.h"

#include "base/error.h"
#include "cli/help/command_specification.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <string_view>

namespace spherule {
namespace {

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
                                const std::string& help, std::function<void(double)> set) {
  const auto take = [this, names, set = std::move(set)](const std::string& text) {
    const std::optional<Length> length = parse_length(text);
    if (!length) return;  // the check has refused it
    if (length->unit == nullptr) {
      set(length->value);
    } else {
      pending_.push_back({names, *length, set});
    }
  };
  return command.add_option_function<std::string>(names, take, help)->type_name(kLength);
}

CLI::Option* LengthOptions::add(CLI::App& command, const std::string& names, double& length,
                                const std::string& help) {
  return add(command, names, help, [&length](double value) { length = value; })
      ->check(check_length);
}

CLI::Option* LengthOptions::add(CLI::App& command, const std::string& names,
                                std::optional<double>& length, const std::string& help) {
  return add(command, names, help, [&length](double value) { length = value; })
      ->check(check_length);
}

CLI::Option* LengthOptions::add_positive(CLI::App& command, const std::string& names,
                                         double& length, const std::string& help) {
  return add(command, names, help, [&length](double value) { length = value; })
      ->check(check_positive_length);
}

CLI::Option* LengthOptions::add_positive(CLI::App& command, const std::string& names,
                                         std::optional<double>& length, const std::string& help) {
  return add(command, names, help, [&length](double value) { length = value; })
      ->check(check_positive_length);
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
