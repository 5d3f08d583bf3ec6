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

// What options and arguments say of the values that they take, as their type_name(). Completion
// goes by it: of what is marked otherwise nothing is known.
inline constexpr const char* kFile = "FILE";
inline constexpr const char* kFolder = "DIR";
inline constexpr const char* kNamedFolder = "NAME=DIR";
inline constexpr const char* kCommand = "COMMAND";
inline constexpr const char* kLength = "LENGTH";

// "FILE", "NUMBER", "cover|paper": what an option takes; empty for a flag.
std::string value_name(const CLI::Option& option);

// The words that an option takes, where these are few.
std::vector<std::string> choices_of(const CLI::Option& option);

// The names of an option, the short one first: "-o", "--output"; of an argument its one name.
std::vector<std::string> names_of(const CLI::Option& option);

// How the help of all commands is laid out: CLI11's way, with descriptions broken into lines and
// values named as above.
std::shared_ptr<CLI::FormatterBase> help_layout();

// How the help of a command ends. What is left out is not shown.
struct HelpFooter {
  std::string text = {};
  std::string exit_codes = {};             // "0 covered; 1 leaks", to which bad input is added
  std::vector<std::string> examples = {};  // command lines
};

std::string to_text(const HelpFooter& footer);

// What is wrong with a command line, in one line: what is not known comes first, with the name that
// may have been meant, then what is missing; and where the help is.
std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error);

// The command that the command line has got to, the application itself at first.
const CLI::App& command_reached(const CLI::App& app);

}  // namespace spherule
