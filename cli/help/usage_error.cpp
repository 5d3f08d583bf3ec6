// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/usage_error.h"

#include "base/text.h"
#include "cli/help/command_specification.h"
#include "cli/help/help.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <vector>

namespace spherule {
namespace {

std::string full_name(const CLI::App& command) {
  std::string name = command.get_name();
  for (const CLI::App* around = command.get_parent(); around; around = around->get_parent()) {
    name = around->get_name() + " " + name;
  }
  return name;
}

// CLI11 lists what is left over in an order of its own; the first option among it is named.
std::string describe_extras(const CLI::App& app, const CommandSpecification& command) {
  const std::vector<std::string> extras = app.remaining(true);
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& extra) { return extra.starts_with('-'); });
  if (option != extras.end()) {
    const std::string name = option->substr(0, option->find('='));
    return "unexpected option: " + *option + internal::did_you_mean(name, option_names(command));
  }
  if (extras.empty()) return {};
  if (command.commands.empty()) return "unexpected argument: " + extras.front();
  return "unknown command: " + extras.front() +
         internal::did_you_mean(extras.front(), command.commands, &CommandSpecification::name);
}

// The first of the examples.
std::string for_instance(const std::string& examples) {
  const std::string first = CLI::detail::trim_copy(examples.substr(0, examples.find('\n')));
  return first.empty() ? "" : "; for instance: " + first;
}

bool names_option(const std::string& text) {
  return text.starts_with("unexpected option") || text.starts_with("unknown command");
}

}  // namespace

const CLI::App& command_reached(const CLI::App& app) {
  const CLI::App* command = &app;
  while (true) {
    const auto inner = command->get_subcommands();
    const auto named = std::find_if(inner.begin(), inner.end(),
                                    [](const CLI::App* one) { return !one->get_name().empty(); });
    if (named == inner.end()) return *command;
    command = *named;
  }
}

std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& reached = command_reached(app);
  const CommandSpecification command = specification(reached);
  std::string text;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    text = describe_extras(app, command);
  } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    // What looks missing may be there under a wrong name.
    text = describe_extras(app, command);
    if (!names_option(text)) {
      text = command.commands.empty() ? error.what() : "a command is required";
      text += for_instance(parts_of(command.footer).examples);
    }
  } else {
    text = error.what();
  }
  return text + " (see " + full_name(reached) + " --help)";
}

}  // namespace spherule
