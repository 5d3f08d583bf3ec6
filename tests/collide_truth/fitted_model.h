// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"

#include <Eigen/Core>

#include <cstddef>
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

// Two placed models and what FCL says of them.
struct JudgedPose {
  Pose world_from_a, world_from_b;
  bool touching = false;
};

// At least `count` poses of a pair: random ones, and ones that were bisected along random
// directions until the models are within 2 mm, 0.1 mm and 1e-3 mm of the border between touching
// and free, with a pose on each side of the border. Every pose that the search has judged is
// returned. Lengths in millimetres.
std::vector<JudgedPose> judged_poses(const FittedModel& a, const FittedModel& b, std::size_t count,
                                     Random& random);

}  // namespace spherule::test
