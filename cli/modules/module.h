// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/baseline/level_set_packing.h"
#include "simplifier/cad/cad_file.h"

#include <filesystem>
#include <vector>

namespace spherule {

// Parts of the command that stand on large libraries (OpenCASCADE, OpenVDB), each a shared object
// that is loaded when it is first needed: to load these libraries and what they need takes 0.1 s of
// processor time, thirty times as much as everything else at the start of a run.
//
// A module exports one object, `spherule_module`, of the functions that the command calls.

struct CadModule {
  CadPart (*read)(const std::filesystem::path&, const CadReadOptions&);
  std::vector<CadBody> (*read_bodies)(const std::filesystem::path&, const CadReadOptions&);
};

struct LevelSetModule {
  std::vector<Sphere> (*pack)(const TriangleMesh&, const LevelSetPackingOptions&);
};

// The functions of a module, which stays loaded until the end of the run. May be called from
// several threads. Throws Error, naming the file of the module, if it cannot be loaded.
const CadModule& cad_module();
const LevelSetModule& level_set_module();

}  // namespace spherule
