// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/parts/baseline.h"
#include "io/sphere_file.h"
#include "simplifier/baseline/hubbard_spheres.h"
#include "simplifier/baseline/level_set_packing.h"
#include "simplifier/baseline/medial_axis.h"
#include "simplifier/baseline/octree_spheres.h"
#include "simplifier/baseline/sphere_packing.h"
#include "simplifier/baseline/voxelisation.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// What the methods that make spheres take; each has options for some of it.
struct SphereArguments : BaselineArguments {
  double padding = 0.0;
  int threads = 0;
  bool conservative = false;
  std::string tree_file;
  std::uint64_t seed = 1;
  bool surface = false;
  bool inflated = false;
  bool levels = false;  // the medial axis as a tree
  std::string sphere;
  std::string reduction;
  VoxelisationOptions voxelisation;
  SpherePackingOptions packing;
  LevelSetPackingOptions level_set;
  MedialAxisOptions medial;
  MedialTreeOptions medial_tree;
  OctreeSpheresOptions octree;
  HubbardOptions hubbard;
};

// What a method makes of a mesh.
struct MadeSpheres {
  std::vector<Sphere> spheres;
  // What only this method has to tell.
  Json figures = Json::object();
  // What was required of it, for SphereFile::options.
  std::map<std::string, OptionValue> options;
  // The method's own tree over `leaves`: the spheres as they are, or each as large or larger.
  // Absent if it makes none.
  std::function<SphereTree(std::span<const Sphere> leaves)> tree = {};
};

// A method is one row: what its help says, what only it takes, and the call.
struct SphereBaseline {
  BaselineText text;
  void (*add_options)(CLI::App&, SphereArguments&);
  MadeSpheres (*run)(const TriangleMesh&, const SphereArguments&, const Progress&);
};
const std::vector<SphereBaseline>& sphere_baselines();

}  // namespace spherule
