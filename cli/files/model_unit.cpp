// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/model_unit.h"

#include "base/error.h"
#include "cli/text/message.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <sstream>

namespace spherule {
namespace {

constexpr double kMicrometresPerMetre = 1e6;

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// How the unit of the output is known: `own` is what the file states, `read` what it is read in.
std::string origin_of(const std::string& own, const std::string& read, const char* stated_by,
                      double scale) {
  std::string text = own == read ? std::string("stated by the ") + stated_by
                                 : "the file states " + own + ", read in " + read;
  if (scale == 1.0) return text;
  return (own == read ? own + " " : "") + text + ", times " + number(scale);
}

}  // namespace

std::vector<std::string> unit_choices() {
  return {"mm", "cm", "m", "inch"};
}

void add_unit_options(CLI::App& command, UnitArguments& arguments, const std::string& scale_help) {
  command.add_option("--scale", arguments.scale, scale_help);
  command
      .add_option("--units", arguments.units,
                  "The unit of the output and of lengths without one. A file that states its unit "
                  "(3MF, glTF, DAE, STEP, IGES) is converted to it; of another it says what its "
                  "numbers, times --scale, are in")
      ->check(CLI::IsMember(unit_choices()));
}

ModelUnit model_unit(const std::string& file, const UnitArguments& arguments) {
  ModelUnit result;
  if (arguments.scale) {
    result.scale = *arguments.scale;
    if (!(result.scale > 0.0) || !std::isfinite(result.scale)) {
      throw Error("scale", "must be a positive finite number, not " + number(result.scale));
    }
  }
  const LengthUnit* const wanted = arguments.units.empty() ? nullptr : unit_named(arguments.units);
  const std::optional<StatedUnit> stated = stated_unit(file);
  if (!stated) {
    if (wanted == nullptr) return result;
    result.micrometres = wanted->micrometres;
    result.origin = "as --units says";
    if (result.scale != 1.0) result.origin += ", the mesh times " + number(result.scale);
    return result;
  }
  if (wanted == nullptr) {
    result.micrometres = stated->micrometres / result.scale;
  } else {
    result.micrometres = wanted->micrometres;
    const double scale = stated->micrometres / wanted->micrometres;
    constexpr double kRounding = 1e-9;
    if (!arguments.scale) {
      result.scale = scale;
    } else if (!(std::abs(result.scale - scale) <= kRounding * scale)) {
      throw Error("--scale", number(result.scale) + " contradicts --units " + arguments.units +
                                 ": " + file + " is read in units of " +
                                 name_of_size(stated->micrometres) + ", which makes it " +
                                 number(scale) + "; leave out one of the two");
    }
  }
  result.origin =
      origin_of(name_of_size(stated->own_micrometres), name_of_size(stated->micrometres),
                stated->by_format ? "format" : "file", result.scale);
  return result;
}

std::string symbol_of(const ModelUnit& unit) {
  const LengthUnit* const known = unit.micrometres ? unit_of_size(*unit.micrometres) : nullptr;
  return known == nullptr ? "" : known->symbol;
}

LengthContext length_context(const std::string& file, const ModelUnit& unit) {
  return {file, unit.micrometres};
}

void note_cad_unit(const std::string& stated, ModelUnit& unit) {
  if (stated.empty()) return;
  const LengthUnit* const own = unit_named(stated);
  unit.origin =
      origin_of(own == nullptr ? stated : own->name, unit_named("mm")->name, "file", unit.scale);
}

std::string describe(const ModelUnit& unit) {
  if (!unit.micrometres) return {};
  return "unit: " + name_of_size(*unit.micrometres) + " (" + one_line(unit.origin) + ")\n";
}

Json to_json(const ModelUnit& unit) {
  if (!unit.micrometres) return nullptr;
  return {{"name", name_of_size(*unit.micrometres)},
          {"metres", *unit.micrometres / kMicrometresPerMetre},
          {"origin", unit.origin}};
}

}  // namespace spherule
