// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "tests/simplifier/judge.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace spherule::test {

inline Eigen::Isometry3d random_pose(Random& random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = random.rotation().toRotationMatrix();
  pose.translation() = 0.3 * random.direction();
  return pose;
}

// A flood of its own: nodes of a grid whose exact distance leaves room for a sphere, from node to
// node where the sphere provably passes. The radius that it has to have follows the place, and is
// on a segment no more than the greater of those at its ends.
class FineFlood {
 public:
  // `radius_at(place)` is at most `greatest`.
  template <typename Radius>
  FineFlood(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box, double step, double greatest,
            Radius radius_at)
      : step_(step), origin_(box.min() - Eigen::Vector3d::Constant(2.0 * greatest)) {
    const Eigen::Vector3d size = box.sizes() + Eigen::Vector3d::Constant(4.0 * greatest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<int>(std::ceil(size[static_cast<int>(axis)] / step)) + 1;
    }
    for_each_node([&](int i, int j, int k) {
      clearance_.push_back(static_cast<double>(judged_mesh_distance(at(i, j, k), mesh)));
      radius_.push_back(radius_at(at(i, j, k)));
    });
    flood();
  }

  template <typename Visit>
  void for_each_reached(Visit visit) const {
    for_each_node([&](int i, int j, int k) {
      if (reached_[index(i, j, k)]) visit(at(i, j, k));
    });
  }

 private:
  template <typename Visit>
  void for_each_node(Visit visit) const {
    for (int k = 0; k < count_[2]; ++k) {
      for (int j = 0; j < count_[1]; ++j) {
        for (int i = 0; i < count_[0]; ++i) visit(i, j, k);
      }
    }
  }
  Eigen::Vector3d at(int i, int j, int k) const {
    return origin_ + step_ * Eigen::Vector3d(i, j, k);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i);
  }
  void flood() {
    reached_.assign(radius_.size(), false);
    std::vector<std::array<int, 3>> front{{0, 0, 0}};
    reached_[0] = true;
    while (!front.empty()) {
      const std::array<int, 3> here = front.back();
      front.pop_back();
      const std::size_t from = index(here[0], here[1], here[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int by : {-1, 1}) {
          std::array<int, 3> next = here;
          next[axis] += by;
          if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
          const std::size_t there = index(next[0], next[1], next[2]);
          const double radius = std::max(radius_[from], radius_[there]);
          const double least = (clearance_[from] + clearance_[there] - step_) / 2.0;
          if (reached_[there] || clearance_[there] < radius_[there] || least < radius) continue;
          reached_[there] = true;
          front.push_back(next);
        }
      }
    }
  }

  double step_;
  Eigen::Vector3d origin_;
  std::array<int, 3> count_{};
  std::vector<double> clearance_;  // of each node, as the others
  std::vector<double> radius_;
  std::vector<bool> reached_;
};

// Blocks that stand close to each other, with gaps around D.
inline TriangleMesh random_blocks(Random& random) {
  TriangleMesh mesh;
  for (int n = 0; n < 9; ++n) {
    const Eigen::Vector3d low = 1.6 * random.unit() * random.direction();
    const Eigen::Vector3d size(random.between(0.2, 1.4), random.between(0.2, 1.4),
                               random.between(0.2, 1.4));
    const TriangleMesh block = moved(box_mesh(low, low + size), random_pose(random));
    mesh = n == 0 ? block : joined(mesh, block);
  }
  return mesh;
}

}  // namespace spherule::test
