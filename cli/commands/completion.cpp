// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/print.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace spherule {
namespace {

// Each asks the command what completes the last word: see completions().
constexpr const char* kBash =
    R"(# Completion of spherule for bash, made by `spherule completion bash`.
_spherule() {
  local word=${COMP_WORDS[COMP_CWORD]} kind path
  local -a kept=()
  {
    read -r kind
    mapfile -t COMPREPLY
  } < <("${COMP_WORDS[0]}" completion bash -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  [[ $kind != words && -n $kind ]] || return 0
  [[ $word != = ]] || word=''
  compopt -o filenames 2>/dev/null
  if [[ $kind == folders ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
    return 0
  fi
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
  # Folders and files of the kinds that are read, if there are any.
  for path in "${COMPREPLY[@]}"; do
    if [[ -d ${path/#\~/$HOME} || ${path,,} == *.@(${kind#files }) ]]; then kept+=("$path"); fi
  done
  [[ $kind == files || ${#kept[@]} -eq 0 ]] || COMPREPLY=("${kept[@]}")
}
complete -F _spherule spherule
)";

constexpr const char* kFish =
    R"(# Completion of spherule for fish, made by `spherule completion fish`.
function __spherule_complete
    set -l words (commandline -opc)
    set -l command $words[1]
    set -e words[1]
    set -l last (commandline -ct)
    set -l replies ($command completion fish -- $words "$last" 2>/dev/null)
    switch "$replies[1]"
        case words
            set -e replies[1]
            printf '%s\n' $replies
        case folders
            __fish_complete_directories
        case 'files*'
            set -l paths (complete -C "__fish_command_without_completions $last")
            set -l endings (string replace -r '^files ?' '' $replies[1])
            # Folders and files of the kinds that are read, if there are any.
            set -l kept (string match -ri -- "^.*(?:/|[.](?:$endings))\$" $paths)
            if test -n "$endings"; and set -q kept[1]
                set paths $kept
            end
            printf '%s\n' $paths
    end
end
complete -c spherule -f -a '(__spherule_complete)'
)";

constexpr const char* kZsh = R"zsh(#compdef spherule
# Completion of spherule for zsh, made by `spherule completion zsh`.
_spherule() {
  local -a replies=("${(@f)$($words[1] completion zsh -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  local kind=$replies[1]
  shift replies
  case $kind in
    words) _describe word replies ;;
    folders) _files -/ ;;
    files) _files ;;
    files*) _files -g "*.(#i)(${kind#files })";
;
esac
}
if
  [[$funcstack [1] == _spherule]]; then
  _spherule "$@"
else
  compdef _spherule spherule
fi
)zsh";

const std::map<std::string, const char*>& scripts() {
  static const std::map<std::string, const char*> kScripts = {
      {"bash", kBash}, {"fish", kFish}, {"zsh", kZsh}};
  return kScripts;
}

// The words that begin like the last one, with what they mean, as a shell takes them.
class Replies {
 public:
  Replies(std::string shell, std::string last) : shell_(std::move(shell)), last_(std::move(last)) {}

  void add(const std::string& word, const std::string& meaning) {
    if (!word.starts_with(last_)) return;
    text_ += word;
    if (shell_ != "bash" && !meaning.empty()) text_ += (shell_ == "zsh" ? ":" : "\t") + meaning;
    text_ += "\n";
  }

  // What a value may be: words, or files with one of the endings.
  std::string of_value(const OptionSpecification& option, const std::string& before) {
    if (option.value == kFolder) return "folders\n";
    if (option.value == kFile) {
      return "files" +
             (option.endings.empty() ? "" : " " + CLI::detail::join(option.endings, "|")) + "\n";
    }
    const std::size_t comma = option.is_list ? last_.rfind(',') : last_.npos;
    const std::string list = comma == last_.npos ? before : last_.substr(0, comma + 1);
    for (const std::string& choice : option.choices) add(list + choice, "");
    return text();
  }

  std::string text() const { return "words\n" + text_; }

 private:
  std::string shell_;
  std::string last_;
  std::string text_;
};

// What completes the last of some words behind the name of the program: a line "words" and they,
// one a line; or "folders", "files" or "files stl|obj", which the shell finds.
std::string completions(const CommandSpecification& program, std::vector<std::string> words,
                        const std::string& shell) {
  std::string last = words.empty() ? "" : words.back();
  if (!words.empty()) words.pop_back();
  // Bash has "=" for a word of its own, in --option=VALUE as in NAME=DIR.
  const bool is_split = last == "=" || (!words.empty() && words.back() == "=");
  if (last == "=") {
    last.clear();
  } else if (is_split) {
    words.pop_back();
  }
  const bool is_named = is_split && !words.empty() && !words.back().starts_with('-');
  if (is_named) words.pop_back();
  std::string before;
  if (last.starts_with("--") && last.find('=') != last.npos) {
    before = last.substr(0, last.find('=') + 1);
    words.push_back(last.substr(0, last.find('=')));
  }
  const CommandSpecification* command = &program;
  for (const std::string& word : words) {
    if (const auto* inner = find_command(*command, word)) command = inner;
  }
  Replies replies(shell, last);
  for (const OptionSpecification& option : command->options) {
    const bool is_before = !words.empty() && !option.value.empty() &&
                           std::ranges::find(option.names, words.back()) != option.names.end();
    if (!is_before) continue;
    return is_named && option.value == kNamedFolder ? "folders\n"
                                                    : replies.of_value(option, before);
  }
  if (last.starts_with('-')) {
    for (const OptionSpecification& option : command->options) {
      for (const std::string& name : option.names) replies.add(name, option.description);
    }
    return replies.text();
  }
  for (const CommandSpecification& inner : command->commands)
    replies.add(inner.name, inner.summary);
  return command->arguments.empty() ? replies.text() : replies.of_value(any_argument(*command), "");
}

}  // namespace

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print the script by which a shell completes spherule");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "Which shell is to complete")
      ->required()
      ->check(CLI::IsMember(scripts()));
  auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("words", *words,
                      "Print instead what completes the last of these words, as the script asks");
  auto file = std::make_shared<std::string>();
  add_file(*command, "-o,--output", *file, "Where the script goes (default: standard output)");
  command->footer(to_text(
      {.text = "An installed spherule has the scripts where bash, fish and zsh search for them.",
       .exit_codes = "0 done",
       .examples = {
           "spherule completion bash > ~/.local/share/bash-completion/completions/spherule",
           "spherule completion fish > ~/.config/fish/completions/spherule.fish",
           "spherule completion zsh > ~/.zfunc/_spherule    # a folder of $fpath"}}));
  command->callback([&app, shell, words, file, &exit_code] {
    const std::string script =
        words->empty() ? scripts().at(*shell) : completions(specification(app), *words, *shell);
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
