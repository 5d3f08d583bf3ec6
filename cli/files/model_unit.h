// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/options/length_options.h"
#include "cli/text/json.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// The units in which a model may be written out.
struct UnitArguments {
  std::optional<double> scale;
  std::string units;  // of the output; empty: not given
};

// Adds --scale and --units.
void add_unit_options(CLI::App& command, UnitArguments& arguments, const std::string& scale_help);

// What --units takes.
std::vector<std::string> unit_choices();

// From the numbers of a model to those of the output.
struct ModelUnit {
  double scale = 1.0;                 // output units per unit of the model
  std::optional<double> micrometres;  // of one output unit, where that is known
  std::string origin;                 // how it is known: "stated by the file"
};

// --units is the unit of the output. A model whose file states a unit is converted to it; of
// another it says what its numbers, times --scale, are in. Without it the output is in units of
// the file times --scale. Throws Error for a --scale that is not positive and finite, and one that
// does not lead from the unit that the file states to --units; and as stated_unit().
ModelUnit model_unit(const std::string& file, const UnitArguments& arguments);

// Of the unit of the output; empty where that is not known or has none.
std::string symbol_of(const ModelUnit& unit);

// What lengths on the command line are to be converted to.
LengthContext length_context(const std::string& file, const ModelUnit& unit);

// Tells in `origin` what unit a CAD file states, which is known once it has been read.
void note_cad_unit(const std::string& stated, ModelUnit& unit);

// "unit: millimetre (stated by the file)", a line for a person; nothing if it is not known.
std::string describe(const ModelUnit& unit);

// {"name", "metres", "origin"}, or null.
Json to_json(const ModelUnit& unit);

}  // namespace spherule
