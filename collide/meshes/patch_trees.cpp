// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/patch_trees.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/search/box_gap.h"
#include "collide/search/packed_tree.h"
#include "geometry/point_triangle.h"
#include "geometry/triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

bool possibly_meet(const Sphere& sphere, const Triangle& t) {
  return point_triangle_distance(sphere.center, t[0], t[1], t[2]).lower <= sphere.radius;
}

void collect_triangles(const MeshTree& mesh, const Sphere& sphere, std::size_t node,
                       std::vector<std::int32_t>& found) {
  const SphereTree& tree = mesh.tree();
  if (!possibly_overlap(tree.sphere(node), sphere)) return;
  if (tree.is_leaf(node)) {
    const std::int32_t index = tree.sphere_index(node);
    if (possibly_meet(sphere, mesh.triangle(index))) found.push_back(index);
    return;
  }
  for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
    collect_triangles(mesh, sphere, static_cast<std::size_t>(tree.first_child(node) + i), found);
  }
}

// Of every triangle: the spheres that meet it, and perhaps some that miss it by rounding.
std::vector<std::vector<std::int32_t>> spheres_meeting(const MeshTree& mesh,
                                                       std::span<const Sphere> spheres) {
  std::vector<std::vector<std::int32_t>> result(mesh.tree().spheres().size());
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    found.clear();
    collect_triangles(mesh, spheres[i], 0, found);
    for (const std::int32_t triangle : found) {
      result[static_cast<std::size_t>(triangle)].push_back(static_cast<std::int32_t>(i));
    }
  }
  return result;
}

// Shares out one triangle at a time.
class Sharing {
 public:
  Sharing(std::span<const Sphere> spheres, double error) : spheres_(spheres), error_(error) {}

  // False if no proof was found. Appends to `patches`.
  bool share(const Triangle& triangle, std::int32_t index, std::span<const std::int32_t> candidates,
             std::vector<Patch>& patches) {
    candidates_.assign(candidates.begin(), candidates.end());
    pieces_left_ = kPieces * (candidates.size() + 1);
    boxes_.clear();
    if (!share(triangle, 0, 0, 0.0)) return false;
    for (auto& [sphere, box] : boxes_) {
      box.min().array() -= 2.0 * error_;
      box.max().array() += 2.0 * error_;
      patches.push_back({sphere, index, box});
    }
    return true;
  }

  // Of the piece that was not proved to be covered.
  const Vector3d& open_point() const { return open_point_; }

 private:
  // Pieces for each sphere that intersects the triangle, and halvings of one piece: see
  // share_out().
  static constexpr std::size_t kPieces = 4096;
  static constexpr int kDepth = 80;

  // Whether the spheres cover the piece, whose corners may be off by `error`; those that may
  // intersect it are candidates_ from `first` on.
  bool share(const Triangle& piece, std::size_t first, int depth, double error) {
    const std::size_t end = candidates_.size();
    const std::int32_t owner = smallest_sphere_around(piece, first, error);
    if (owner >= 0) {
      auto& box = boxes_[owner];
      for (const Vector3d& corner : piece) box.extend(corner);
      return true;
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
        Sphere sphere = spheres_[static_cast<std::size_t>(candidates_[i])];
        sphere.radius = add_up(sphere.radius, error_);
        if (possibly_meet(sphere, half)) candidates_.push_back(candidates_[i]);
      }
      const bool covered = share(half, end, depth + 1, error_);
      candidates_.resize(end);
      if (!covered) return false;
    }
    return true;
  }

  // -1 if there is none.
  std::int32_t smallest_sphere_around(const Triangle& piece, std::size_t first,
                                      double error) const {
    std::int32_t smallest = -1;
    double radius = std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < candidates_.size(); ++i) {
      const Sphere& sphere = spheres_[static_cast<std::size_t>(candidates_[i])];
      const auto contains = [&](const Vector3d& p) { return certainly_contains(sphere, p, error); };
      if (sphere.radius < radius && contains(piece[0]) && contains(piece[1]) &&
          contains(piece[2])) {
        smallest = candidates_[i];
        radius = sphere.radius;
      }
    }
    return smallest;
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

  std::span<const Sphere> spheres_;
  double error_;
  std::vector<std::int32_t> candidates_;
  std::map<std::int32_t, Eigen::AlignedBox3d> boxes_;  // of the pieces that each sphere got
  std::size_t pieces_left_ = 0;
  Vector3d open_point_ = Vector3d::Zero();
};

}  // namespace

std::vector<Patch> share_out(const MeshTree& mesh, std::span<const Sphere> spheres) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  // A midpoint is off by at most 2 u times the largest coordinate, and the midpoint of points that
  // are off by some amount by no more than that and one rounding: less than 2 * 80 u.
  const double error = 256.0 * kUnitRoundoff * mesh.tree().reach();
  const std::vector<std::vector<std::int32_t>> candidates = spheres_meeting(mesh, spheres);
  std::vector<Patch> patches;
  Sharing sharing(spheres, error);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    if (!sharing.share(mesh.triangle(index), index, candidates[i], patches)) {
      std::ostringstream text;
      text << "its spheres do not cover triangle " << i << " of the mesh, near ("
           << sharing.open_point().transpose() << ")";
      throw Error("cover", text.str());
    }
    if (patches.size() > kMost) throw Error("cover", "it cuts the mesh into more than 2^30 parts");
  }
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.sphere < b.sphere; });
  return patches;
}

namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

const Box& box_of_patch(const Patch& patch) {
  return patch.box;
}

PatchBox seen_from(const Vector3d& origin, const Box& box) {
  PatchBox result{};
  for (int k = 0; k < 3; ++k) {
    const double low = sub_down(box.min()[k], origin[k]);
    const double high = sub_up(box.max()[k], origin[k]);
    const double center = in_single_precision(low + (high - low) / 2.0);
    const double half = std::max(0.0, std::max(sub_up(high, center), sub_up(center, low)));
    result.center[k] = static_cast<float>(center);
    result.half[k] = rounded_up_to_single(half);
  }
  return result;
}

// Halves the patches across the longest side of their box.
std::pair<std::span<Patch>, std::span<Patch>> halves(std::span<Patch> patches) {
  sort_along_longest_side(patches, box_of_patch, [](const Patch& patch) { return patch.triangle; });
  const std::size_t middle = (patches.size() + 1) / 2;
  return {patches.first(middle), patches.subspan(middle)};
}

// The parts that the boxes of a node get: single patches, or eighths.
std::vector<std::span<Patch>> parts_of(std::span<Patch> patches) {
  std::vector<std::span<Patch>> parts = {patches};
  for (std::size_t count = 1; count < PatchNode::kWidth; count *= 2) {
    std::vector<std::span<Patch>> finer;
    for (const std::span<Patch> part : parts) {
      if (part.size() < 2) {
        finer.push_back(part);
        continue;
      }
      const auto [low, high] = halves(part);
      finer.insert(finer.end(), {low, high});
    }
    parts = std::move(finer);
  }
  return parts;
}

// Appends a node and all below it; returns its index.
std::int32_t build(std::span<Patch> patches, const Vector3d& origin,
                   std::vector<PatchNode>& nodes) {
  const std::size_t at = nodes.size();
  nodes.emplace_back();
  const std::vector<std::span<Patch>> parts = parts_of(patches);
  for (std::size_t i = 0; i < PatchNode::kWidth; ++i) {
    PatchBox box{{0.0F, 0.0F, 0.0F}, {}};
    std::fill_n(box.half, 3, -std::numeric_limits<float>::infinity());
    std::int32_t child = -1;
    if (i < parts.size()) {
      box = seen_from(origin, box_around(parts[i], box_of_patch));
      child = parts[i].size() == 1 ? ~parts[i][0].triangle : build(parts[i], origin, nodes);
    }
    PatchNode& node = nodes[at];
    for (std::size_t k = 0; k < 3; ++k) {
      node.center[k][i] = box.center[k];
      node.half[k][i] = box.half[k];
    }
    node.child[i] = child;
  }
  return static_cast<std::int32_t>(at);
}

}  // namespace

PatchTrees::PatchTrees(std::span<const Patch> patches, std::span<const Sphere> spheres)
    : roots_(spheres.size()) {
  std::vector<Patch> of_sphere;
  while (!patches.empty()) {
    const auto sphere = static_cast<std::size_t>(patches[0].sphere);
    std::size_t count = 0;
    while (count < patches.size() && patches[count].sphere == patches[0].sphere) ++count;
    of_sphere.assign(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(count));
    patches = patches.subspan(count);
    const Vector3d& origin = spheres[sphere].center;
    roots_[sphere] = {seen_from(origin, box_around(std::span(of_sphere), box_of_patch)),
                      build(of_sphere, origin, nodes_)};
  }
}

}  // namespace spherule::internal
