// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

// Files around a content that is mutated, with checksums that are right: hardly any mutant of a
// whole file comes past a checksum.

namespace spherule::test {

// The bytes, and the checksum with which sphere trees and link pairs end.
std::string with_checksum(std::string_view content);
std::string without_checksum(std::string_view file);

// A 3MF package around the text of its model.
std::string threemf_around(std::string_view model);

}  // namespace spherule::test
