// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class FormatterBase;
class Option;
class ParseError;
}  // namespace CLI

namespace spherule {

// Endings of file names, in small letters, without the dot.
using FileEndings = std::vector<std::string>;

// Those of the mesh formats that are read.
const FileEndings& mesh_endings();

// Those that completion offers for an argument, by the name that it has in every command: "urdf",
// "mesh". Empty: files of all kinds.
FileEndings endings_for(const std::string& argument);

// What options and arguments say of the values that they take, as their type_name(). Completion
// goes by it: of what is marked otherwise nothing is known.
inline constexpr const char* kFile = "FILE";
inline constexpr const char* kFolder = "DIR";
inline constexpr const char* kNamedFolder = "NAME=DIR";
inline constexpr const char* kCommand = "COMMAND";
inline constexpr const char* kLength = "LENGTH";

// An option of a command, or an argument without a name of its own (positional).
struct OptionSpecification {
  std::vector<std::string> names;    // "-o", "--output"; of an argument its one name: "mesh"
  std::string value;                 // "FILE", "NUMBER", "cover|paper"; empty for a flag
  std::vector<std::string> choices;  // the words that it takes, where these are few
  FileEndings endings;               // of the files that an argument takes; empty: all
  bool is_list = false;              // it takes several of them with commas between
  bool is_repeatable = false;
  bool is_required = false;
  std::vector<std::string> needs;     // names of options without which it is refused
  std::vector<std::string> excludes;  // with which
  std::string description;
};

// A command as its help describes it: the one source of completion and manual pages.
struct CommandSpecification {
  std::string name;  // without those of the commands around it
  std::string summary;
  std::string footer;
  std::vector<OptionSpecification> arguments;
  std::vector<OptionSpecification> options;
  std::vector<CommandSpecification> commands;
};

OptionSpecification specification(const CLI::Option& option);
CommandSpecification specification(const CLI::App& app);

// The description, and whether the option is required, what it needs and what it excludes.
std::string full_description(const OptionSpecification& option);

// The first argument of a command, with the endings of the files that all of its arguments take.
OptionSpecification any_argument(const CommandSpecification& command);

// The names of all options of a command.
std::vector<std::string> option_names(const CommandSpecification& command);

// The command with this name among those of `around`, or null.
const CommandSpecification* find_command(const CommandSpecification& around,
                                         const std::string& name);

// How the help of all commands is laid out: CLI11's way, with descriptions broken into lines and
// values named as in command_specification.h.
std::shared_ptr<CLI::FormatterBase> help_layout();

// How the help of a command ends. What is left out is not shown.
struct HelpFooter {
  std::string text = {};
  std::string exit_codes = {};             // "0 covered; 1 leaks", to which bad input is added
  std::vector<std::string> examples = {};  // command lines
};

// The lines that introduce the parts of a footer, by which a manual page tells them apart.
inline constexpr const char* kExitCodes = "Exit codes:";
inline constexpr const char* kExamples = "Examples:";

std::string to_text(const HelpFooter& footer);

// The lines of each part of such a text, without those words.
struct FooterParts {
  std::string text;
  std::string exit_codes;
  std::string examples;
};
FooterParts parts_of(const std::string& footer);

// The text with line breaks in the place of blanks, so that no line is longer than `width`, unless
// a word is.
std::string wrapped(const std::string& text, std::size_t width);

// What is wrong with a command line, in one line: what is not known comes first, with the name that
// may have been meant, then what is missing; and where the help is.
std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error);

// The command that the command line has got to, the application itself at first.
const CLI::App& command_reached(const CLI::App& app);

}  // namespace spherule
