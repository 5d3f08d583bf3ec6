// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/help.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/commands/command.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

const CLI::App& command_named(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  for (const std::string& name : names) {
    const std::vector<const CLI::App*> inner = command->get_subcommands({});
    const auto found =
        std::ranges::find_if(inner, [&](const CLI::App* one) { return one->get_name() == name; });
    if (found == inner.end()) {
      const auto name_of = [](const CLI::App* one) { return one->get_name(); };
      throw Error("help", "there is no command '" + name + "'" +
                              internal::did_you_mean(name, inner, name_of));
    }
    command = *found;
  }
  return *command;
}

std::string full_name(const CLI::App& command, const char* between) {
  const CLI::App* around = command.get_parent();
  return around == nullptr ? command.get_name()
                           : full_name(*around, between) + between + command.get_name();
}

// App::help() has that of the command that runs.
std::string help_of(const CLI::App& command) {
  return command.get_formatter()->make_help(&command, full_name(command, " "),
                                            CLI::AppFormatMode::Normal);
}

std::string in_capitals(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// A line of a manual page, in which no character means anything to roff.
std::string roff(const std::string& line) {
  std::string result = line.starts_with('.') || line.starts_with('\'') ? "\\&" : "";
  for (const char c : line) {
    static const std::map<char, const char*> kNames = {{'\\', "\\e"},  {'-', "\\-"},
                                                       {'`', "\\(ga"}, {'\'', "\\(aq"},
                                                       {'^', "\\(ha"}, {'~', "\\(ti"}};
    const auto name = kNames.find(c);
    result += name == kNames.end() ? std::string(1, c) : name->second;
  }
  return result;
}

// The help of a command in the macros of man(7): its headings, and what is below them as it stands.
std::string manual_page(const CLI::App& command) {
  const std::string name = full_name(command, "-");
  const std::string& summary = command.get_description();
  std::string help = help_of(command).substr(summary.size() + 1);
  help.insert(help.size() - command.get_footer().size() - 1, "Notes:\n");
  std::string page = ".\\\" Made by `spherule manual` from the help of its commands.\n.TH " +
                     roff(in_capitals(name)) +
                     " 1 \"" SPHERULE_DATE "\" \"spherule " SPHERULE_VERSION
                     "\" \"User Commands\"\n.SH NAME\n" +
                     roff(name) + " \\- " + roff(summary) + "\n.SH SYNOPSIS\n.nf\n";
  const std::string usage = "Usage: ";
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(usage)) line.erase(0, usage.size());
    const bool is_heading = line.ends_with(':') && !line.starts_with(' ');
    if (is_heading) line = ".fi\n.SH " + in_capitals(line.substr(0, line.size() - 1)) + "\n.nf";
    if (!line.empty()) page += (is_heading ? line : roff(line)) + "\n";
  }
  return page + ".fi\n";
}

void write_pages(const CLI::App& command, const std::filesystem::path& folder) {
  write_file_atomically(folder / (full_name(command, "-") + ".1"), manual_page(command));
  for (const CLI::App* inner : command.get_subcommands({})) write_pages(*inner, folder);
}

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  auto names = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *names, "Whose help is printed (default: the overview)")
      ->type_name(kCommand);
  command->footer(to_text({.text = "", .exit_codes = "0 done", .examples = {"spherule help fit"}}));
  command->callback([&app, names, &exit_code] {
    std::cout << help_of(command_named(app, *names));
    exit_code = kYes;
  });
}

void add_manual(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("manual", "Print or write manual pages, for man");
  auto names = std::make_shared<std::vector<std::string>>();
  auto folder = std::make_shared<std::string>();
  command->add_option("command", *names, "Whose page is printed (default: the overview)")
      ->type_name(kCommand);
  command->add_option("-o,--output", *folder, "Folder into which all pages are written instead")
      ->type_name(kFolder);
  command->footer(to_text({.text = "",
                           .exit_codes = "0 done",
                           .examples = {"spherule manual fit > fit.1", "spherule manual -o ."}}));
  command->callback([&app, names, folder, &exit_code] {
    if (folder->empty()) {
      std::cout << manual_page(command_named(app, *names));
    } else {
      if (!std::filesystem::is_directory(*folder)) throw Error(*folder, "no such folder");
      write_uninterrupted([&] { write_pages(app, *folder); });
    }
    exit_code = kYes;
  });
}

}  // namespace spherule
