// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_file.h"
#include "cli/files/model_unit.h"
#include "simplifier/bodies.h"

#include <optional>
#include <string>
#include <vector>

namespace spherule {

// The bodies of several files, or of an assembly.
struct ModelBodies {
  std::vector<Body> bodies;
  std::vector<std::optional<CadPart>> cad;  // of each; its mesh is moved out
  std::vector<double> scales;               // that each was read with
};

// The units of several files, which all are to come out in the same. Throws Error as model_unit()
// does, and naming two files that would not.
std::vector<ModelUnit> model_units(const std::vector<std::string>& files,
                                   const UnitArguments& arguments);

// The context of lengths on the command line for them.
LengthContext length_context(const std::vector<std::string>& files,
                             const std::vector<ModelUnit>& units);

// Reads a body a file, named as the file without its ending; of CAD files every body of the
// assembly if they are to be `split`, where there are several files after the name of theirs. Warns
// on standard error of bodies whose deviation is not proved. Throws Error, also for a file that is
// named twice.
ModelBodies read_bodies(const std::vector<std::string>& files, const std::vector<ModelUnit>& units,
                        const ModelReadOptions& options, bool split);

// The mesh of a body in its place, also of a copy.
TriangleMesh mesh_of(const ModelBodies& model, std::size_t body);

}  // namespace spherule
