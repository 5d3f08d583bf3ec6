// SPDX-License-Identifier: BSD-3-Clause
#include "collide/within.h"

#include "collide/internal/box_gap.h"
#include "collide/internal/traversal.h"
#include "spheretree/error.h"

namespace spherule {
namespace {

// Ends at the first pair that comes within the clearance.
class FindNear {
 public:
  static constexpr bool kWantsGaps = false;

  FindNear(const SphereTree& a, const SphereTree& b, const RelativePose& pose, double clearance)
      : a_(a), b_(b), pose_(pose), clearance_(clearance) {}

  bool afford(const OpenedPair&, const auto&) const noexcept { return true; }
  double margin(NodePair) const noexcept { return clearance_; }
  bool nearest_first() const noexcept { return false; }
  bool leaves(NodePair pair) noexcept {
    found_ = pose_.touches(a_.ball(pair.index(0)), b_.ball(pair.index(1)), clearance_);
    return !found_;
  }
  bool found() const { return found_; }

 private:
  const SphereTree& a_;
  const SphereTree& b_;
  const RelativePose& pose_;
  const double clearance_;
  bool found_ = false;
};

}  // namespace

void require_clearance(double clearance) {
  if (!(clearance >= 0.0 && clearance <= kMaxCoordinate)) {
    throw Error("clearance", "it is not a number from 0 to 1e15");
  }
}

bool within(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  if (internal::far_apart(a, world_from_a, b, world_from_b, clearance)) return false;
  const RelativePose pose(a, world_from_a, b, world_from_b);
  if (internal::boxes_apart(a, b, pose, clearance)) return false;
  FindNear query(a, b, pose, clearance);
  traverse(a, b, pose, query);
  return query.found();
}

bool spheres_within(const SphereTree& a, std::int32_t sphere_a, const Pose& world_from_a,
                    const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b,
                    double clearance) {
  require_clearance(clearance);
  return RelativePose(a, world_from_a, b, world_from_b)
      .touches(a.spheres()[static_cast<std::size_t>(sphere_a)],
               b.spheres()[static_cast<std::size_t>(sphere_b)], clearance);
}

double within_slack(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                    const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return RelativePose(a, world_from_a, b, world_from_b).slack(clearance);
}

}  // namespace spherule
