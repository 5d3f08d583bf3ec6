// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/help_pages.h"

#include <sstream>

namespace spherule {
namespace {

using Pages = std::vector<std::pair<std::string, std::string>>;

void add_pages(const RunCommand& run, const std::vector<std::string>& names, Pages& pages) {
  std::vector<std::string> line = names;
  line.push_back("--help");
  const Outcome outcome = run(line);
  EXPECT_EQ(outcome.exit_code, 0);
  for (const std::string& inner : names_below(outcome.out, "Commands:")) {
    line.back() = inner;
    add_pages(run, line, pages);
  }
  std::string name;
  for (const std::string& part : names) name += (name.empty() ? "" : " ") + part;
  pages.emplace_back(name, outcome.out);
}

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> names_below(const std::string& help, const std::string& heading) {
  std::vector<std::string> names;
  bool below = false;
  for (const std::string& line : lines_of(help)) {
    if (below && line.empty()) break;
    // Further lines of a description are further to the right.
    if (below && line.size() > 2 && line[2] != ' ') {
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    below = below || line == heading;
  }
  return names;
}

std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  bool below = false;
  for (const std::string& line : lines_of(help)) {
    if (below && line.starts_with("  spherule ")) examples.push_back(line.substr(2));
    below = below || line == "Examples:";
  }
  return examples;
}

Pages help_pages(const RunCommand& run) {
  Pages pages;
  add_pages(run, {}, pages);
  return pages;
}

}  // namespace spherule
