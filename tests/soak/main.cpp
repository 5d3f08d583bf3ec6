// SPDX-License-Identifier: BSD-3-Clause
// The soak, or a part of it. See tests/soak/README.md.
#include "base/error.h"
#include "tests/soak/soak_plan.h"
#include "tests/support/program.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr const char* kUsage =
    "usage: spherule_soak --state FILE [--seed S] [--scale SHARE] [--resume] [--only PART]...\n"
    "                     [--command SPHERULE] [--failing-new OBJECT] [--table | --chunk QUESTION "
    "N]\n"
    "Runs the chunks of the soak's parts (poses, motions, configurations; kills and memory with "
    "the\n"
    "command; threads) and records each in FILE, with --resume those that are not there yet.\n"
    "--table prints what is recorded and fails if anything went wrong; --chunk runs one chunk "
    "again.\n";

struct Arguments {
  std::string state;
  SoakSettings settings;
  SoakPrograms programs;
  std::vector<std::string> only;
  std::string question;
  std::uint64_t chunk = 0;
  bool resume = false;
  bool table = false;
  bool help = false;
};

Arguments parse(int count, char** values) {
  Arguments arguments;
  int i = 1;
  const auto value_of = [&](const std::string& option) -> std::string {
    if (i == count) throw Error(option, "unknown option, or its value is lacking");
    return values[i++];
  };
  while (i < count) {
    const std::string option = values[i++];
    if (option == "--help") {
      arguments.help = true;
    } else if (option == "--resume") {
      arguments.resume = true;
    } else if (option == "--table") {
      arguments.table = arguments.resume = true;
    } else if (option == "--state") {
      arguments.state = value_of(option);
    } else if (option == "--seed") {
      arguments.settings.seed =
          static_cast<std::uint64_t>(count_argument(option, value_of(option), 0, INT64_MAX));
    } else if (option == "--scale") {
      arguments.settings.scale = number_argument(option, value_of(option), 1e-6, 1.0);
    } else if (option == "--only") {
      arguments.only.push_back(value_of(option));
    } else if (option == "--command") {
      arguments.programs.command = value_of(option);
    } else if (option == "--failing-new") {
      arguments.programs.failing_new = value_of(option);
    } else if (option == "--chunk") {
      arguments.question = value_of(option);
      arguments.chunk =
          static_cast<std::uint64_t>(count_argument(option, value_of(option), 0, INT64_MAX));
    } else {
      throw Error(option, "unknown option");
    }
  }
  return arguments;
}

int show_chunk(const SoakQuestion& question, const Arguments& arguments) {
  const SoakRecord record = run_chunk(question, arguments.chunk, arguments.settings);
  std::printf("%s\n", encode_record(record).c_str());
  return record.is_clean() ? 0 : 1;
}

int run(const Arguments& arguments) {
  if (arguments.help) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  std::vector<SoakQuestion> questions = soak_questions(arguments.programs);
  for (const SoakQuestion& question : questions) {
    if (question.name == arguments.question) return show_chunk(question, arguments);
  }
  if (!arguments.question.empty()) throw Error(arguments.question, "is not a question");
  if (arguments.state.empty()) throw Error("--state", "is required");
  SoakState state(arguments.state, arguments.settings, arguments.resume);
  if (!arguments.only.empty()) {
    std::erase_if(questions, [&](const SoakQuestion& question) {
      return std::ranges::find(arguments.only, question.part) == arguments.only.end();
    });
  }
  if (arguments.table) return print_table(questions, state, true, stdout) ? 0 : 1;
  run_soak(questions, state);
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_soak",
                               [&] { return spherule::run(spherule::parse(count, values)); });
}
