// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/completion.h"

#include <CLI/CLI.hpp>

namespace spherule {
namespace {

// Inside of single quotes, and of brackets in what _arguments reads.
std::string zsh_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
      continue;
    }
    if (c == '\\' || c == '[' || c == ']' || c == ':') result += '\\';
    result += c;
  }
  return result;
}

// What _arguments does for a value.
std::string zsh_value(const OptionSpecification& option) {
  if (option.value == kFile) {
    if (option.endings.empty()) return "_files";
    return "_files -g \"*.(#i)(" + CLI::detail::join(option.endings, "|") + ")\"";
  }
  if (option.value == kFolder) return "_files -/";
  if (option.choices.empty()) return " ";
  const std::string words = CLI::detail::join(option.choices, " ");
  return option.is_list ? "_values -s , word " + words : "(" + words + ")";
}

std::string zsh_option(const OptionSpecification& option) {
  const std::string all = CLI::detail::join(option.names, " ");
  std::string text;
  for (const std::string& name : option.names) {
    text += std::string(" \\\n    '") + (option.is_repeatable ? "*" : "(" + all + ")") + name +
            "[" + zsh_escaped(option.description) + "]";
    if (!option.value.empty()) text += ":" + zsh_escaped(option.value) + ":" + zsh_value(option);
    text += "'";
  }
  return text;
}

std::string zsh_functions(const CommandSpecification& command, const std::string& function) {
  std::string text = function + "() {\n  local context state state_descr line\n" +
                     "  local -A opt_args\n  _arguments -C";
  for (const OptionSpecification& option : command.options) text += zsh_option(option);
  for (const OptionSpecification& argument : command.arguments) {
    text += std::string(" \\\n    '") + (argument.is_repeatable ? "*" : "") + ":" +
            zsh_escaped(argument.names.front()) + ":" + zsh_value(argument) + "'";
  }
  if (command.commands.empty()) return text + "\n}\n";
  text += " \\\n    '1: :->command' \\\n    '*:: :->rest'\n  case $state in\n    command)\n" +
          std::string("      local -a commands=(\n");
  for (const CommandSpecification& one : command.commands) {
    text += "        '" + one.name + ":" + zsh_escaped(one.summary) + "'\n";
  }
  text +=
      "      )\n      _describe command commands\n      ;;\n    rest)\n      case $line[1] in\n";
  for (const CommandSpecification& one : command.commands) {
    text += "        " + one.name + ") " + function + "_" + one.name + " ;;\n";
  }
  text += "      esac\n      ;;\n  esac\n}\n";
  for (const CommandSpecification& one : command.commands)
    text += zsh_functions(one, function + "_" + one.name);
  return text;
}

}  // namespace

std::string zsh_completion(const CommandSpecification& command) {
  return "#compdef spherule\n# Completion of spherule for zsh, made by `spherule completion "
         "zsh`.\n" +
         zsh_functions(command, "_spherule") +
         "if [[ $funcstack[1] == _spherule ]]; then\n  _spherule \"$@\"\nelse\n"
         "  compdef _spherule spherule\nfi\n";
}

}  // namespace spherule
