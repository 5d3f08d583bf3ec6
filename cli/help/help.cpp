// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/help.h"

#include "base/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>
#include <sstream>

namespace spherule {
namespace {

constexpr std::size_t kNameColumns = 32;
constexpr std::size_t kTextColumns = 66;
constexpr std::size_t kFooterColumns = kNameColumns + kTextColumns;
constexpr const char* kExamples = "Examples:\n";

// The text with line breaks in the place of blanks, so that no line is longer than `width`, unless
// a word is.
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

// " (needs --edges)"; sorted, which CLI11 has by addresses.
std::string note(const char* word, const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) names.insert(option->get_name());
  return names.empty() ? "" : std::string(" (") + word + CLI::detail::join(names, ", ") + ")";
}

bool is_repeatable(const CLI::Option& option) {
  return option.get_type_size() != 0 &&
         option.get_expected_max() >= CLI::detail::expected_max_vector_size;
}

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(kNameColumns);
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string value = value_name(*option);
    return (value.empty() ? "" : " " + value) + (is_repeatable(*option) ? " ..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description() + (option->get_required() ? " (required)" : "") +
                       note("needs ", option->get_needs()) +
                       note("not with ", option->get_excludes()),
                   kTextColumns);
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
std::string describe_extras(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> extras = app.remaining(true);
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& extra) { return extra.starts_with('-'); });
  std::vector<std::string> known;
  if (option != extras.end()) {
    for (const CLI::Option* one : command.get_options()) {
      for (const std::string& name : names_of(*one)) known.push_back(name);
    }
    return "unexpected option: " + *option +
           internal::did_you_mean(option->substr(0, option->find('=')), known);
  }
  if (extras.empty()) return {};
  for (const CLI::App* inner : command.get_subcommands({})) known.push_back(inner->get_name());
  if (known.empty()) return "unexpected argument: " + extras.front();
  return "unknown command: " + extras.front() + internal::did_you_mean(extras.front(), known);
}

// The first of the examples at the end of a help.
std::string for_instance(const std::string& footer) {
  const std::size_t examples = footer.find(kExamples);
  if (examples == std::string::npos) return {};
  const std::string lines = CLI::detail::trim_copy(footer.substr(footer.find('\n', examples)));
  return "; for instance: " + lines.substr(0, lines.find('\n'));
}

}  // namespace

const FileEndings& mesh_endings() {
  static const FileEndings kEndings = {"stl", "obj", "ply", "off", "dae", "3mf", "gltf", "glb"};
  return kEndings;
}

// CLI11 joins the type and what its validators say: "TEXT:{cover,paper}", "FLOAT:POSITIVE".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string value_name(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  const std::vector<std::string> choices = choices_of(option);
  if (!choices.empty()) return CLI::detail::join(choices, "|");
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  return name == "FLOAT" ? "NUMBER" : name == "INT" || name == "UINT" ? "N" : name;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true, false)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
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
  if (!footer.exit_codes.empty()) add("Exit codes: " + footer.exit_codes + "; 2 bad input.");
  if (footer.examples.empty()) return text;
  text += kExamples;
  for (const std::string& example : footer.examples) text += "  " + example + "\n";
  return text;
}

const CLI::App& command_reached(const CLI::App& app) {
  const std::vector<CLI::App*> inner = app.get_subcommands();
  return inner.empty() ? app : command_reached(*inner.front());
}

std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = command_reached(app);
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  std::string text = error.what();
  if (is_missing || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    text = describe_extras(app, command);
  }
  // What looks missing may be there under a wrong name.
  if (is_missing && !text.starts_with("unexpected option") &&
      !text.starts_with("unknown command")) {
    text = command.get_subcommands({}).empty() ? error.what() : "a command is required";
    text += for_instance(command.get_footer());
  }
  return text + " (see " + full_name(command) + " --help)";
}

}  // namespace spherule
