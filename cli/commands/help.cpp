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
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace spherule {
namespace {

const CLI::App& inner_command(const CLI::App& around, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* inner : around.get_subcommands({})) {
    if (inner->get_name() == name && !name.empty()) return *inner;
    known.push_back(inner->get_name());
  }
  throw Error("help", "there is no command '" + name + "'" + internal::did_you_mean(name, known));
}

void print_help(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  std::string full_name = app.get_name();
  for (const std::string& name : names) {
    command = &inner_command(*command, name);
    full_name += " " + name;
  }
  // App::help() prints that of the command that runs.
  std::cout << command->get_formatter()->make_help(command, full_name, CLI::AppFormatMode::Normal);
}

// Text of a manual page, in the macros of man(7), where no character of it means anything to roff.
std::string roff(const std::string& text) {
  std::string result;
  bool starts_line = true;
  for (const char c : text) {
    if (starts_line && (c == '.' || c == '\'')) result += "\\&";
    starts_line = c == '\n';
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

// Filled anyway, in lines that a person can read.
std::string paragraph(const std::string& text) {
  return roff(wrapped(text, 72)) + "\n";
}

std::string with_blanks(const std::vector<std::string>& path, char blank) {
  std::string name;
  for (const std::string& part : path) name += (name.empty() ? "" : std::string(1, blank)) + part;
  return name;
}

// The day that the page is of; builds that are to be repeatable set SOURCE_DATE_EPOCH.
std::string today() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  std::time_t now = std::time(nullptr);
  if (epoch != nullptr) {
    const std::optional<std::int64_t> seconds = internal::whole_number(epoch);
    if (!seconds) {
      throw Error("SOURCE_DATE_EPOCH", internal::in_quotes(epoch) + " is no number of seconds");
    }
    now = static_cast<std::time_t>(*seconds);
  }
  const std::tm* day = std::gmtime(&now);
  if (day == nullptr) throw Error("SOURCE_DATE_EPOCH", "is not in a year that can be written");
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", day);
  return text.data();
}

std::string synopsis(const CommandSpecification& command, const std::vector<std::string>& path) {
  std::string text = bold(with_blanks(path, ' '));
  if (!command.options.empty()) text += " [" + italic("options") + "]";
  for (const OptionSpecification& argument : command.arguments) {
    const std::string name = italic(argument.names.front()) + (argument.is_repeatable ? "..." : "");
    text += argument.is_required ? " " + name : " [" + name + "]";
  }
  if (!command.commands.empty()) text += " " + italic("command") + " ...";
  return text + "\n";
}

std::string item(const OptionSpecification& option, bool is_argument) {
  std::string text = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    text += (i > 0 ? ", " : "") + (is_argument ? italic : bold)(option.names[i]);
  }
  if (!option.value.empty()) text += " " + italic(option.value);
  if (option.is_repeatable) text += " ...";
  return text + "\n" + paragraph(full_description(option));
}

std::string items(const char* section, const std::vector<OptionSpecification>& options,
                  bool are_arguments) {
  if (options.empty()) return {};
  std::string text = std::string(".SH ") + section + "\n";
  for (const OptionSpecification& option : options) text += item(option, are_arguments);
  return text;
}

// The footer of the help: text, exit codes and examples in sections of their own.
std::string page(const CommandSpecification& command, const std::vector<std::string>& path) {
  const std::string name = with_blanks(path, '-');
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const FooterParts footer = parts_of(command.footer);
  std::string text = ".\\\" Made by `spherule manual` from what its commands say of themselves.\n";
  text += ".TH " + roff(title) + " 1 \"" + today() + "\" \"spherule " SPHERULE_VERSION +
          "\" \"User Commands\"\n";
  text += ".SH NAME\n" + roff(name) + " \\- " + roff(command.summary) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(command, path);
  if (!footer.text.empty()) text += ".SH DESCRIPTION\n" + paragraph(footer.text);
  text += items("ARGUMENTS", command.arguments, true) + items("OPTIONS", command.options, false);
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const CommandSpecification& inner : command.commands) {
      text += ".TP\n" + bold(name + "-" + inner.name) + "(1)\n" + paragraph(inner.summary);
    }
  }
  if (!footer.exit_codes.empty()) text += ".SH EXIT STATUS\n" + paragraph(footer.exit_codes);
  if (!footer.examples.empty()) {
    text += ".SH EXAMPLES\n.nf\n" + roff(footer.examples) + ".fi\n";
  }
  if (path.size() > 1) {
    const std::vector<std::string> around(path.begin(), path.end() - 1);
    text += ".SH SEE ALSO\n" + bold(with_blanks(around, '-')) + "(1)\n";
  }
  return text;
}

void write_pages(const CommandSpecification& command, std::vector<std::string> path,
                 const std::filesystem::path& folder) {
  write_file_atomically(folder / (with_blanks(path, '-') + ".1"), page(command, path));
  path.emplace_back();
  for (const CommandSpecification& inner : command.commands) {
    path.back() = inner.name;
    write_pages(inner, path, folder);
  }
}

void print_page(const CommandSpecification& all, const std::vector<std::string>& names) {
  const CommandSpecification* command = &all;
  std::vector<std::string> path = {all.name};
  for (const std::string& name : names) {
    command = find_command(*command, name);
    if (command == nullptr) throw Error("manual", "there is no command '" + name + "'");
    path.push_back(name);
  }
  std::cout << page(*command, path);
}

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  auto names = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *names, "Whose help is printed (default: the overview)")
      ->type_name(kCommand);
  command->footer(to_text({.text = "", .exit_codes = "0 done", .examples = {"spherule help fit"}}));
  command->callback([&app, names, &exit_code] {
    print_help(app, *names);
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
    const CommandSpecification all = specification(app);
    if (folder->empty()) {
      print_page(all, *names);
    } else {
      if (!std::filesystem::is_directory(*folder)) throw Error(*folder, "no such folder");
      write_uninterrupted([&] { write_pages(all, {all.name}, *folder); });
    }
    exit_code = kYes;
  });
}

}  // namespace spherule
