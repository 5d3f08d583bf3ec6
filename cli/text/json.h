// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/repair.h"
#include "simplifier/simplify.h"

#include <nlohmann/json.hpp>

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

// What a command reports is one JSON document: --json prints it, pages carry it, and what a person
// reads is filled in from it.

namespace spherule {

// Whether a report lists the external spheres, often a hundred thousand.
enum class ReportContent { kNoExternalSpheres, kAll };

using Json = nlohmann::ordered_json;

// JSON knows no infinity: infinite numbers become the strings "inf" and "-inf", as in SPHERES.json.
Json to_json(double value);
Json to_json(const Eigen::Vector3d& point);
Json to_json(const Eigen::AlignedBox3d& box);
Json to_json(const Bounds& bounds);
Json to_json(std::span<const Sphere> spheres);
Json to_json(const std::map<std::string, OptionValue>& options);
// Everything a certificate says; the keys that SPHERES.json has too mean the same there.
Json to_json(const Certificate& certificate);

Json to_json(const Repair& repair);

// The simplified solid; with all external spheres kept anyone can judge what was simplified away.
Json to_json(const ExternalSpheres& external, ReportContent content);

template <class T>
Json to_json(const std::optional<T>& value) {
  return value ? to_json(*value) : Json(nullptr);
}

enum class Layout { kIndented, kCompact };

// The text of a JSON document, with a line break at its end. File names that are not UTF-8 are
// written with replacement characters, all control characters as \u00XX.
std::string to_text(const Json& json, Layout layout = Layout::kIndented);

// The pattern with every {PATH:FORMAT} replaced by what stands in the report at that path, keys and
// indices with dots between ("certificate.uncovered_depth.0"); "-" where nothing does. Texts as
// one_line() says, lists with commas. FORMAT, if there is one: of numbers N, significant digits
// (6), fN, decimals, or %N, a share in per cent with N decimals; mm before it, metres as
// millimetres; mm alone, with 4 decimals below 0.1 and one elsewhere, a bare 0; ~ behind it, of the
// two bounds of a number, "0" if the upper one is. Of true and false the two words: "yes|no".
std::string filled(std::string_view pattern, const Json& report);

// A line for a person, or a piece of one: shown where the report has what `when` names, and that is
// neither null, false, nor empty; with "!" in front where it has not, with "#" where it is a number
// above 0. Always, if that is empty. In the pattern, {} is what it names.
struct Line {
  std::string_view when;
  std::string_view pattern;
};
std::string lines(const Json& report, std::initializer_list<Line> list);

// A table with a row for each of a list, as aligned() lays it out; without headings if the first is
// empty.
struct Column {
  const char* heading;
  std::string_view pattern;
};
std::string table(const Json& rows, std::initializer_list<Column> columns);

// What the JSON of a certificate says, in a few lines for a person. `solid` names what was to be
// covered.
std::string describe_certificate(const Json& certificate, const std::string& solid);

// The same of a repair, in half a line; lengths in that format.
std::string describe_repair(const Json& repair, const std::string& format = "6");

}  // namespace spherule
