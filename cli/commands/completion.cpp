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
#include <vector>

namespace spherule {
namespace {

// Each script has the command say what may follow (offers_for()). Of files those with one of the
// endings are offered, if there are any, and folders.
constexpr const char* kBash =
    R"(# Completion of spherule for bash, made by `spherule completion bash`.
_spherule() {
  local word=${COMP_WORDS[COMP_CWORD]} kind path
  local -a offers kept=()
  mapfile -t offers < <("${COMP_WORDS[0]/#\~/$HOME}" completion bash -- \
    "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  kind=${offers[0]}
  [[ $word != = ]] || word=''
  COMPREPLY=()
  if [[ $kind == words ]]; then
    COMPREPLY=("${offers[@]:1}")
    COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
    return
  fi
  compopt -o filenames 2>/dev/null
  if [[ $kind == folders ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
  [[ $kind != files ]] || return
  kind=${kind#files }
  for path in "${COMPREPLY[@]}"; do
    if [[ -d ${path/#\~/$HOME} || ${path,,} == *.@(${kind// /|}) ]]; then kept+=("$path"); fi
  done
  [[ ${#kept[@]} -eq 0 ]] || COMPREPLY=("${kept[@]}")
}
complete -F _spherule spherule
)";

constexpr const char* kFish =
    R"(# Completion of spherule for fish, made by `spherule completion fish`.
function __spherule_offers
    set -l words (commandline -opc)
    set -l word (commandline -ct)
    set -l offers ($words[1] completion fish -- $words[2..] "$word" 2>/dev/null)
    set -l kind (string split ' ' -- $offers[1])
    set -l option (string match -r -- '^--[^=]*=' $word)
    set -l path (string replace -- "$option" '' $word)
    set -l paths (complete -C "__fish_command_without_completions $path")
    switch $kind[1]
        case words
            printf '%s\n' $offers[2..]
        case folders
            printf "$option%s\n" (string match -r -- '^.*/$' $paths)
        case files
            set -l endings (string join '|' $kind[2..])
            set -l kept (string match -ri -- "^.*(?:/|[.](?:$endings))\$" $paths)
            if set -q kept[1]; and set -q kind[2]
                set paths $kept
            end
            printf "$option%s\n" $paths
    end
end
complete -c spherule -f -a '(__spherule_offers)'
)";

constexpr const char* kZsh = R"zsh(#compdef spherule
# Completion of spherule for zsh, made by `spherule completion zsh`.
_spherule() {
  local -a offers
  offers=("${(@f)$(${~words[1]} completion zsh -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  local kind=$offers[1]
  shift offers
  case $kind in
    words)
      offers=("${(@)offers/$'\t'/:}")
      _describe spherule offers
      ;;
    folders) compset -P '--*='; _files -/ ;;
    files) compset -P '--*='; _files ;;
    files*) compset -P '--*='; _files -g "*.(#i)(${${kind#files }// /|})" ;;
  esac
}
if [[ $funcstack[1] == _spherule ]]; then
  _spherule "$@"
else
  compdef _spherule spherule
fi
)zsh";

const std::map<std::string, const char*>& shells() {
  static const std::map<std::string, const char*> kShells = {
      {"bash", kBash}, {"fish", kFish}, {"zsh", kZsh}};
  return kShells;
}

// Those that are offered for an argument, by the name that it has in every command. Empty: all.
FileEndings endings_for(const std::string& argument) {
  static const std::map<std::string, FileEndings> kOfArguments = {
      {"mesh", {"step", "stp", "iges", "igs"}},
      {"more", {"step", "stp", "iges", "igs", "json"}},
      {"urdf", {"urdf", "xacro"}},
      {"srdf", {"srdf"}},
      {"a", {"tree"}},
      {"b", {"tree"}},
      {"scene", {"json"}},
      {"trajectory", {"csv", "txt"}},
      {"spheres", {"json", "yml", "yaml", "xrdf", "urdf", "srdf"}}};
  const auto found = kOfArguments.find(argument);
  if (found == kOfArguments.end()) return {};
  FileEndings endings = found->second;
  if (argument == "mesh" || argument == "more") {
    endings.insert(endings.end(), mesh_endings().begin(), mesh_endings().end());
  }
  return endings;
}

// What is offered, line by line: "words" and these, each with what it means after a tab, "folders",
// or "files" with the endings that they may have.
class Offers {
 public:
  explicit Offers(const std::string& word) : word_(word) {}

  void add(const std::string& offer, const std::string& description = "") {
    if (offer.starts_with(word_)) text_ += offer + "\t" + description + "\n";
  }

  // `before` is the part of the word in front of the value.
  void add_value(const CLI::App& app, const CLI::Option& option, std::string before) {
    std::vector<std::string> choices = choices_of(option);
    const std::string value = value_name(option);
    if (value == kCommand) {
      for (const CLI::App* one : app.get_subcommands({})) choices.push_back(one->get_name());
    }
    if (option.get_delimiter() != '\0' && word_.find(',') != std::string::npos) {
      before = word_.substr(0, word_.rfind(',') + 1);
    }
    for (const std::string& choice : choices) add(before + choice);
    if (value == kFolder) kind_ = "folders";
    if (value == kFile) kind_ = "files";
  }

  void set_folders() { kind_ = "folders"; }
  void add_endings(const FileEndings& endings) {
    for (const std::string& ending : endings) kind_ += " " + ending;
  }

  std::string text() const { return kind_ + "\n" + text_; }

 private:
  std::string word_;
  std::string kind_ = "words";
  std::string text_{};
};

// Commands and files where an argument may stand.
void add_arguments(const CLI::App& app, const CLI::App& command, Offers& offers) {
  for (const CLI::App* inner : command.get_subcommands({})) {
    offers.add(inner->get_name(), inner->get_description());
  }
  const auto arguments =
      command.get_options([](const CLI::Option* option) { return option->get_positional(); });
  if (arguments.empty()) return;
  offers.add_value(app, *arguments.front(), "");
  FileEndings all;
  for (const CLI::Option* argument : arguments) {
    const FileEndings endings = endings_for(argument->get_name(true, false));
    if (endings.empty()) return;
    all.insert(all.end(), endings.begin(), endings.end());
  }
  offers.add_endings(all);
}

// What is offered for the last of the words behind the name of the program. In `manual fit`, `fit`
// is an argument.
std::string offers_for(const CLI::App& app, std::vector<std::string> words) {
  // Bash has "=" for a word of its own, in --option=VALUE as in NAME=DIR.
  if (words.empty() || words.back() == "=") words.emplace_back();
  const std::string word = words.back();
  words.pop_back();
  const CLI::App* command = &app;
  const CLI::Option* option = nullptr;  // whose value comes next
  const CLI::Option* latest = nullptr;  // whose value may go on behind "="
  bool goes_on = false;
  for (const std::string& one : words) {
    goes_on = one == "=" && option == nullptr;
    if (one == "=") {
      option = latest;
    } else if (option != nullptr) {
      option = nullptr;
    } else if (one.starts_with('-')) {
      option = command->get_option_no_throw(one);
      if (option != nullptr && value_name(*option).empty()) option = nullptr;  // a flag
      latest = option;
    } else if (const auto inner = command->get_subcommands(
                   [&](const CLI::App* each) { return each->get_name() == one; });
               !inner.empty()) {
      command = inner.front();
    }
  }
  Offers offers(word);
  const std::size_t sign = word.find('=');
  if (option != nullptr) {
    offers.add_value(app, *option, "");
    if (goes_on && value_name(*option) == kNamedFolder) offers.set_folders();
  } else if (!word.starts_with('-')) {
    add_arguments(app, *command, offers);
  } else if (sign == std::string::npos) {
    for (const CLI::Option* one : command->get_options()) {
      if (one->get_positional()) continue;
      for (const std::string& name : names_of(*one)) offers.add(name, one->get_description());
    }
  } else if (const auto* named = command->get_option_no_throw(word.substr(0, sign))) {
    offers.add_value(app, *named, word.substr(0, sign + 1));
  }
  return offers.text();
}

}  // namespace

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print the script by which a shell completes spherule");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "Which shell is to complete")
      ->required()
      ->check(CLI::IsMember(shells()));
  auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("words", *words,
                      "Behind --, the words of a command line: what is offered for the last one is "
                      "printed instead");
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
  command->callback([&app, shell, words, file, &exit_code] {
    const std::string text = words->empty() ? shells().at(*shell) : offers_for(app, *words);
    if (file->empty()) {
      std::cout << text;
    } else {
      check_outputs({*file}, {});
      write_file_atomically(*file, text);
    }
    exit_code = kYes;
  });
}

}  // namespace spherule
