// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/completion.h"

#include <CLI/CLI.hpp>

namespace spherule {
namespace {

// What is completed is chosen by the command, "baseline hull" say, and the option before the word.
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

}  // namespace

std::string bash_completion(const CommandSpecification& command) {
  BashWriter writer;
  writer.add(command, "");
  return writer.text();
}

}  // namespace spherule
