// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/text/print.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <string>

namespace spherule {
namespace {

// What is completed is chosen by the command and the option before the word.
constexpr const char* kStart =
    R"(# Completion of spherule for bash, made by `spherule completion bash`.
_spherule() {
  local word=${COMP_WORDS[COMP_CWORD]} at=$((COMP_CWORD - 1)) i
  local option command='' commands='' options='' choices='' list='' files='' folders=''
  local -a kept=()
  COMPREPLY=()
  # Bash has "=" for a word of its own, in --option=VALUE as in NAME=DIR.
  if [[ $word == = ]]; then
    word=''
  elif [[ ${COMP_WORDS[at]} == = && $at -gt 1 ]]; then
    ((at--))
  fi
  option=${COMP_WORDS[at]}
  if [[ $option != -* && ${COMP_WORDS[at + 1]} == = && $at -gt 1 ]]; then
    option="${COMP_WORDS[at - 1]}="
  fi
)";

constexpr const char* kEnd = R"(  if [[ -z $option && $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -n $list ]]; then
    mapfile -t COMPREPLY < <(compgen -P "${word%"${word##*,}"}" -W "$list" -- "${word##*,}")
  elif [[ -n $folders ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
  elif [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    if [[ $files != all ]]; then
      # Folders and files of the kinds that are read, if there are any.
      local path
      for path in "${COMPREPLY[@]}"; do
        if [[ -d ${path/#\~/$HOME} || ${path,,} == *.@($files) ]]; then kept+=("$path"); fi
      done
      [[ ${#kept[@]} -eq 0 ]] || COMPREPLY=("${kept[@]}")
    fi
  else
    mapfile -t COMPREPLY < <(compgen -W "$commands $choices" -- "$word")
  fi
}
complete -F _spherule spherule
)";

class BashWriter {
 public:
  void add(const CommandSpecification& command, const std::string& path) {
    std::vector<std::string> inner;
    for (const CommandSpecification& one : command.commands) inner.push_back(one.name);
    if (!inner.empty()) {
      std::vector<std::string> patterns;
      for (const std::string& name : inner) patterns.push_back("'" + path + " " + name + "'");
      finders_ += "      " + CLI::detail::join(patterns, " | ") + ") ;;\n";
    }
    words_ += "    '" + path + "')\n      options='" +
              CLI::detail::join(option_names(command), " ") + "'\n";
    if (!inner.empty()) words_ += "      commands='" + CLI::detail::join(inner, " ") + "'\n";
    if (!command.arguments.empty()) words_ += "      " + reply(any_argument(command)) + "\n";
    words_ += "      ;;\n";
    for (const OptionSpecification& option : command.options) add_values(option, path);
    for (const CommandSpecification& one : command.commands) {
      add(one, path.empty() ? one.name : path + " " + one.name);
    }
  }

  std::string text() const {
    return std::string(kStart) + "  for ((i = 1; i < COMP_CWORD; i++)); do\n" +
           "    case \"$command ${COMP_WORDS[i]}\" in\n" + finders_ + "      *) continue ;;\n" +
           "    esac\n    command=\"${command:+$command }${COMP_WORDS[i]}\"\n  done\n" +
           "  case \"$command:$option\" in\n" + values_ + "    *) option='' ;;\n  esac\n" +
           "  [[ -n $option ]] || case $command in\n" + words_ + "  esac\n" + kEnd;
  }

 private:
  // What is offered for a value; of files those with one of the endings.
  static std::string reply(const OptionSpecification& option) {
    const std::string choices = "'" + CLI::detail::join(option.choices, " ") + "'";
    if (!option.choices.empty()) return (option.is_list ? "list=" : "choices=") + choices;
    if (option.value == kFile) {
      return "files='" + (option.endings.empty() ? "all" : CLI::detail::join(option.endings, "|")) +
             "'";
    }
    if (option.value == kFolder) return "folders=yes";
    return ":";  // nothing is known of it
  }

  void add_values(const OptionSpecification& option, const std::string& path) {
    if (option.value.empty()) return;  // a flag: what follows is the next word
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back("'" + path + ":" + name + "'");
    values_ += "    " + CLI::detail::join(patterns, " | ") + ") " + reply(option) + " ;;\n";
    if (option.value != kNamedFolder) return;
    for (const std::string& name : option.names) {
      values_ += "    '" + path + ":" + name + "=') folders=yes ;;\n";
    }
  }

  std::string finders_;  // patterns by which the command is found
  std::string values_;   // what options take
  std::string words_;    // what commands take
};

// Scripts by which a shell completes the command that is outlined: commands, options, the words
// that options take, files and folders. Each is whole: it does not run the command.
std::string bash_completion(const CommandSpecification& command) {
  BashWriter writer;
  writer.add(command, "");
  return writer.text();
}

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

// The paths of all commands below one.
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

std::string fish_completion(const CommandSpecification& command) {
  return "# Completion of spherule for fish, made by `spherule completion fish`.\n" +
         fish_function(command) + kFishFiles + fish_lines(command, "");
}

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

std::string zsh_completion(const CommandSpecification& command) {
  return "#compdef spherule\n# Completion of spherule for zsh, made by `spherule completion "
         "zsh`.\n" +
         zsh_functions(command, "_spherule") +
         "if [[ $funcstack[1] == _spherule ]]; then\n  _spherule \"$@\"\nelse\n"
         "  compdef _spherule spherule\nfi\n";
}

const std::map<std::string, std::string (*)(const CommandSpecification&)>& shells() {
  static const std::map<std::string, std::string (*)(const CommandSpecification&)> kShells = {
      {"bash", bash_completion}, {"fish", fish_completion}, {"zsh", zsh_completion}};
  return kShells;
}

}  // namespace

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print the script by which a shell completes spherule");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "Which shell is to complete")
      ->required()
      ->check(CLI::IsMember(shells()));
  auto file = std::make_shared<std::string>();
  command->add_option("-o,--output", *file, "Where the script goes (default: standard output)")
      ->type_name(kFile);
  command->footer(to_text(
      {.text = "An installed spherule has the scripts where bash, fish and zsh search for them.",
       .exit_codes = "0 done",
       .examples = {
           "spherule completion bash > ~/.local/share/bash-completion/completions/spherule",
           "spherule completion fish > ~/.config/fish/completions/spherule.fish",
           "spherule completion zsh > ~/.zfunc/_spherule    # a folder of $fpath"}}));
  command->callback([&app, shell, file, &exit_code] {
    const std::string script = shells().at(*shell)(specification(app));
    if (file->empty()) {
      std::cout << script;
    } else {
      check_outputs({*file}, {});
      write_file_atomically(*file, script);
    }
    exit_code = kYes;
  });
}

}  // namespace spherule
