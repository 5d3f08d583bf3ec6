// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/balls_inside.h"

#include "collide/search/one_tree.h"
#include "collide/solids/mesh_inside.h"
#include "mesh/point_triangle.h"

#include <algorithm>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Whether a triangle comes within a reach of a point.
class FindTriangle {
 public:
  FindTriangle(const MeshTree& mesh, const Vector3d& point, double reach)
      : mesh_(mesh), point_(point), reach_(reach) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    const Sphere ball = mesh_.tree().ball(static_cast<std::size_t>(node));
    const double limit = ball.radius + reach_;
    return (ball.center - point_).squaredNorm() <= limit * limit;
  }
  bool leaf(std::int32_t node) {
    const auto& [a, b, c] =
        mesh_.triangle(mesh_.tree().sphere_index(static_cast<std::size_t>(node)));
    found_ = point_triangle_distance(point_, a, b, c).lower <= reach_;
    return !found_;
  }
  bool found() const { return found_; }

 private:
  const MeshTree& mesh_;
  const Vector3d point_;
  const double reach_;
  bool found_ = false;
};

// Ends at the first sphere that is inside. Remembers the last few balls that were found to be
// outside: the next sphere most often overlaps one of them.
class FindInside {
 public:
  FindInside(const SphereTree& tree, const BallsInside& balls) : tree_(tree), balls_(balls) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) {
    const auto index = static_cast<std::size_t>(node);
    const Sphere ball = tree_.ball(index);
    const Vector3d center = balls_.in_mesh(ball.center);
    if (balls_.is_outside_box(center, ball.radius)) return false;
    if (tree_.is_leaf(index) || !balls_.is_clear(center, ball.radius)) return true;
    if (balls_.contains(center)) return true;
    remember(ball);
    return false;
  }
  bool leaf(std::int32_t node) {
    const auto index = static_cast<std::size_t>(node);
    const Sphere ball = tree_.ball(index);
    if (overlaps_outside(ball)) return true;
    if (balls_.contains(balls_.in_mesh(ball.center))) {
      inside_ = tree_.sphere_index(index);
      return false;
    }
    remember(ball);
    return true;
  }
  std::int32_t inside() const { return inside_; }

 private:
  bool overlaps_outside(const Sphere& ball) const {
    return std::any_of(outside_.begin(), outside_.begin() + static_cast<std::ptrdiff_t>(known_),
                       [&](const Sphere& other) {
                         return distance_upper(other.center, ball.center) <=
                                next_down(other.radius + ball.radius);
                       });
  }
  void remember(const Sphere& ball) {
    outside_[next_] = ball;
    next_ = (next_ + 1) % outside_.size();
    known_ = std::min(known_ + 1, outside_.size());
  }

  const SphereTree& tree_;
  const BallsInside& balls_;
  std::array<Sphere, 16> outside_;
  std::size_t next_ = 0;
  std::size_t known_ = 0;
  std::int32_t inside_ = -1;
};

}  // namespace

BallsInside::BallsInside(const SphereTree& tree, const SolidMesh& solid, const RelativePose& pose)
    : tree_(tree),
      solid_(solid),
      mesh_from_tree_(pose.b_from_a()),
      error_(144.0 * kUnitRoundoff * pose.node_size() + kUnderflow),
      pad_(160.0 * kUnitRoundoff * pose.node_size() + 8.0 * kUnderflow) {}

bool BallsInside::contains(const Vector3d& in_mesh) const {
  return solid_.inside().contains(solid_.mesh(), in_mesh, error_);
}

bool BallsInside::certainly_contains(const Vector3d& in_mesh) const {
  return solid_.inside().find(solid_.mesh(), in_mesh, error_).value_or(false);
}

bool BallsInside::is_outside_box(const Vector3d& in_mesh, double radius) const {
  const Eigen::AlignedBox3d& box = solid_.inside().box();
  const double reach = radius + pad_;
  for (int k = 0; k < 3; ++k) {
    if (in_mesh[k] + reach < box.min()[k] || in_mesh[k] - reach > box.max()[k]) return true;
  }
  return false;
}

bool BallsInside::is_clear(const Vector3d& in_mesh, double radius) const {
  FindTriangle query(solid_.mesh(), in_mesh, radius + pad_);
  search_tree(solid_.mesh().tree(), query);
  return !query.found();
}

std::int32_t BallsInside::find() const {
  if (!solid_.has_inside()) return -1;
  FindInside query(tree_, *this);
  search_tree(tree_, query);
  return query.inside();
}

}  // namespace spherule::internal
