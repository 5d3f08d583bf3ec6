// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/cover_proof.h"

#include "collide/internal/triangle_pair.h"
#include "spheretree/error.h"
#include "spheretree/point_triangle.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

bool possibly_meet(const Sphere& ball, const Triangle& t) {
  return point_triangle_distance(ball.center, t[0], t[1], t[2]).lower <= ball.radius;
}

void collect_triangles(const MeshTree& mesh, const Sphere& ball, std::size_t node,
                       std::vector<std::int32_t>& found) {
  const SphereTree& tree = mesh.tree();
  if (!possibly_overlap(tree.ball(node), ball)) return;
  if (tree.is_leaf(node)) {
    const std::int32_t index = tree.sphere_index(node);
    if (possibly_meet(ball, mesh.triangle(index))) found.push_back(index);
    return;
  }
  for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
    collect_triangles(mesh, ball, static_cast<std::size_t>(tree.first_child(node) + i), found);
  }
}

// List j of the result has i if list i has j.
Lists transposed(const Lists& lists, std::size_t count) {
  Lists result;
  result.first.assign(count + 1, 0);
  for (const std::int32_t value : lists.values) ++result.first[static_cast<std::size_t>(value) + 1];
  for (std::size_t i = 0; i < count; ++i) result.first[i + 1] += result.first[i];
  std::vector<std::int32_t> next(result.first.begin(), result.first.end() - 1);
  result.values.resize(lists.values.size());
  for (std::size_t i = 0; i + 1 < lists.first.size(); ++i) {
    for (const std::int32_t value : lists.of(i)) {
      result.values[static_cast<std::size_t>(next[static_cast<std::size_t>(value)]++)] =
          static_cast<std::int32_t>(i);
    }
  }
  return result;
}

// Proof for one triangle at a time.
class Proof {
 public:
  Proof(std::span<const Sphere> balls, double error) : balls_(balls), error_(error) {}

  bool covers(const Triangle& triangle, std::span<const std::int32_t> candidates) {
    candidates_.assign(candidates.begin(), candidates.end());
    pieces_left_ = kPieces * (candidates.size() + 1);
    return covers(triangle, 0, 0, 0.0);
  }

  // Of the piece that was not proved to be covered.
  const Vector3d& open_point() const { return open_point_; }

 private:
  // Pieces for each ball that meets the triangle, and halvings of one piece: see prove_cover().
  static constexpr std::size_t kPieces = 4096;
  static constexpr int kDepth = 80;

  // Whether the balls cover the piece; those that may meet it are candidates_ from `first` on.
  bool covers(const Triangle& piece, std::size_t first, int depth, double error) {
    const std::size_t end = candidates_.size();
    for (std::size_t i = first; i < end; ++i) {
      const Sphere& ball = balls_[static_cast<std::size_t>(candidates_[i])];
      const auto contains = [&](const Vector3d& p) { return certainly_contains(ball, p, error); };
      if (contains(piece[0]) && contains(piece[1]) && contains(piece[2])) return true;
    }
    open_point_ = (piece[0] + piece[1] + piece[2]) / 3.0;
    if (first == end || depth == kDepth || pieces_left_ < 2) return false;
    pieces_left_ -= 2;
    const std::size_t longest = longest_edge(piece);
    const Vector3d& from = piece[longest];
    const Vector3d& to = piece[(longest + 1) % 3];
    const Vector3d& apex = piece[(longest + 2) % 3];
    const Vector3d middle = (from + to) / 2.0;
    for (const Triangle& half : {Triangle{from, middle, apex}, Triangle{middle, to, apex}}) {
      for (std::size_t i = first; i < end; ++i) {
        Sphere ball = balls_[static_cast<std::size_t>(candidates_[i])];
        ball.radius = add_up(ball.radius, error_);
        if (possibly_meet(ball, half)) candidates_.push_back(candidates_[i]);
      }
      const bool covered = covers(half, end, depth + 1, error_);
      candidates_.resize(end);
      if (!covered) return false;
    }
    return true;
  }

  static std::size_t longest_edge(const Triangle& t) {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if ((t[(k + 1) % 3] - t[k]).squaredNorm() >
          (t[(longest + 1) % 3] - t[longest]).squaredNorm()) {
        longest = k;
      }
    }
    return longest;
  }

  std::span<const Sphere> balls_;
  double error_;
  std::vector<std::int32_t> candidates_;
  std::size_t pieces_left_ = 0;
  Vector3d open_point_ = Vector3d::Zero();
};

}  // namespace

Lists triangles_meeting(const MeshTree& mesh, std::span<const Sphere> balls) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  Lists result;
  result.first.push_back(0);
  std::vector<std::int32_t> found;
  for (const Sphere& ball : balls) {
    found.clear();
    collect_triangles(mesh, ball, 0, found);
    std::sort(found.begin(), found.end());
    if (found.size() > kMost - result.values.size()) {
      throw Error("cover", "its spheres meet more than 2^31 - 1 triangles in all");
    }
    result.values.insert(result.values.end(), found.begin(), found.end());
    result.first.push_back(static_cast<std::int32_t>(result.values.size()));
  }
  return result;
}

void prove_cover(const MeshTree& mesh, std::span<const Sphere> balls, const Lists& triangles) {
  // A midpoint is off by at most 2 u times the largest coordinate in all, and the midpoint of
  // points that are off by some amount by no more than that and one rounding: less than 2 * 80 u.
  const double error = 256.0 * kUnitRoundoff * mesh.tree().reach();
  const std::size_t count = mesh.tree().spheres().size();
  const Lists balls_of = transposed(triangles, count);
  Proof proof(balls, error);
  for (std::size_t i = 0; i < count; ++i) {
    if (proof.covers(mesh.triangle(static_cast<std::int32_t>(i)), balls_of.of(i))) continue;
    std::ostringstream text;
    text << "its spheres do not cover triangle " << i << " of the mesh, near ("
         << proof.open_point().transpose() << ")";
    throw Error("cover", text.str());
  }
}

}  // namespace spherule::internal
