// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/help/file_endings.h"

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spherule {

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

}  // namespace spherule
