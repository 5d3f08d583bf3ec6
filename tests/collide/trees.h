// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/instruction_set.h"
#include "spheretree/sphere_tree.h"
#include "tests/collide/scene_random.h"

#include <memory>
#include <vector>

namespace spherule::test {

// `count` spheres with centres in a cube of half side `size`.
std::vector<Sphere> random_spheres(SceneRandom& random, int count, double size,
                                   double largest_radius);

// A tree as deep as can be: every inner node has `branching` - 1 leaves and, but for the last, one
// inner node, which is its last child (or its first). All its spheres meet near the origin, so that
// a traversal of two of them prunes nothing.
SphereTree caterpillar(int depth, int branching, bool inner_first);

// A tree of one sphere.
std::shared_ptr<const SphereTree> one_sphere_tree(const Eigen::Vector3d& center, double radius);

// Those that this machine has.
std::vector<InstructionSet> instruction_sets();

}  // namespace spherule::test
