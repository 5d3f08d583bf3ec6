// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/completion.h"

#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/output.h"
#include "cli/help/help.h"
#include "cli/text/exit_code.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <map>
#include <memory>

namespace spherule {
namespace {

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
