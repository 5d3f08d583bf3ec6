// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cad/internal/cad_translation.h"

#include <vector>

class STEPCAFControl_Reader;

namespace spherule::internal {

// Has the reader, which has read its file, translate all of it, and names the parts of the
// assembly: "GEARBOX/SHAFT", by their place in it where that has a name, else by the part. May
// throw what OpenCASCADE throws.
std::vector<CadLeaf> leaves_of_assembly(STEPCAFControl_Reader& reader);

// Parts of several solids as these, "PLATE/1", "PLATE/2", and what is no solid as another;
// parts without faces are left out. No name is there twice: others of it become "BOLT:2", "BOLT:3".
std::vector<CadLeaf> split_solids(const std::vector<CadLeaf>& leaves);

}  // namespace spherule::internal
