// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Numbers and names in text files of other tools.

#include <Eigen/Core>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// The numbers of a text, apart by white space; nothing if a part of it is no number.
std::optional<std::vector<double>> numbers_of(std::string_view text);

// The same for three numbers.
std::optional<Eigen::Vector3d> vector_of(std::string_view text);

// A finite number as a decimal with a point and without an exponent (which YAML 1.1 reads as a
// text where it has no point), the shortest that reads back to the same double.
std::string decimal(double value);

// Three of them, apart by `separator`.
std::string decimals(const Eigen::Vector3d& point, std::string_view separator);

// Why a text cannot be a name in every format, or nothing: XML and YAML have no way to write some
// characters.
std::string fault_of_name(std::string_view name);

// A text as YAML, in double quotes where it is not plainly a text to every reader.
std::string yaml_text(std::string_view text);

}  // namespace spherule::internal
