// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/json.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// What every method of `spherule baseline` takes.
struct BaselineArguments {
  std::string mesh;
  std::string output;
  UnitArguments unit;
  LengthOptions lengths;
  bool json = false;
};

// What the command of a method is called, and what its help says.
struct BaselineText {
  const char* name;
  const char* summary;
  const char* example;  // a line
};

// Each adds the commands of the methods that make meshes, or spheres; returns their examples.
std::vector<std::string> add_mesh_baselines(CLI::App& baseline, int& exit_code);
std::vector<std::string> add_sphere_baselines(CLI::App& baseline, int& exit_code);

// Adds the command of one method with what every method takes. Its help ends with `footer` and the
// method's example.
CLI::App* add_baseline_method(CLI::App& baseline, const BaselineText& text,
                              BaselineArguments& arguments, const char* output_help,
                              const HelpFooter& footer);

// Converts the lengths of the command line to output units, and returns those.
ModelUnit converted_unit(const BaselineArguments& arguments);

// A line for every figure: its name, and its value as JSON.
void print_figures(const Json& figures);

}  // namespace spherule
