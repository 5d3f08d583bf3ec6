// SPDX-License-Identifier: BSD-3-Clause
#include "tests/collide/trees.h"

#include "spheretree/build.h"

namespace spherule::test {

std::vector<Sphere> random_spheres(SceneRandom& random, int count, double size,
                                   double largest_radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center = random.point(size);
    spheres.push_back({center, random.uniform(0.0, largest_radius)});
  }
  return spheres;
}

SphereTree caterpillar(int depth, int branching, bool inner_first) {
  SphereTreeData data;
  const auto add = [&](double radius, int first_child, int child_count) {
    data.x.push_back(0.0);
    data.y.push_back(0.0);
    data.z.push_back(0.0);
    data.radius.push_back(radius);
    data.first_child.push_back(first_child);
    data.child_count.push_back(child_count);
  };
  const auto add_leaf = [&] {
    const double radius = 1.0 + static_cast<double>(data.spheres.size()) * 1e-6;
    add(radius, static_cast<int>(data.spheres.size()), 0);
    data.spheres.push_back({Eigen::Vector3d::Zero(), radius});
  };
  add(4.0 + depth, 1, branching);
  for (int level = 1; level <= depth; ++level) {
    const bool last = level == depth;
    const int first = static_cast<int>(data.radius.size());
    for (int i = 0; i < branching; ++i) {
      const bool inner = !last && i == (inner_first ? 0 : branching - 1);
      if (inner) {
        add(4.0 + depth - level, first + branching, branching);
      } else {
        add_leaf();
      }
    }
  }
  return SphereTree(std::move(data));
}

std::shared_ptr<const SphereTree> one_sphere_tree(const Eigen::Vector3d& center, double radius) {
  return std::make_shared<const SphereTree>(build_tree(std::vector<Sphere>{{center, radius}}));
}

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::kPortable};
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace spherule::test
