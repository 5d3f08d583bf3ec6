// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/check/voxel_solids.h"

#include "spheretree/sphere_tree.h"
#include "tests/robot/solid_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

bool has(const std::vector<Vector3i>& cells, const Vector3i& cell) {
  return std::find(cells.begin(), cells.end(), cell) != cells.end();
}

std::vector<Vector3i> random_row(Random& random, int count) {
  std::vector<Vector3i> cells = {Vector3i::Zero()};
  Vector3i step = Vector3i::UnitX();
  while (static_cast<int>(cells.size()) < count) {
    if (random.whole(0, 2) == 0) {
      step.setZero();
      step[random.whole(0, 2)] = random.whole(0, 1) == 0 ? 1 : -1;
    }
    const Vector3i next = cells.back() + step;
    if (has(cells, next)) {
      step.setZero();
      step[random.whole(0, 2)] = random.whole(0, 1) == 0 ? 1 : -1;
      continue;
    }
    cells.push_back(next);
  }
  return cells;
}

}  // namespace

VoxelSolid::VoxelSolid(Random& random, int cells, double cell_size) : half_(0.5 * cell_size) {
  const std::vector<Vector3i> row = random_row(random, cells);
  std::vector<Sphere> spheres;
  for (const Vector3i& cell : row) {
    centers_.push_back(cell_size * cell.cast<double>());
    spheres.push_back({centers_.back(), 1.7321 * half_});
  }
  make_mesh(row);
  for (const Vector3d& vertex : mesh_.vertices) reach_ = std::max(reach_, vertex.norm());
  covered_ = std::make_shared<const CoveredMesh>(
      mesh_, std::make_shared<const SphereTree>(build_tree(spheres)));
  surface_ = std::make_shared<const FclSolid>(mesh_);
}

// Two triangles for every face between a cell and what is no cell, turned outward.
void VoxelSolid::make_mesh(const std::vector<Vector3i>& cells) {
  std::map<std::tuple<int, int, int>, int> index_of;
  const auto vertex = [&](const Vector3i& doubled) {
    const auto [found, is_new] = index_of.try_emplace({doubled.x(), doubled.y(), doubled.z()},
                                                      static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(half_ * doubled.cast<double>());
    return found->second;
  };
  for (const Vector3i& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        Vector3i out = Vector3i::Zero(), u = Vector3i::Zero(), v = Vector3i::Zero();
        out[axis] = sign;
        if (has(cells, cell + out)) continue;
        u[(axis + 1) % 3] = sign;  // u, v and out are right-handed
        v[(axis + 2) % 3] = 1;
        const std::array<int, 4> corners = {
            vertex(2 * cell + out - u - v), vertex(2 * cell + out + u - v),
            vertex(2 * cell + out + u + v), vertex(2 * cell + out - u + v)};
        mesh_.triangles.emplace_back(corners[0], corners[1], corners[2]);
        mesh_.triangles.emplace_back(corners[0], corners[2], corners[3]);
      }
    }
  }
}

double VoxelSolid::distance_from(const Vector3d& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& center : centers_) {
    const Vector3d off = ((p - center).cwiseAbs() - Vector3d::Constant(half_)).cwiseMax(0.0);
    least = std::min(least, off.norm());
  }
  return least;
}

double VoxelSolid::lowest(const Pose& world_from_solid) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : mesh_.vertices) {
    least = std::min(least, (world_from_solid * vertex).z());
  }
  return least;
}

double VoxelSolid::distance_from(const Pose& world_from_solid, const Primitive& other,
                                 double radius, const Pose& world_from_other) const {
  const Pose other_from_solid = world_from_other.inverse() * world_from_solid;
  const Primitive cell = Box{Vector3d::Constant(2.0 * half_)};
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& center : centers_) {
    const Pose other_from_cell = other_from_solid * Pose::from_translation(center);
    // Not below, for what is further than the nearest so far.
    const double apart = other_from_cell.translation().norm() - radius - std::sqrt(3.0) * half_;
    least = std::min(least, apart > std::min(least, kFarApart)
                                ? apart
                                : test::distance_between(cell, other_from_cell, other, Pose()));
  }
  return least;
}

double distance_between(const VoxelSolid& a, const Pose& world_from_a, const VoxelSolid& b,
                        const Pose& world_from_b) {
  const double apart = (world_from_a.translation() - world_from_b.translation()).norm();
  if (apart - a.reach_ - b.reach_ > kFarApart) return apart - a.reach_ - b.reach_;
  const Pose b_from_a = world_from_b.inverse() * world_from_a;
  if (b.distance_from(b_from_a * a.centers_.front()) == 0.0 ||
      a.distance_from(b_from_a.inverse() * b.centers_.front()) == 0.0 ||
      touch(*a.surface_, world_from_a, *b.surface_, world_from_b)) {
    return 0.0;
  }
  return surface_distance(*a.surface_, world_from_a, *b.surface_, world_from_b);
}

}  // namespace spherule::test
