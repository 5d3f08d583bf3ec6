// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/pair_front.h"

#include "robot/pairs/internal/hull_direction.h"
#include "spheretree/rounding.h"

#include <cstddef>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Pairs of leaves that one box leaves open before it is given up and halved, and of nodes that are
// handed down: beyond that the halves start from the roots.
constexpr std::size_t kMostOpenLeaves = 4;
constexpr std::size_t kLongestFront = 96;

bool pieces_apart(const PlacedPair& pair, const LinkPieces::Node& of_a,
                  const LinkPieces::Node& of_b, const Vector3d& start) {
  const auto points_of = [](const LinkPieces& pieces, const LinkPieces::Node& node) {
    return std::span(pieces.points)
        .subspan(static_cast<std::size_t>(node.first_point),
                 static_cast<std::size_t>(node.point_count));
  };
  const auto first = points_of(pair.of_first, of_a);
  const auto second = points_of(pair.of_second, of_b);
  const double radii = add_up(of_a.radius, of_b.radius);
  Vector3d direction = start.squaredNorm() > 0.0 ? start : Vector3d::UnitX();
  if (pair.direction_between(first, second, direction) <= radii) return false;
  return pair.bound.are_apart(direction, pair.world_from_first, first, pair.world_from_second,
                              second, radii);
}

}  // namespace

double PlacedPair::direction_between(std::span<const Vector3d> first,
                                     std::span<const Vector3d> second, Vector3d& direction) const {
  const Eigen::Matrix3d& rotation = world_from_first.matrix();
  const HullDirection found = hull_direction(
      first, second, rotation.transpose() * world_from_second.matrix(),
      rotation.transpose() * (world_from_second.translation() - world_from_first.translation()),
      rotation.transpose() * direction);
  direction = (rotation * found.direction).normalized();
  return found.gap;
}

bool clear_front(const PlacedPair& pair, std::vector<PieceNodes>& front, std::size_t& tests) {
  const LinkPieces& a = pair.of_first;
  const LinkPieces& b = pair.of_second;
  std::vector<PieceNodes> todo = std::move(front);
  front.clear();
  std::vector<PieceNodes> open_leaves;
  const auto way_between = [&pair](const Sphere& of_a, const Sphere& of_b) -> Vector3d {
    return pair.world_from_first * of_a.center - pair.world_from_second * of_b.center;
  };
  const auto gap = [&](const PieceNodes& nodes) {
    const Sphere& of_a = a.nodes[static_cast<std::size_t>(nodes.first)].sphere;
    const Sphere& of_b = b.nodes[static_cast<std::size_t>(nodes.second)].sphere;
    return way_between(of_a, of_b).norm() - of_a.radius - of_b.radius;
  };
  // What is nearest comes first: it is the likeliest to stay open, and then the rest need not be
  // examined.
  const auto add = [&](const PieceNodes& one, const PieceNodes& other) {
    const bool is_nearer = gap(one) < gap(other);
    todo.push_back(is_nearer ? other : one);
    todo.push_back(is_nearer ? one : other);
  };
  while (!todo.empty() && open_leaves.size() < kMostOpenLeaves) {
    ++tests;
    const PieceNodes nodes = todo.back();
    todo.pop_back();
    const auto& of_a = a.nodes[static_cast<std::size_t>(nodes.first)];
    const auto& of_b = b.nodes[static_cast<std::size_t>(nodes.second)];
    const Vector3d way = way_between(of_a.sphere, of_b.sphere);
    const double length = way.norm();
    const double radii = add_up(of_a.sphere.radius, of_b.sphere.radius);
    if (length > radii &&
        pair.bound.are_apart(way / length, pair.world_from_first, std::span(&of_a.sphere.center, 1),
                             pair.world_from_second, std::span(&of_b.sphere.center, 1), radii)) {
      continue;
    }
    if (of_a.point_count > 0 && of_b.point_count > 0 && pieces_apart(pair, of_a, of_b, way))
      continue;
    const bool is_leaf = of_a.first_child < 0;
    const bool other_is_leaf = of_b.first_child < 0;
    if (is_leaf && other_is_leaf) {
      open_leaves.push_back(nodes);
    } else if (other_is_leaf || (!is_leaf && of_a.sphere.radius > of_b.sphere.radius)) {
      add({of_a.first_child, nodes.second}, {of_a.first_child + 1, nodes.second});
    } else {
      add({nodes.first, of_b.first_child}, {nodes.first, of_b.first_child + 1});
    }
  }
  if (open_leaves.empty()) return true;
  front = std::move(todo);
  front.insert(front.end(), open_leaves.begin(), open_leaves.end());
  if (front.size() > kLongestFront) front = {{0, 0}};
  return false;
}

}  // namespace spherule::internal
