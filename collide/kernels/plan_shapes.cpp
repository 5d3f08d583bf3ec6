// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/kernels/compiled_plan.h"
#include "collide/kernels/plan_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Error budget, v being the unit roundoff of Real. A point p with |p| <= W is computed in the frame
// of a solid with the centre c and the sizes h as A (p - c). Rounding c takes v |c|, the difference
// v (W + |c|), the entries of A 2 v (W + |c|), products and sums 7 v (W + |c|). The offset from the
// nearest point: sizes rounded v |h|; clamping and its differences 3 v (W + |c| + |h|); the
// quotient of a cylinder 4 v (W + |c|); along an axis, product and sum, 4 v (W + |c| + |h|); a
// normal or an axis that is off by 2 v turns the nearest point by 2 v |h|. Together less than 24 v
// (W + |c| + |h|); in double the pose itself adds 40 u (W + |c|): 64 covers both. Distances to
// convex sets differ by no more than the points and the sets do.
//
// Boxes are wider by 16 v (W + |corner|): that covers what rounding takes of the boxes around the
// lanes' spheres, whose radii have the errors of centres in them.

namespace spherule::internal {
namespace {

constexpr double kSolidErrors = 64.0;
constexpr double kBoxErrors = 16.0;
constexpr double kAbsolute = 0x1p-60;
constexpr double kEverywhere = 1e30;

struct Half {
  Eigen::Vector3d operator()(const Box& box) const { return 0.5 * box.size; }
  Eigen::Vector3d operator()(const SolidSphere& sphere) const {
    return Eigen::Vector3d::Constant(sphere.radius);
  }
  Eigen::Vector3d operator()(const Cylinder& solid) const {
    return {solid.radius, solid.radius, 0.5 * solid.length};
  }
  Eigen::Vector3d operator()(const Capsule& solid) const {
    return {solid.radius, solid.radius, 0.5 * solid.length + solid.radius};
  }
  Eigen::Vector3d operator()(const HalfSpace&) const { return Eigen::Vector3d::Zero(); }
};

// Shape, half sizes, and what is added to the distance.
struct Kind {
  PlanShape shape;
  Eigen::Vector3d half;
  double radius;
};

struct KindOf {
  Kind operator()(const Box& box) const { return {PlanShape::kBox, 0.5 * box.size, 0.0}; }
  Kind operator()(const SolidSphere& sphere) const {
    return {PlanShape::kSegment, Eigen::Vector3d::Zero(), sphere.radius};
  }
  Kind operator()(const Cylinder& solid) const {
    return {PlanShape::kCylinder, {solid.radius, 0.0, 0.5 * solid.length}, 0.0};
  }
  Kind operator()(const Capsule& solid) const {
    return {PlanShape::kSegment, {0.0, 0.0, 0.5 * solid.length}, solid.radius};
  }
  Kind operator()(const HalfSpace&) const {
    return {PlanShape::kHalfSpace, Eigen::Vector3d::Zero(), 0.0};
  }
};

bool is_half_space(const PlanSource::Obstacle& obstacle) {
  const auto* const primitive = std::get_if<Primitive>(&obstacle.shape);
  return primitive != nullptr && std::holds_alternative<HalfSpace>(*primitive);
}

struct Bounds {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};

// Of a finite obstacle, up to rounding.
Bounds bounds_of(const PlanSource::Obstacle& obstacle) {
  if (const auto* const primitive = std::get_if<Primitive>(&obstacle.shape)) {
    const Eigen::Vector3d extent =
        obstacle.root_from_shape.matrix().cwiseAbs() * std::visit(Half(), *primitive);
    const Eigen::Vector3d& center = obstacle.root_from_shape.translation();
    return {center - extent, center + extent};
  }
  Bounds bounds{Eigen::Vector3d::Constant(kEverywhere), Eigen::Vector3d::Constant(-kEverywhere)};
  const auto& trees = std::get<std::shared_ptr<const SearchTrees>>(obstacle.shape);
  for (const Sphere& sphere : trees->narrow.spheres()) {
    const Eigen::Vector3d center = obstacle.root_from_shape * sphere.center;
    bounds.lower = bounds.lower.cwiseMin((center.array() - sphere.radius).matrix());
    bounds.upper = bounds.upper.cwiseMax((center.array() + sphere.radius).matrix());
  }
  return bounds;
}

}  // namespace

template <class Real>
Real inflated_radius(double radius, double inflation) {
  const double slack = 1.0 + 16.0 * kRoundoff<Real>;
  return rounded_up<Real>(add_up(mul_up(add_up(radius, inflation), slack), kAbsolute));
}

double reach_of(const PlanSource::Obstacle& obstacle) {
  if (is_half_space(obstacle)) return obstacle.root_from_shape.translation().norm();
  const Bounds bounds = bounds_of(obstacle);
  return bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).norm();
}

template <class Real>
PlanObstacle<Real> compiled_solid(const PlanSource::Obstacle& obstacle, double reach) {
  PlanObstacle<Real> result = {};
  const Kind kind = std::visit(KindOf(), std::get<Primitive>(obstacle.shape));
  const Eigen::Matrix3d rotation = obstacle.root_from_shape.matrix().transpose();
  const Eigen::Vector3d& center = obstacle.root_from_shape.translation();
  result.shape = kind.shape;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.rotation[i][j] = static_cast<Real>(rotation(i, j));
    result.center[i] = static_cast<Real>(center[i]);
    result.half[i] = static_cast<Real>(kind.half[i]);
  }
  // A cylinder's radius is divided by: not zero where that underflows.
  result.half[0] = std::max(result.half[0], std::numeric_limits<Real>::min());
  const double error =
      kSolidErrors * kRoundoff<Real> * (reach + center.norm() + kind.half.norm() + kind.radius);
  result.error = rounded_up<Real>(error);
  result.radius = inflated_radius<Real>(kind.radius, 2.0 * error);
  result.margin = rounded_up<Real>(3.0 * sub_up(static_cast<double>(result.radius), kind.radius));
  return result;
}

template <class Real>
PlanBoxes<Real> empty_boxes() {
  PlanBoxes<Real> boxes = {};
  for (int i = 0; i < 3; ++i) {
    std::fill_n(boxes.lower[i], kPlanLanes, static_cast<Real>(kEverywhere));
    std::fill_n(boxes.upper[i], kPlanLanes, static_cast<Real>(-kEverywhere));
  }
  return boxes;
}

template <class Real>
PlanBoxes<Real> compiled_box(const PlanSource::Obstacle& obstacle, double reach) {
  PlanBoxes<Real> boxes = empty_boxes<Real>();
  if (is_half_space(obstacle)) {
    for (int i = 0; i < 3; ++i) std::swap(boxes.lower[i][0], boxes.upper[i][0]);
    return boxes;
  }
  const Bounds bounds = bounds_of(obstacle);
  const double slack = kBoxErrors * kRoundoff<Real> *
                       (reach + bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).sum());
  for (int i = 0; i < 3; ++i) {
    boxes.lower[i][0] = -rounded_up<Real>(-(bounds.lower[i] - slack));
    boxes.upper[i][0] = rounded_up<Real>(bounds.upper[i] + slack);
  }
  return boxes;
}

// The lengths of the chain behind its first joint.
Sphere reachable(const PlanSource& source, std::size_t body, double reach) {
  int frame = source.bodies[body].frame;
  if (frame < 0) return {Eigen::Vector3d::Zero(), reach};
  while (source.frames[static_cast<std::size_t>(frame)].parent >= 0) {
    frame = source.frames[static_cast<std::size_t>(frame)].parent;
  }
  const Eigen::Vector3d& origin =
      source.frames[static_cast<std::size_t>(frame)].parent_from_frame.translation();
  return {origin, std::max(0.0, reach - origin.norm())};
}

double distance_from_box(const Eigen::Vector3d& p, const PlanBoxes<double>& box) {
  double squared = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double outside = std::max({0.0, box.lower[i][0] - p[i], p[i] - box.upper[i][0]});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

template float inflated_radius<float>(double, double);
template double inflated_radius<double>(double, double);
template PlanObstacle<float> compiled_solid<float>(const PlanSource::Obstacle&, double);
template PlanObstacle<double> compiled_solid<double>(const PlanSource::Obstacle&, double);
template PlanBoxes<float> compiled_box<float>(const PlanSource::Obstacle&, double);
template PlanBoxes<double> compiled_box<double>(const PlanSource::Obstacle&, double);
template PlanBoxes<float> empty_boxes<float>();
template PlanBoxes<double> empty_boxes<double>();

template <class Real>
PlanMemory<Real>::PlanMemory(const CompiledPlan<Real>& compiled, const WidePlan* wide,
                             const WideScratch* wide_scratch) {
  const CheckPlan<Real>& plan = compiled.plan();
  const auto positions = static_cast<std::size_t>(std::max(1, plan.position_count));
  positions_.resize(positions);
  poses_.resize(static_cast<std::size_t>(plan.frame_count));
  twists_.resize(poses_.size());
  centers_.resize(compiled.center_count());
  placed_.resize(centers_.size());
  candidates_.resize(static_cast<std::size_t>(plan.test_count));
  tasks_.resize(compiled.task_count());
  from_.resize(positions);
  to_.resize(positions);
  rates_.resize(positions);
  speeds_.resize(positions + 1);
  shifts_.resize(positions + 1);
  body_bounds_.resize(static_cast<std::size_t>(plan.body_count));
  pair_bounds_.resize(static_cast<std::size_t>(plan.pair_count));
  has_bounds_ = std::make_unique<bool[]>(static_cast<std::size_t>(plan.bound_count));
  path_work_.resize(2 * compiled.longest_path() + 4);
  view_ = {positions_.data(),   poses_.data(),
           twists_.data(),      centers_.data(),
           placed_.data(),      &evaluation_,
           candidates_.data(),  tasks_.data(),
           from_.data(),        to_.data(),
           rates_.data(),       speeds_.data(),
           shifts_.data(),      body_bounds_.data(),
           pair_bounds_.data(), path_work_.data(),
           &total_speed_,       &recent_,
           has_bounds_.get(),   wide,
           wide_scratch};
}

template class PlanMemory<float>;
template class PlanMemory<double>;

const PlanKernelSet& plan_kernels_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("instruction set", "this machine has not got it");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx512) return avx512_plan_kernels();
  if (instructions == InstructionSet::kAvx2) return avx2_plan_kernels();
#endif
  return portable_plan_kernels();
}

}  // namespace spherule::internal
