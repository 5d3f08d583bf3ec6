// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/baseline/level_set_packing.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// Parts of the command that stand on large libraries: OpenCASCADE in a program of its own
// (cli/cad), OpenVDB in a shared object that is loaded when it is first needed. To load these
// libraries and what they need takes 0.1 s of processor time, thirty times as much as everything
// else at the start of a run.

// Where such a part stands: where SPHERULE_MODULE_FOLDER leads from the folder of the command, so
// that the prefix may be moved.
std::filesystem::path module_path(const std::string& name);

// A module exports one object, `spherule_module`, of the functions that the command calls.
struct LevelSetModule {
  std::vector<Sphere> (*pack)(const TriangleMesh&, const LevelSetPackingOptions&);
};

// The functions of a module, which stays loaded until the end of the run. May be called from
// several threads. Throws Error, naming the file of the module, if it cannot be loaded.
const LevelSetModule& level_set_module();

}  // namespace spherule
