// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Obstacles as a CheckPlan has them, rounded outward. The proofs are in plan_shapes.cpp.

#include "collide/kernels/check_plan.h"
#include "collide/kernels/check_plan_source.h"
#include "collide/search/single_precision.h"
#include "spheretree/rounding.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

namespace spherule::internal {

template <class Real>
inline constexpr double kRoundoff = kFloatRoundoff;
template <>
inline constexpr double kRoundoff<double> = kUnitRoundoff;

// Not below x.
template <class Real>
Real rounded_up(double x);
template <>
inline float rounded_up<float>(double x) {
  return rounded_up_to_single(x);
}
template <>
inline double rounded_up<double>(double x) {
  return x;
}

// Of a sphere in a plan, with the slack of 16 roundoffs that plan_search.h needs.
template <class Real>
Real inflated_radius(double radius, double inflation);

// How far a finite obstacle reaches from the root's origin; 0 for a half-space.
double reach_of(const PlanSource::Obstacle& obstacle);

// Of a primitive; bodies reach up to `reach`.
template <class Real>
PlanObstacle<Real> compiled_solid(const PlanSource::Obstacle& obstacle, double reach);

// The box of an obstacle in lane 0, for bodies that reach up to `reach`; and no box at all.
template <class Real>
PlanBoxes<Real> compiled_box(const PlanSource::Obstacle& obstacle, double reach);
template <class Real>
PlanBoxes<Real> empty_boxes();

// A sphere outside of which no point of a body ever is.
Sphere reachable(const PlanSource& source, std::size_t body, double reach);

// From the box in lane 0.
double distance_from_box(const Eigen::Vector3d& p, const PlanBoxes<double>& box);

}  // namespace spherule::internal
