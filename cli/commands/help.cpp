// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/help.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/commands/command.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

const CLI::App& inner_command(const CLI::App& around, const std::string& name,
                              const char* asked_by) {
  std::vector<std::string> known;
  for (const CLI::App* inner : around.get_subcommands({})) {
    if (inner->get_name() == name && !name.empty()) return *inner;
    known.push_back(inner->get_name());
  }
  throw Error(asked_by, "there is no command '" + name + "'" + internal::did_you_mean(name, known));
}

// The words by which a command is called, and its help.
struct Page {
  const CLI::App* command;
  std::vector<std::string> path;

  std::string name(const std::string& blank) const { return CLI::detail::join(path, blank); }
  std::string help() const {
    // App::help() prints that of the command that runs.
    return command->get_formatter()->make_help(command, name(" "), CLI::AppFormatMode::Normal);
  }
  Page inner(const CLI::App& below) const {
    Page page{&below, path};
    page.path.push_back(below.get_name());
    return page;
  }
};

Page page_of(const CLI::App& app, const std::vector<std::string>& names, const char* asked_by) {
  Page page{&app, {app.get_name()}};
  for (const std::string& name : names) {
    page = page.inner(inner_command(*page.command, name, asked_by));
  }
  return page;
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

// A line of the help; names of options and commands become tags, their descriptions are filled.
std::string manual_line(const std::string& line, bool is_example) {
  if (is_example) return line.empty() ? "" : roff(line) + "\n";
  if (line.size() < 3 || !line.starts_with("  ") || line[2] == ' ') {
    return line.empty() ? "" : roff(CLI::detail::trim_copy(line)) + "\n";
  }
  const std::size_t end = line.find("  ", 2);
  const std::string rest = end == line.npos ? "" : CLI::detail::trim_copy(line.substr(end));
  return ".TP\n\\fB" + roff(line.substr(2, end - 2)) + "\\fR\n" +
         (rest.empty() ? "" : roff(rest) + "\n");
}

std::string manual_page(const Page& page) {
  const std::string name = page.name("-");
  std::string text = ".\\\" Made by `spherule manual` from what its commands say of themselves.\n" +
                     (".TH " + roff(name)) + " 1 \"" + today() +
                     "\" \"spherule " SPHERULE_VERSION "\" \"User Commands\"\n.SH NAME\n" +
                     roff(name) + " \\- " + roff(page.command->get_description()) +
                     "\n.SH DESCRIPTION\n";
  std::istringstream help(page.help());
  std::string section;
  bool is_after_blank = false;
  for (std::string line; std::getline(help, line);) {
    if (line.ends_with(':') && line.find(' ') == line.npos) {
      section = line;
      text += ".SH " + roff(line.substr(0, line.size() - 1)) + "\n" +
              (line == kExamples ? ".nf\n" : "");
    } else {
      const bool begins = !line.starts_with(' ') && (is_after_blank || line.starts_with("Usage:") ||
                                                     line.starts_with(kExitCodes));
      text += (begins && !line.empty() ? ".PP\n" : "") + manual_line(line, section == kExamples);
    }
    is_after_blank = line.empty();
  }
  return text + (section == kExamples ? ".fi\n" : "");
}

void write_pages(const Page& page, const std::filesystem::path& folder) {
  write_file_atomically(folder / (page.name("-") + ".1"), manual_page(page));
  for (const CLI::App* inner : page.command->get_subcommands({})) {
    if (!inner->get_name().empty()) write_pages(page.inner(*inner), folder);
  }
}

}  // namespace

void add_help(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("help", "Print the help of a command");
  auto names = std::make_shared<std::vector<std::string>>();
  command->add_option("command", *names, "Whose help is printed (default: the overview)")
      ->type_name(kCommand);
  command->footer(to_text({.text = "", .exit_codes = "0 done", .examples = {"spherule help fit"}}));
  command->callback([&app, names, &exit_code] {
    std::cout << page_of(app, *names, "help").help();
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
      std::cout << manual_page(page_of(app, *names, "manual"));
    } else {
      if (!std::filesystem::is_directory(*folder)) throw Error(*folder, "no such folder");
      write_uninterrupted([&] { write_pages({&app, {app.get_name()}}, *folder); });
    }
    exit_code = kYes;
  });
}

}  // namespace spherule
