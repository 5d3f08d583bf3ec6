// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/baseline.h"

#include "cli/commands/command.h"
#include "cli/help/help.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace spherule {

CLI::App* add_baseline_method(CLI::App& baseline, const BaselineText& text,
                              BaselineArguments& arguments, const char* output_help,
                              const HelpFooter& footer) {
  CLI::App* command = baseline.add_subcommand(text.name, text.summary);
  command->add_option("mesh", arguments.mesh, "STL, OBJ, PLY, OFF, DAE, 3MF, glTF or GLB")
      ->required()
      ->type_name(kFile);
  command->add_option("-o,--output", arguments.output, output_help)->required()->type_name(kFile);
  add_unit_options(*command, arguments.unit, "Output units per mesh unit (default: 1)");
  command->add_flag("--json", arguments.json, "Print the figures as JSON");
  HelpFooter end = footer;
  end.examples = {text.example};
  command->footer(to_text(end));
  return command;
}

ModelUnit converted_unit(const BaselineArguments& arguments) {
  ModelUnit unit = model_unit(arguments.mesh, arguments.unit);
  arguments.lengths.convert(length_context(arguments.mesh, unit));
  return unit;
}

void print_figures(const Json& figures) {
  for (const auto& [name, value] : figures.items()) std::cout << name << ": " << value << "\n";
}

void add_baseline(CLI::App& app, int& exit_code) {
  CLI::App* baseline =
      app.add_subcommand("baseline", "Make what other methods make of a mesh, and measure it");
  baseline->require_subcommand(1);
  HelpFooter footer{.text = "`spherule baseline METHOD --help` lists the options of a method.",
                    .exit_codes = "0 done, spheres proved to cover; 1 spheres not proved to cover",
                    .examples = add_mesh_baselines(*baseline, exit_code)};
  for (const std::string& example : add_sphere_baselines(*baseline, exit_code)) {
    footer.examples.push_back(example);
  }
  baseline->footer(to_text(footer));
}

}  // namespace spherule
