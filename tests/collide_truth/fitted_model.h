// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/fcl_solid.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace spherule::test {

// A mesh, its spheres, and what is proved about them. Lengths in millimetres.
struct FittedModel {
  std::string name;
  TriangleMesh triangles;
  FclSolid mesh;  // the same
  SphereTree tree;
  Eigen::Vector3d center;   // of its box
  double radius;            // of a sphere about `center` that encloses the mesh
  double max_error;         // E
  double protrusion_bound;  // certified: no sphere reaches further than this from the mesh
};

// Fits the mesh with E of `error_share` of its box diagonal and D of four E. `radius_factor` other
// than 1 spoils the spheres.
FittedModel fit_model(const std::string& name, const TriangleMesh& mesh, double error_share = 0.05,
                      double radius_factor = 1.0);

// The plain solids that every run uses, by name, and their fits, made once per process.
TriangleMesh shape_mesh(const std::string& name);
const FittedModel& shape_model(const std::string& name);

// A model below the folder of SPHERULE_MODELS, made once per process; `millimetres` is the length
// of the unit of its file.
const FittedModel& real_model(const std::string& file, double millimetres);

}  // namespace spherule::test
