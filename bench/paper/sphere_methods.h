// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace spherule {

// A way to make spheres of a mesh that is told how fine they are to be.
struct SphereMethod {
  std::string name;
  // `error` is what the method may err by at most, in the unit of the mesh: the smaller,
  // the more spheres. What the method makes of it is its own business.
  std::function<std::vector<Sphere>(const TriangleMesh& mesh, double error)> make;
};

// Those that are compared: packing, OpenVDB's own, voxels, octree, Hubbard's and medial-axis
// spheres as the literature makes them; the bounding sphere simplification by the paper's loop and
// by ours after stage 1 with D = 4 E; and ours with D = E, at which hardly any part changes
// ("cover-as-is"; the paper's loop without stage 1 is the packing).
std::vector<SphereMethod> sphere_methods();

}  // namespace spherule
