// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class FormatterBase;
}

namespace spherule {

// How the help of all commands is laid out: CLI11's way, with descriptions broken into lines and
// values named as in command_specification.h.
std::shared_ptr<CLI::FormatterBase> help_layout();

// How the help of a command ends. What is left out is not shown.
struct HelpFooter {
  std::string text = {};
  std::string exit_codes = {};             // "0 covered; 1 leaks", to which bad input is added
  std::vector<std::string> examples = {};  // command lines
};

// The lines that introduce the parts of a footer, by which a manual page tells them apart.
inline constexpr const char* kExitCodes = "Exit codes:";
inline constexpr const char* kExamples = "Examples:";

std::string to_text(const HelpFooter& footer);

// The lines of each part of such a text, without those words.
struct FooterParts {
  std::string text;
  std::string exit_codes;
  std::string examples;
};
FooterParts parts_of(const std::string& footer);

// The text with line breaks in the place of blanks, so that no line is longer than `width`, unless
// a word is.
std::string wrapped(const std::string& text, std::size_t width);

}  // namespace spherule
