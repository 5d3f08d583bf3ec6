// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/simplify.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

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

}  // namespace spherule
