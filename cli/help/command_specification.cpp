// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/command_specification.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>

namespace spherule {
namespace {

// CLI11 joins the type and what its validators say: "TEXT:{cover,paper}", "FLOAT:POSITIVE".
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string plain_type(const std::string& type) {
  const std::string name = type.substr(0, type.find(':'));
  if (name == "FLOAT") return "NUMBER";
  if (name == "INT" || name == "UINT") return "N";
  return name;
}

// Sorted: CLI11 has them in the order of their addresses.
std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

// The commands of the program that a command is of.
std::vector<std::string> all_commands(const CLI::App& app) {
  const CLI::App* program = &app;
  while (program->get_parent() != nullptr) program = program->get_parent();
  std::vector<std::string> names;
  for (const CLI::App* one : program->get_subcommands({})) {
    if (!one->get_name().empty()) names.push_back(one->get_name());
  }
  return names;
}

void collect_options(const CLI::App& app, CommandSpecification& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    auto& list = option->get_positional() ? command.arguments : command.options;
    list.push_back(specification(*option));
    if (list.back().value == kCommand) list.back().choices = all_commands(app);
  }
  // Groups of options are commands without a name.
  for (const CLI::App* inner : app.get_subcommands({})) {
    if (inner->get_name().empty()) collect_options(*inner, command);
  }
}

// Options that stand in a group stand in the command around it as well.
void drop_repeated(std::vector<OptionSpecification>& options) {
  std::vector<OptionSpecification> kept;
  for (OptionSpecification& option : options) {
    const bool there = std::any_of(kept.begin(), kept.end(), [&](const OptionSpecification& other) {
      return other.names == option.names;
    });
    if (!there) kept.push_back(std::move(option));
  }
  options = std::move(kept);
}

}  // namespace

OptionSpecification specification(const CLI::Option& option) {
  OptionSpecification result;
  if (option.get_positional()) {
    result.names = {option.get_name(true, false)};
    result.endings = endings_for(result.names.front());
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  if (option.get_type_size() != 0) {
    const std::string type = option.get_type_name();
    result.choices = choices_in(type);
    result.value =
        result.choices.empty() ? plain_type(type) : CLI::detail::join(result.choices, "|");
    result.is_list = option.get_delimiter() != '\0';
    result.is_repeatable = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  }
  result.is_required = option.get_required();
  result.needs = names_of(option.get_needs());
  result.excludes = names_of(option.get_excludes());
  result.description = option.get_description();
  return result;
}

CommandSpecification specification(const CLI::App& app) {
  CommandSpecification result{.name = app.get_name(),
                              .summary = app.get_description(),
                              .footer = app.get_footer(),
                              .arguments = {},
                              .options = {},
                              .commands = {}};
  collect_options(app, result);
  drop_repeated(result.options);
  for (const CLI::App* inner : app.get_subcommands({})) {
    if (!inner->get_name().empty()) result.commands.push_back(specification(*inner));
  }
  return result;
}

std::string full_description(const OptionSpecification& option) {
  const auto note = [](const char* word, const std::vector<std::string>& names) {
    return names.empty() ? "" : std::string(" (") + word + CLI::detail::join(names, ", ") + ")";
  };
  return option.description + (option.is_required ? " (required)" : "") +
         note("needs ", option.needs) + note("not with ", option.excludes);
}

OptionSpecification any_argument(const CommandSpecification& command) {
  OptionSpecification any = command.arguments.front();
  for (const OptionSpecification& argument : command.arguments) {
    if (argument.endings.empty()) any.endings.clear();
    if (any.endings.empty()) break;
    for (const std::string& ending : argument.endings) {
      if (std::ranges::find(any.endings, ending) == any.endings.end())
        any.endings.push_back(ending);
    }
  }
  return any;
}

std::vector<std::string> option_names(const CommandSpecification& command) {
  std::vector<std::string> names;
  for (const OptionSpecification& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

const CommandSpecification* find_command(const CommandSpecification& around,
                                         const std::string& name) {
  const auto found =
      std::find_if(around.commands.begin(), around.commands.end(),
                   [&](const CommandSpecification& one) { return one.name == name; });
  return found == around.commands.end() ? nullptr : &*found;
}

}  // namespace spherule
