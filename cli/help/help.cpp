// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/help.h"

#include "base/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

namespace spherule {
namespace {

FileEndings joined(std::initializer_list<FileEndings> lists) {
  FileEndings all;
  for (const FileEndings& one : lists) all.insert(all.end(), one.begin(), one.end());
  return all;
}

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

constexpr std::size_t kNameColumns = 32;
constexpr std::size_t kTextColumns = 66;
constexpr std::size_t kFooterColumns = kNameColumns + kTextColumns;

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(kNameColumns);
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    const OptionSpecification shown = specification(*option);
    return (shown.value.empty() ? "" : " " + shown.value) + (shown.is_repeatable ? " ..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(full_description(specification(*option)), kTextColumns);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_name(),
                             wrapped(command->get_description(), kTextColumns + kNameColumns / 2),
                             kNameColumns / 2);
    return out.str();
  }
};

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

const FileEndings& mesh_endings() {
  static const FileEndings kEndings = {"stl", "obj", "ply", "off", "dae", "3mf", "gltf", "glb"};
  return kEndings;
}

FileEndings endings_for(const std::string& argument) {
  static const FileEndings kModel = joined({mesh_endings(), {"step", "stp", "iges", "igs"}});
  static const FileEndings kSpheres = {"json", "yml", "yaml", "xrdf", "urdf", "srdf"};
  static const std::map<std::string, FileEndings> kOfArguments = {
      {"mesh", kModel},
      {"more", joined({kModel, {"json"}})},
      {"urdf", {"urdf", "xacro"}},
      {"srdf", {"srdf"}},
      {"a", {"tree"}},
      {"b", {"tree"}},
      {"scene", {"json"}},
      {"trajectory", {"csv", "txt"}},
      {"spheres", kSpheres}};
  const auto found = kOfArguments.find(argument);
  return found == kOfArguments.end() ? FileEndings{} : found->second;
}

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

std::shared_ptr<CLI::FormatterBase> help_layout() {
  return std::make_shared<HelpFormatter>();
}

std::string to_text(const HelpFooter& footer) {
  std::string text;
  const auto add = [&](const std::string& paragraph) {
    if (!paragraph.empty()) text += wrapped(paragraph, kFooterColumns) + "\n";
  };
  add(footer.text);
  if (!footer.exit_codes.empty()) {
    add(std::string(kExitCodes) + " " + footer.exit_codes + "; 2 bad input.");
  }
  if (footer.examples.empty()) return text;
  text += std::string(kExamples) + "\n";
  for (const std::string& example : footer.examples) text += "  " + example + "\n";
  return text;
}

FooterParts parts_of(const std::string& footer) {
  FooterParts parts;
  std::string* part = &parts.text;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line == kExamples) {
      part = &parts.examples;
      continue;
    }
    if (line.starts_with(kExitCodes)) {
      part = &parts.exit_codes;
      line.erase(0, std::string_view(kExitCodes).size() + 1);
    }
    *part += line + "\n";
  }
  return parts;
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0) {
      const bool fits = column + 1 + word.size() <= width;
      result += fits ? ' ' : '\n';
      column = fits ? column + 1 : 0;
    }
    result += word;
    column += word.size();
  }
  return result;
}

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
