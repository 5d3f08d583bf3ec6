// SPDX-License-Identifier: BSD-3-Clause
#include "collide/contact.h"

#include "collide/meshes/listed_triangles.h"
#include "collide/search/nearest_first.h"
#include "collide/search/traversal.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace spherule {
namespace {

// Two spheres and the distance of their surfaces, as the canonical test computes it.
struct Touching {
  SpherePair spheres;
  double gap = 0.0;
};

// The pairs of spheres that touch, deepest first and of equal ones the first by index: best-first
// search over the node pairs of TreePair. Two nodes wait under a bound of what the gaps of leaves
// below them are computed to be: their own gap errs by gap_error(), that of leaves by less.
class DeepestFirst {
 public:
  DeepestFirst(const SphereTree& a, const SphereTree& b, const internal::RelativePose& pose)
      : a_(a), b_(b), pose_(pose), trees_(a, b, pose), leaves_(a, b, pose) {
    wait(internal::NodePair(0, 0), pose.gap(a.sphere(0), b.sphere(0)));
  }

  std::optional<Touching> next() {
    while (!queue_.empty()) {
      const Waiting first = queue_.top();
      queue_.pop();
      if (first.is_leaf) return Touching{{first.a, first.b}, first.gap};
      open(internal::NodePair(first.a, first.b));
    }
    return std::nullopt;
  }

 private:
  // Two spheres or two nodes.
  struct Waiting {
    double gap;
    bool is_leaf;
    std::int32_t a, b;
    // The queue serves its greatest element: nodes before spheres, since those of an equal gap may
    // be below them.
    bool operator<(const Waiting& other) const {
      return std::tie(gap, is_leaf, a, b) > std::tie(other.gap, other.is_leaf, other.a, other.b);
    }
  };

  void open(internal::NodePair pair) {
    const internal::OpenedPair opened = trees_.open(pair);
    double gaps[SphereTree::kMaxBranching];
    internal::sphere_gaps(trees_.spheres(opened.side), opened.first, opened.count, opened.sphere,
                          gaps);
    for (std::int32_t i = 0; i < opened.count; ++i) {
      wait(pair.with(opened.side, opened.first + i), gaps[i]);
    }
  }

  // `gap` is only examined for pairs that are not leaves. None that touch are above the node pad.
  void wait(internal::NodePair pair, double gap) {
    if (trees_.is_leaf_pair(pair)) {
      if (!leaves_.touches(pair)) return;
      queue_.push({leaves_.gap(pair), true, a_.sphere_index(pair.index(0)),
                   b_.sphere_index(pair.index(1))});
    } else if (gap <= pose_.node_pad()) {
      queue_.push({gap - 2.0 * pose_.gap_error(), false, pair.node(0), pair.node(1)});
    }
  }

  const SphereTree& a_;
  const SphereTree& b_;
  const internal::RelativePose& pose_;
  const internal::TreePair trees_;
  const internal::SphereLeaves leaves_;
  std::priority_queue<Waiting> queue_;
};

// The gap of two spheres errs by less than leaf_pad() = 76 u S: the offset of the centres, 67.2 u S
// (relative_pose.h), half the relative error of its square and the root, 2.5 u S, the sum of the
// radii and the difference, 2 u S; the subtraction below, u S. A pair that touches has a computed
// gap of at most 80 u S, hence an overlap of at least -157 u S.
Contact contact_of(ContactKind kind, const Touching& touching, const SphereTree& a,
                   const Pose& world_from_a, const SphereTree& b, const Pose& world_from_b,
                   const internal::RelativePose& pose) {
  const auto sphere = [](const SphereTree& tree, std::int32_t index) {
    return tree.spheres()[static_cast<std::size_t>(index)];
  };
  const Sphere of_a = sphere(a, touching.spheres.a), of_b = sphere(b, touching.spheres.b);
  const Eigen::Vector3d center_a = world_from_a * of_a.center,
                        center_b = world_from_b * of_b.center;
  const Eigen::Vector3d way = center_b - center_a;
  const double distance = way.norm();
  const Eigen::Vector3d normal =
      distance > 0.0 ? Eigen::Vector3d(way / distance) : Eigen::Vector3d::UnitX();
  // Where on the way the two spheres begin and end.
  const double begin = std::max(-of_a.radius, distance - of_b.radius);
  const double end = std::min(of_a.radius, distance + of_b.radius);
  return {.kind = kind,
          .leaves = touching.spheres,
          .penetration_depth = -touching.gap - pose.leaf_pad(),
          .normal = normal,
          .nearest_points = {center_a + of_a.radius * normal, center_b - of_b.radius * normal},
          .position = center_a + 0.5 * (begin + end) * normal,
          .triangles = std::nullopt};
}

}  // namespace

std::optional<Contact> deepest_contact(const SphereTree& a, const Pose& world_from_a,
                                       const SphereTree& b, const Pose& world_from_b) {
  const internal::RelativePose pose(a, world_from_a, b, world_from_b);
  const std::optional<Touching> deepest = DeepestFirst(a, b, pose).next();
  if (!deepest) return std::nullopt;
  return contact_of(ContactKind::kLeaves, *deepest, a, world_from_a, b, world_from_b, pose);
}

std::optional<Contact> deepest_contact(const CoveredMesh& a, const Pose& world_from_a,
                                       const CoveredMesh& b, const Pose& world_from_b) {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  DeepestFirst search(a.cover(), b.cover(), pose);
  const std::optional<Touching> deepest = search.next();
  if (!deepest) return std::nullopt;
  const auto contact = [&](ContactKind kind, const Touching& touching) {
    return contact_of(kind, touching, a.cover(), world_from_a, b.cover(), world_from_b, pose);
  };
  const internal::ListedTriangles triangles(a, world_from_a, b, world_from_b, pose);
  for (std::optional<Touching> touching = deepest; touching; touching = search.next()) {
    const std::optional<TrianglePair> found =
        triangles.touching(touching->spheres.a, touching->spheres.b);
    if (!found) continue;
    Contact result = contact(ContactKind::kTriangles, *touching);
    result.triangles = found;
    return result;
  }
  if (!triangles.contained()) return std::nullopt;
  return contact(ContactKind::kInside, *deepest);
}

}  // namespace spherule
