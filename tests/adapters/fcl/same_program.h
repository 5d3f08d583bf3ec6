// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <fcl/common/types.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {

// What the program is given: models, and where two of them, or all of them, are.
struct ProgramModel {
  TriangleMesh mesh;
  double max_error = 0.0;  // for the edition with spheres
  bool confirm_on_triangles = false;
};

struct PlacedPair {
  std::size_t a = 0, b = 0;  // models
  fcl::Transform3d tf_a, tf_b;
};

struct PairAnswer {
  bool geometry_collides = false;  // queried with geometries and transforms
  bool object_collides = false;    // queried with objects
  double distance = 0.0;           // requested only where the objects do not collide
};

// The same program twice: its answers by FCL and by spherule. `distances`: also require these.
std::vector<PairAnswer> query_pairs_fcl(const std::vector<ProgramModel>& models,
                                        const std::vector<PlacedPair>& pairs, bool distances);
std::vector<PairAnswer> query_pairs_spherule(const std::vector<ProgramModel>& models,
                                             const std::vector<PlacedPair>& pairs, bool distances);

// The pairs of objects that collide, by their index, each with the smaller one first: as found with
// each manager of these names.
using ObjectPairs = std::vector<std::pair<std::size_t, std::size_t>>;
struct PlacedModel {
  std::size_t model = 0;
  fcl::Transform3d tf;
};
std::vector<ObjectPairs> query_managers_fcl(const std::vector<std::string>& managers,
                                            const std::vector<ProgramModel>& models,
                                            const std::vector<PlacedModel>& objects);
std::vector<ObjectPairs> query_managers_spherule(const std::vector<std::string>& managers,
                                                 const std::vector<ProgramModel>& models,
                                                 const std::vector<PlacedModel>& objects);

}  // namespace spherule::test
