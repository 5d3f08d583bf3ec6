// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/arguments.h"

#include "base/error.h"
#include "tests/support/program.h"

#include <ompl/util/Console.h>

namespace spherule {
namespace {

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
      arguments.effort = static_cast<int>(count_argument(option, value, 1));
    } else if (many && option == "--problems") {
      arguments.problems = static_cast<std::size_t>(count_argument(option, value, 1));
    } else {
      throw Error(option, "unknown option; " + known);
    }
  }
  return arguments;
}

}  // namespace

int run_planning_program(const std::string& name, int count, char** values, bool many,
                         const std::function<void(const PlanningArguments&)>& run) {
  return run_program(name.c_str(), [&] {
    const PlanningArguments arguments = parsed(count, values, many);
    std::filesystem::create_directories(arguments.out);
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    run(arguments);
    return 0;
  });
}

}  // namespace spherule
