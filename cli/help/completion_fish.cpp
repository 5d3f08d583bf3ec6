// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/completion.h"

#include <CLI/CLI.hpp>

namespace spherule {
namespace {

std::string fish_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\\' || c == '\'') result += '\\';
    result += c;
  }
  return result + "'";
}

// What fish is told of a value: whether files are offered, those with one of the endings, and which
// words.
std::string fish_value(const OptionSpecification& option) {
  if (option.value == kFile) {
    if (option.endings.empty()) return " -F";
    return " -f -a '(__spherule_files " + CLI::detail::join(option.endings, " ") + ")'";
  }
  if (option.value == kFolder) return " -f -a '(__fish_complete_directories)'";
  if (option.choices.empty()) return " -f";
  const std::string words = CLI::detail::join(option.choices, " ");
  return " -f -a " + fish_quoted(option.is_list ? "(__fish_append , " + words + ")" : words);
}

// The paths of all commands below one: 'baseline', 'baseline hull'.
std::string fish_paths(const CommandSpecification& command, const std::string& path) {
  std::string text;
  for (const CommandSpecification& one : command.commands) {
    const std::string inner = path.empty() ? one.name : path + " " + one.name;
    text += " " + fish_quoted(inner) + fish_paths(one, inner);
  }
  return text;
}

// Which command a line has got to, by the words that name one where they stand: in `manual fit`,
// `fit` is an argument.
std::string fish_function(const CommandSpecification& command) {
  return R"(function __spherule_at
    set -l command
    set -l words (commandline -opc)
    set -e words[1]
    for word in $words
        if contains -- (string join -- ' ' $command $word))" +
         fish_paths(command, "") + R"(
            set command $command $word
        end
    end
    test "$command" = "$argv"
end
)";
}

// Folders and files of the kinds that are read, if there are any.
constexpr const char* kFishFiles = R"(function __spherule_files
    set -l paths (complete -C "__fish_command_without_completions "(commandline -ct))
    set -l kept (string match -ri -- '^.*(?:/|[.](?:'(string join '|' $argv)'))$' $paths)
    if set -q kept[1]
        set paths $kept
    end
    printf '%s\n' $paths
end
)";

std::string fish_lines(const CommandSpecification& command, const std::string& path) {
  const std::string when =
      "complete -c spherule -n '__spherule_at" + (path.empty() ? "" : " " + path) + "'";
  std::string text;
  for (const CommandSpecification& one : command.commands) {
    text += when + " -f -a " + one.name + " -d " + fish_quoted(one.summary) + "\n";
  }
  if (!command.arguments.empty()) text += when + fish_value(any_argument(command)) + "\n";
  for (const OptionSpecification& option : command.options) {
    text += when;
    for (const std::string& name : option.names) {
      const bool is_long = name.starts_with("--");
      text += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
    }
    if (!option.value.empty()) text += " -r" + fish_value(option);
    text += " -d " + fish_quoted(option.description) + "\n";
  }
  for (const CommandSpecification& one : command.commands) {
    text += fish_lines(one, path.empty() ? one.name : path + " " + one.name);
  }
  return text;
}

}  // namespace

std::string fish_completion(const CommandSpecification& command) {
  return "# Completion of spherule for fish, made by `spherule completion fish`.\n" +
         fish_function(command) + kFishFiles + fish_lines(command, "");
}

}  // namespace spherule
