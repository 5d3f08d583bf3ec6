// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Zones as text, in files of their own and among the options that are stored beside spheres.
//
// @code{.cpp}
// #include <spherule/simplifier/zone_file.h>
// #include <cassert>
//
// const std::vector<spherule::Zone> zones{
//     {.shape = spherule::Sphere{{0, 0, 0}, 2}, .max_error = 0.1}};
// assert(spherule::parse_zones(spherule::zones_text(zones), "zones") == zones);
// @endcode

#include "simplifier/types/zones.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// The file of `fit --zones`, lengths in output units:
//   {"format":"spherule-zones","version":1,"zones":[
//     {"shape":"ball","center":[x,y,z],"radius":r,"max_error":e,"min_external":d},
//     {"shape":"box","min":[x,y,z],"max":[x,y,z],"max_error":e},
//     {"shape":"capsule","from":[x,y,z],"to":[x,y,z],"radius":r,"min_external":d}]}
// Throws Error naming file, entry and reason for everything else: a key that is not known, missing
// or there twice, a value of a wrong type, a zone that check_zones() refuses.
std::vector<Zone> read_zones(const std::filesystem::path& path);

// Zones from the text of a file as read_zones() reads it, which `subject` names in errors.
std::vector<Zone> parse_zones(std::string_view text, const std::string& subject);
// Compact text of the zones, from which parse_zones() gets them back bit for bit.
std::string zones_text(std::span<const Zone> zones);

}  // namespace spherule
