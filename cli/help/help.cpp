// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/help.h"

#include "cli/help/command_specification.h"

#include <CLI/CLI.hpp>

#include <sstream>
#include <string_view>

namespace spherule {
namespace {

constexpr std::size_t kNameColumns = 32;
constexpr std::size_t kTextColumns = 66;
constexpr std::size_t kFooterColumns = kNameColumns + kTextColumns;

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(kNameColumns);
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    const OptionSpecification shown = specification(*option);
    return (shown.value.empty() ? "" : " " + shown.value) + (shown.is_repeatable ? " ..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(full_description(specification(*option)), kTextColumns);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_name(),
                             wrapped(command->get_description(), kTextColumns + kNameColumns / 2),
                             kNameColumns / 2);
    return out.str();
  }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_layout() {
  return std::make_shared<HelpFormatter>();
}

std::string to_text(const HelpFooter& footer) {
  std::string text;
  const auto add = [&](const std::string& paragraph) {
    if (!paragraph.empty()) text += wrapped(paragraph, kFooterColumns) + "\n";
  };
  add(footer.text);
  if (!footer.exit_codes.empty()) {
    add(std::string(kExitCodes) + " " + footer.exit_codes + "; 2 bad input.");
  }
  if (footer.examples.empty()) return text;
  text += std::string(kExamples) + "\n";
  for (const std::string& example : footer.examples) text += "  " + example + "\n";
  return text;
}

FooterParts parts_of(const std::string& footer) {
  FooterParts parts;
  std::string* part = &parts.text;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line == kExamples) {
      part = &parts.examples;
      continue;
    }
    if (line.starts_with(kExitCodes)) {
      part = &parts.exit_codes;
      line.erase(0, std::string_view(kExitCodes).size() + 1);
    }
    *part += line + "\n";
  }
  return parts;
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0) {
      const bool fits = column + 1 + word.size() <= width;
      result += fits ? ' ' : '\n';
      column = fits ? column + 1 : 0;
    }
    result += word;
    column += word.size();
  }
  return result;
}

}  // namespace spherule
