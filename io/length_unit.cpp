// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "io/mesh_io.h"
#include "io/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>

namespace spherule {
namespace {

constexpr double kMetre = 1e6;
constexpr double kMillimetre = 1e3;

constexpr std::array kUnits = {LengthUnit{"um", "micrometre", "micrometres", 1.0},
                               LengthUnit{"mm", "millimetre", "millimetres", kMillimetre},
                               LengthUnit{"cm", "centimetre", "centimetres", 1e4},
                               LengthUnit{"m", "metre", "metres", kMetre},
                               LengthUnit{"inch", "inch", "inches", 25400.0},
                               LengthUnit{"ft", "foot", "feet", 304800.0}};

struct Spelling {
  std::string_view text;
  std::string_view symbol;
};
constexpr std::array kSpellings = {Spelling{"in", "inch"},       Spelling{"micron", "um"},
                                   Spelling{"micrometer", "um"}, Spelling{"millimeter", "mm"},
                                   Spelling{"centimeter", "cm"}, Spelling{"meter", "m"}};

}  // namespace

std::span<const LengthUnit> length_units() {
  return kUnits;
}

const LengthUnit* unit_named(std::string_view text) {
  std::string name(text);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Spelling& spelling : kSpellings) {
    if (name == spelling.text) name = spelling.symbol;
  }
  const auto found = std::ranges::find_if(kUnits, [&](const LengthUnit& unit) {
    return name == unit.symbol || name == unit.name || name == unit.plural;
  });
  return found == kUnits.end() ? nullptr : &*found;
}

const LengthUnit* unit_of_size(double micrometres) {
  constexpr double kRounding = 1e-12;
  const auto found = std::ranges::find_if(kUnits, [&](const LengthUnit& unit) {
    return std::abs(micrometres - unit.micrometres) <= kRounding * unit.micrometres;
  });
  return found == kUnits.end() ? nullptr : &*found;
}

std::string name_of_size(double micrometres) {
  if (const LengthUnit* unit = unit_of_size(micrometres)) return unit->name;
  std::ostringstream text;
  text << micrometres / kMetre << " metres";
  return text.str();
}

std::optional<Length> parse_length(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Length length;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), length.value);
  if (fault == std::errc::result_out_of_range) {
    length.value = std::numeric_limits<double>::infinity();
  } else if (fault != std::errc()) {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.empty()) return length;
  if (text.starts_with(' ')) text.remove_prefix(1);
  length.unit = unit_named(text);
  return length.unit == nullptr ? std::nullopt : std::optional(length);
}

double in_units_of(double micrometres, const Length& length) {
  return length.value * length.unit->micrometres / micrometres;
}

std::optional<StatedUnit> stated_unit(const std::filesystem::path& path) {
  const std::string extension = internal::lower_extension(path);
  if (is_cad_file(path)) return StatedUnit{kMillimetre, kMillimetre};
  if (extension == "gltf" || extension == "glb") return StatedUnit{kMetre, kMetre, true};
  if (extension != "3mf" && extension != "dae") return std::nullopt;
  const std::string subject = path.string();
  const std::string bytes = internal::read_regular_file(path);
  if (extension == "dae")
    return StatedUnit{kMetre, kMetre * internal::collada_unit(bytes, subject)};
  const double size = internal::unit_of_3mf(bytes, subject);
  return StatedUnit{size, size};
}

}  // namespace spherule
