// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/text.h"
#include "cli/commands/command.h"
#include "cli/help/command_specification.h"
#include "cli/help/help.h"
#include "cli/help/usage_error.h"
#include "cli/text/exit_code.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace spherule {
namespace {

const CLI::App& inner_command(const CLI::App& around, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* inner : around.get_subcommands({})) {
    if (inner->get_name() == name && !name.empty()) return *inner;
    known.push_back(inner->get_name());
  }
  throw Error("help", "there is no command '" + name + "'" + internal::did_you_mean(name, known));
}

void print_help(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  std::string full_name = app.get_name();
  for (const std::string& name : names) {
    command = &inner_command(*command, name);
    full_name += " " + name;
  }
  // App::help() prints that of the command that runs.
  std::cout << command->get_formatter()->make_help(command, full_name, CLI::AppFormatMode::Normal);
}

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  auto names = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *names, "Whose help is printed (default: the overview)")
      ->type_name(kCommand);
  command->footer(to_text({.text = "", .exit_codes = "0 done", .examples = {"spherule help fit"}}));
  command->callback([&app, names, &exit_code] {
    print_help(app, *names);
    exit_code = kYes;
  });
}

}  // namespace spherule
