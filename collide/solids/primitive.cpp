// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/primitive.h"

#include "base/error.h"
#include "collide/search/deadline.h"
#include "collide/search/nearest_first.h"
#include "collide/search/queries.h"
#include "collide/search/query.h"
#include "collide/search/traversal.h"
#include "collide/solids/solid_pose.h"

#include <algorithm>

namespace spherule {
namespace {

using internal::SolidPose;

// Calls what() with the field of the solid.
template <class What>
auto with_field(const Primitive& solid, const What& what) {
  return std::visit([&](const auto& shape) { return what(internal::field_of(shape)); }, solid);
}

// Ends at the first sphere that touches.
template <class Field>
class FindSphere {
 public:
  FindSphere(const SphereTree& tree, const SolidPose<Field>& pose) : tree_(tree), pose_(pose) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    return pose_.may_touch(tree_.sphere(static_cast<std::size_t>(node)));
  }
  bool leaf(std::int32_t node) {
    found_ = pose_.touches(tree_.sphere(static_cast<std::size_t>(node)));
    return !found_;
  }
  bool found() const { return found_; }

 private:
  const SphereTree& tree_;
  const SolidPose<Field>& pose_;
  bool found_ = false;
};

// Collects the spheres that touch, up to the limits of a request, and the smallest gap seen.
template <class Field>
class CollectSpheres {
 public:
  CollectSpheres(const SphereTree& tree, const SolidPose<Field>& pose,
                 const CollisionRequest& request, CollisionResult& result)
      : tree_(tree), pose_(pose), request_(request), deadline_(request.max_time), result_(result) {}

  bool afford(std::int32_t first, std::int32_t count) {
    const auto tests = static_cast<std::uint64_t>(count);
    if (tests > request_.max_node_tests - result_.cost.node_tests) return false;
    if (deadline_.passed(result_.cost.node_tests)) return false;
    result_.cost.node_tests += tests;
    for (std::int32_t node = first; node < first + count; ++node) {
      result_.cost.leaf_tests += tree_.is_leaf(static_cast<std::size_t>(node)) ? 1u : 0u;
    }
    return true;
  }
  bool enters(std::int32_t node) {
    const Sphere sphere = tree_.sphere(static_cast<std::size_t>(node));
    if (pose_.may_touch(sphere)) return true;
    smallest_gap_ = std::min(smallest_gap_, pose_.gap(sphere));
    return false;
  }
  bool leaf(std::int32_t node) {
    const Sphere sphere = tree_.sphere(static_cast<std::size_t>(node));
    if (!pose_.touches(sphere)) {
      smallest_gap_ = std::min(smallest_gap_, pose_.gap(sphere));
      return true;
    }
    found_ = true;
    if (result_.pairs.size() < request_.max_pairs) {
      result_.pairs.push_back({tree_.sphere_index(static_cast<std::size_t>(node)), 0});
    }
    return result_.pairs.size() < request_.max_pairs;
  }
  bool found() const { return found_; }
  double smallest_gap() const { return smallest_gap_; }

 private:
  const SphereTree& tree_;
  const SolidPose<Field>& pose_;
  const CollisionRequest& request_;
  internal::Deadline deadline_;
  CollisionResult& result_;
  bool found_ = false;
  double smallest_gap_ = std::numeric_limits<double>::infinity();
};

// What SphereSpace requires.
template <class Field>
class SphereGaps {
 public:
  SphereGaps(const SphereTree& tree, const SolidPose<Field>& pose) : tree_(tree), pose_(pose) {}

  double gap(const Sphere& sphere) const { return pose_.gap(sphere); }
  internal::GapInterval leaf_gap(std::int32_t sphere) const {
    const double gap = pose_.gap(tree_.spheres()[static_cast<std::size_t>(sphere)]);
    return {gap, gap};
  }

 private:
  const SphereTree& tree_;
  const SolidPose<Field>& pose_;
};

bool comes_within(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                  const Pose& world_from_solid, double clearance) noexcept {
  return with_field(solid, [&](const auto& field) {
    const SolidPose pose(tree, world_from_tree, field, world_from_solid, clearance);
    FindSphere query(tree, pose);
    internal::search_tree(tree, query);
    return query.found();
  });
}

class RequireSizes {
 public:
  explicit RequireSizes(const std::string& subject) : subject_(subject) {}

  void operator()(const Box& box) const {
    for (int i = 0; i < 3; ++i) require(box.size[i], "a size of the box");
  }
  void operator()(const SolidSphere& sphere) const {
    require(sphere.radius, "the radius of the sphere");
  }
  void operator()(const Cylinder& cylinder) const {
    require(cylinder.radius, "the radius of the cylinder");
    require(cylinder.length, "the length of the cylinder");
  }
  void operator()(const Capsule& capsule) const {
    require(capsule.radius, "the radius of the capsule");
    if (capsule.length != 0.0) require(capsule.length, "the length of the capsule");
  }
  void operator()(const HalfSpace&) const {}

 private:
  void require(double size, const char* what) const {
    if (!(size > 0.0 && size <= kMaxCoordinate)) {
      throw Error(subject_, std::string(what) + " is not a number above 0 and up to 1e15");
    }
  }

  const std::string& subject_;
};

}  // namespace

void require_primitive(const Primitive& primitive, const std::string& subject) {
  std::visit(RequireSizes(subject), primitive);
}

bool collides(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
              const Pose& world_from_solid) noexcept {
  return comes_within(tree, world_from_tree, solid, world_from_solid, 0.0);
}

bool within(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
            const Pose& world_from_solid, double clearance) {
  require_clearance(clearance);
  return comes_within(tree, world_from_tree, solid, world_from_solid, clearance);
}

CollisionResult collide(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                        const Pose& world_from_solid, const CollisionRequest& request) {
  return with_field(solid, [&](const auto& field) {
    const SolidPose pose(tree, world_from_tree, field, world_from_solid);
    CollisionResult result;
    CollectSpheres query(tree, pose, request, result);
    result.complete = internal::search_tree(tree, query);
    internal::conclude(query, pose, result);
    return result;
  });
}

DistanceResult distance(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                        const Pose& world_from_solid, const DistanceRequest& request) {
  return with_field(solid, [&](const auto& field) {
    const SolidPose pose(tree, world_from_tree, field, world_from_solid);
    const SphereGaps gaps(tree, pose);
    const internal::SphereSpace space(tree, gaps);
    return internal::NearestFirst(space, pose.gap_error(), request).run(0, space.gap(0));
  });
}

double primitive_slack(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                       const Pose& world_from_solid, double clearance) {
  require_clearance(clearance);
  return with_field(solid, [&](const auto& field) {
    return SolidPose(tree, world_from_tree, field, world_from_solid).slack(clearance);
  });
}

}  // namespace spherule
