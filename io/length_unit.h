// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Units of length, in texts and in files.
//
// @code{.cpp}
// #include <spherule/io/length_unit.h>
// #include <cassert>
// #include <cmath>
//
// const auto length = spherule::parse_length("0.5 in");
// const spherule::LengthUnit* const millimetre = spherule::unit_named("mm");
// assert(std::abs(spherule::in_units_of(millimetre->micrometres, *length) - 12.7) < 1e-12);
// assert(!spherule::stated_unit("part.stl"));  // the format has none
// @endcode

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace spherule {

// A unit of length. Sizes are in micrometres, so that those of the table are whole numbers and the
// quotient of two of them is rounded once.
struct LengthUnit {
  const char* symbol;  // "mm"
  const char* name;    // "millimetre"
  const char* plural;
  double micrometres;
};

// All units that lengths may be written in: micrometre, millimetre, centimetre, metre, inch, foot.
std::span<const LengthUnit> length_units();

// The unit of this symbol or name, also as other programs spell it (in, micron, MILLIMETER), or
// null.
const LengthUnit* unit_named(std::string_view text);

// The unit of this size, up to rounding, or null.
const LengthUnit* unit_of_size(double micrometres);

// "millimetre", or "0.3 metres" for a size that is no unit's.
std::string name_of_size(double micrometres);

// A length as it is written: "0.5", "1mm", "0.5 in".
struct Length {
  double value = 0.0;
  const LengthUnit* unit = nullptr;  // null: none is named
};

// Nothing for a text that is no number, alone or with a unit behind; infinite for one that no
// double holds.
std::optional<Length> parse_length(std::string_view text);

// The value of a length with a unit, in units of this size.
double in_units_of(double micrometres, const Length& length);

// The unit that a file states.
struct StatedUnit {
  double micrometres = 0.0;      // of one unit of what read_mesh() or read_cad() makes of the file
  double own_micrometres = 0.0;  // of one unit of the numbers in the file; CAD files: see CadPart
  bool by_format = false;        // the format says so, not the file
};

// For mesh and CAD files. A 3MF file states its unit (by default the millimetre), glTF is in
// metres, DAE is read into metres from its own <unit>, CAD files into millimetres. Nothing for the
// formats that have no units: STL, OBJ, PLY, OFF. Only 3MF and DAE files are opened: throws Error,
// naming the file, for one that cannot be read or whose unit cannot be used.
std::optional<StatedUnit> stated_unit(const std::filesystem::path& path);

}  // namespace spherule
