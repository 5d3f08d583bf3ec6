// SPDX-License-Identifier: BSD-3-Clause
#include "cli/baseline.h"

#include "cli/command.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace spherule {

std::string example_line(const BaselineText& text) {
  return std::string("  ") + text.example + "\n";
}

CLI::App* add_baseline_method(CLI::App& baseline, const BaselineText& text,
                              BaselineArguments& arguments, const char* output_help,
                              const char* figures) {
  CLI::App* command = baseline.add_subcommand(text.name, text.summary);
  command->add_option("mesh", arguments.mesh, "STL, OBJ, PLY, OFF, DAE, 3MF, glTF or GLB")
      ->required();
  command->add_option("-o,--output", arguments.output, output_help)->required();
  command->add_option("--scale", arguments.scale, "Output units per mesh unit (default: 1)");
  command->add_flag("--json", arguments.json, "Print the figures as JSON");
  command->footer("Example:\n" + example_line(text) + figures);
  return command;
}

void print_figures(const Json& figures) {
  for (const auto& [name, value] : figures.items()) std::cout << name << ": " << value << "\n";
}

void add_baseline(CLI::App& app, int& exit_code) {
  CLI::App* baseline =
      app.add_subcommand("baseline", "Make what other methods make of a mesh, and measure it");
  baseline->require_subcommand(1);
  std::string examples = add_mesh_baselines(*baseline, exit_code);
  examples += add_sphere_baselines(*baseline, exit_code);
  baseline->footer("Examples:\n" + examples);
}

}  // namespace spherule
