// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The options of simplify() as they are stored beside the spheres, and back; the names that its
// methods, placements and levels have there and on the command line.

#include "io/sphere_file.h"
#include "simplifier/types/simplification.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// The names of methods and placements on the command line and in files, the default first, and what
// they name. Error for another name.
std::vector<std::string> method_names();
CoverMethod method_named(const std::string& name);
std::vector<std::string> placement_names();
ExternalPlacement placement_named(const std::string& name);

// Errors of levels as they are written on the command line and in files, "80,40,20", and back.
// Error for a text that is not numbers with commas between them.
std::vector<double> levels_named(const std::string& text);
std::string name_of_levels(std::span<const double> levels);

// The options under their command-line names, for SphereFile::options; `scale` is the one the mesh
// was read with. And back, for an audit: what is absent keeps its default, but "tightness" becomes
// ExternalOptions::kNoTightness, with which files that lack it were made. Throws Error naming the
// option for a bad value. A method that is none of method_names() comes back as the name of a
// stage 2 method that cannot be run: an audit judges spheres of any origin.
std::map<std::string, OptionValue> option_record(const SimplifyOptions& options, double scale);
SimplifyOptions options_from_record(const std::map<std::string, OptionValue>& record);

}  // namespace spherule
