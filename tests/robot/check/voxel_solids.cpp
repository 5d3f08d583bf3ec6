// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/check/voxel_solids.h"

#include "spheretree/build.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>
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

fcl::Transform3d transform_of(const Pose& pose) {
  fcl::Transform3d result = fcl::Transform3d::Identity();
  result.linear() = pose.matrix();
  result.translation() = pose.translation();
  return result;
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
  model_ = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model_->beginModel();
  for (const Vector3i& t : mesh_.triangles) {
    const auto corner = [&](int k) { return mesh_.vertices[static_cast<std::size_t>(t[k])]; };
    model_->addTriangle(corner(0), corner(1), corner(2));
  }
  model_->endModel();
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

// Solids whose surfaces are apart are so, or one holds all cells of the other.
double distance_between(const VoxelSolid& a, const Pose& world_from_a, const VoxelSolid& b,
                        const Pose& world_from_b) {
  const double apart = (world_from_a.translation() - world_from_b.translation()).norm();
  if (apart - a.reach_ - b.reach_ > kFarApart) return apart - a.reach_ - b.reach_;
  const Pose a_from_world = world_from_a.inverse(), b_from_world = world_from_b.inverse();
  if (a.distance_from(a_from_world * (world_from_b * b.centers_.front())) == 0.0 ||
      b.distance_from(b_from_world * (world_from_a * a.centers_.front())) == 0.0) {
    return 0.0;
  }
  const fcl::Transform3d of_a = transform_of(world_from_a), of_b = transform_of(world_from_b);
  fcl::CollisionResultd contacts;
  if (fcl::collide(a.model_.get(), of_a, b.model_.get(), of_b, fcl::CollisionRequestd(1, false),
                   contacts) > 0) {
    return 0.0;
  }
  fcl::DistanceResultd distance;
  fcl::distance(a.model_.get(), of_a, b.model_.get(), of_b, fcl::DistanceRequestd(), distance);
  return std::max(distance.min_distance, 0.0);
}

}  // namespace spherule::test
