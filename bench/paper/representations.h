// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// What the paper's table says of a method.
struct PaperRow {
  std::string complexity;
  std::size_t collisions = 0;
  double seconds = 0.0;
};

// A way to represent the work cell, as an engine.
struct Representation {
  std::string method;      // its name in paper.json
  std::string complexity;  // of the workpiece; of everything where everything is simplified
  bool is_conservative = false;
  std::unique_ptr<Checker> checker;
  std::optional<PaperRow> paper = {};
};

// The rows of table I, of a fitted workload: the original meshes first; then the workpiece
// decimated to half, its hull and a convex decomposition, all queried by FCL; packed, voxelised and
// in bounding spheres, by the paper's loop and by ours, against robot and torch as meshes; then all
// in spheres. Packing and voxels stand there as the paper has them and once more so that they
// cover.
std::vector<Representation> make_representations(const Workload& workload);

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

// FCL on convex parts (GJK by libccd) in place of one obstacle's mesh: the bodies and all other
// obstacles stay meshes, in hierarchies of OBBRSS in double behind exact axis-parallel boxes. The
// parts are closed, convex, with outward triangles, in the obstacle's frame. Throws Error for no
// parts.
std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts);

}  // namespace spherule
