// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/arguments.h"

#include "spheretree/error.h"

#include <charconv>
#include <cstdio>
#include <exception>
#include <ompl/util/Console.h>
#include <string_view>

namespace spherule {
namespace {

int number_of(const std::string& option, std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1) {
    throw Error(option, "needs a whole number above zero");
  }
  return value;
}

PlanningArguments parsed(int count, char** values, bool many) {
  const std::string known = many ? "--out DIR, --effort N and --problems N are known"
                                 : "--out DIR and --effort N are known";
  PlanningArguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string option = values[i];
    if (i + 1 == count) throw Error(option, "unknown option, or its value is lacking; " + known);
    const char* const value = values[++i];
    if (option == "--out") {
      arguments.out = value;
    } else if (option == "--effort") {
      arguments.effort = number_of(option, value);
    } else if (many && option == "--problems") {
      arguments.problems = static_cast<std::size_t>(number_of(option, value));
    } else {
      throw Error(option, "unknown option; " + known);
    }
  }
  return arguments;
}

}  // namespace

int run_planning_program(const std::string& name, int count, char** values, bool many,
                         const std::function<void(const PlanningArguments&)>& run) {
  try {
    const PlanningArguments arguments = parsed(count, values, many);
    std::filesystem::create_directories(arguments.out);
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    run(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
}

}  // namespace spherule
