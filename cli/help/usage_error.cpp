// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help/usage_error.h"

#include "cli/help/command_specification.h"
#include "cli/help/help.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <vector>

namespace spherule {
namespace {

// How many letters have to be put in, taken out, replaced or swapped with their neighbours (optimal
// string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      edits[i][j] = std::min({replaced, edits[i - 1][j] + 1, edits[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[a.size()][b.size()];
}

std::string full_name(const CLI::App& command) {
  std::string name = command.get_name();
  for (const CLI::App* around = command.get_parent(); around; around = around->get_parent()) {
    name = around->get_name() + " " + name;
  }
  return name;
}

// CLI11 lists what is left over in an order of its own; the first option among it is named.
std::string describe_extras(const CLI::App& app, const CommandSpecification& command) {
  const std::vector<std::string> extras = app.remaining(true);
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& extra) { return extra.starts_with('-'); });
  if (option != extras.end()) {
    const std::string name = option->substr(0, option->find('='));
    return "unexpected option: " + *option + meant(nearest_name(name, option_names(command)));
  }
  if (extras.empty()) return {};
  if (command.commands.empty()) return "unexpected argument: " + extras.front();
  std::vector<std::string> names;
  for (const CommandSpecification& inner : command.commands) names.push_back(inner.name);
  return "unknown command: " + extras.front() + meant(nearest_name(extras.front(), names));
}

// The first of the examples.
std::string for_instance(const std::string& examples) {
  const std::string first = CLI::detail::trim_copy(examples.substr(0, examples.find('\n')));
  return first.empty() ? "" : "; for instance: " + first;
}

bool names_option(const std::string& text) {
  return text.starts_with("unexpected option") || text.starts_with("unknown command");
}

}  // namespace

const CLI::App& command_reached(const CLI::App& app) {
  const CLI::App* command = &app;
  while (true) {
    const auto inner = command->get_subcommands();
    const auto named = std::find_if(inner.begin(), inner.end(),
                                    [](const CLI::App* one) { return !one->get_name().empty(); });
    if (named == inner.end()) return *command;
    command = *named;
  }
}

std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& reached = command_reached(app);
  const CommandSpecification command = specification(reached);
  std::string text;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    text = describe_extras(app, command);
  } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    // What looks missing may be there under a wrong name.
    text = describe_extras(app, command);
    if (!names_option(text)) {
      text = command.commands.empty() ? error.what() : "a command is required";
      text += for_instance(parts_of(command.footer).examples);
    }
  } else {
    text = error.what();
  }
  return text + " (see " + full_name(reached) + " --help)";
}

std::string meant(const std::string& name) {
  return name.empty() ? "" : "; did you mean " + name + "?";
}

std::string nearest_name(const std::string& word, std::span<const std::string> known) {
  std::string best;
  const bool is_short_name = word.size() == 2 && word.front() != '-';
  std::size_t least = (is_short_name ? 1 : word.size() / 3) + 1;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(word, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  if (!best.empty() || word.size() < 2) return best;
  const auto longer = std::find_if(known.begin(), known.end(), [&](const std::string& name) {
    return word != "--" && name.starts_with(word);
  });
  return longer == known.end() ? std::string() : *longer;
}

}  // namespace spherule
