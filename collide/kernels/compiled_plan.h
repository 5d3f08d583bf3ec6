// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A CheckPlan with what it points to, and the memory that its kernels write to.

#include "base/rounding.h"
#include "collide/kernels/check_plan.h"
#include "collide/kernels/check_plan_source.h"
#include "collide/search/packed_tree.h"
#include "geometry/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace spherule::internal {

template <class Real>
class CompiledPlan {
 public:
  // Throws Error for what reaches beyond kMaxCoordinate, and as chains_of() does.
  explicit CompiledPlan(const PlanSource& source);
  CompiledPlan(const CompiledPlan&) = delete;
  CompiledPlan& operator=(const CompiledPlan&) = delete;

  const CheckPlan<Real>& plan() const { return plan_; }
  // The test of the source that a test of the plan is; -1 for places that are not used.
  std::int32_t source_test(std::int32_t test) const {
    return source_tests_[static_cast<std::size_t>(test)];
  }
  // What the radii of a body's spheres are inflated by.
  double inflation(std::size_t body) const { return inflations_[body]; }
  // The same of an obstacle that is a tree.
  double obstacle_inflation(std::size_t obstacle) const { return obstacle_inflations_[obstacle]; }
  // By how much placed centres of any body are off, at most.
  double center_error() const { return center_error_; }
  std::size_t center_count() const { return center_count_; }
  std::size_t task_count() const { return task_count_; }
  std::size_t longest_path() const { return longest_path_; }

 private:
  struct Reach;
  void compile_frames(const PlanSource& source);
  void compile_bodies(const PlanSource& source, const Reach& reach);
  void compile_obstacles(const PlanSource& source, const Reach& reach);
  void compile_tests(const PlanSource& source, const Reach& reach);
  void compile_pairs(const PlanSource& source);
  void compile_paths(const std::vector<PlanSource::Path>& paths,
                     std::vector<PlanPathGroup>& groups);
  std::int32_t add_tree(const SearchTrees& trees, const Pose& pose, double inflation,
                        double& largest);

  CheckPlan<Real> plan_{};
  std::vector<PlanFrame<Real>> frames_{};
  std::vector<PlanNode<Real>> nodes_{};
  std::vector<double> inflations_{};
  std::vector<double> obstacle_inflations_{};
  std::vector<PlanBody<Real>> bodies_{};
  std::vector<PlanObstacle<Real>> obstacles_{};
  std::vector<PlanBoxes<Real>> obstacle_boxes_{};  // the box of each in lane 0
  std::vector<PlanBoxes<Real>> groups_{};
  std::vector<PlanPair> pairs_{};
  std::vector<std::shared_ptr<const FreeCells>> free_cells_{};
  std::vector<PlanFreeCells> pair_cells_{};
  std::vector<PlanPathGroup> body_paths_{};
  std::vector<PlanPathGroup> pair_paths_{};
  std::vector<PlanPathStep<Real>> steps_{};
  std::vector<std::int32_t> source_tests_{};
  double center_error_ = 0.0;
  std::size_t center_count_ = 0;
  std::size_t height_ = 0;  // of the highest tree
  std::size_t task_count_ = 1;
  std::size_t longest_path_ = 0;
};

extern template class CompiledPlan<float>;
extern template class CompiledPlan<double>;

// Memory of one caller.
template <class Real>
class PlanMemory {
 public:
  // `wide` is of the same plan, or null.
  explicit PlanMemory(const CompiledPlan<Real>& plan, const WidePlan* wide = nullptr,
                      const WideScratch* wide_scratch = nullptr);
  PlanMemory(const PlanMemory&) = delete;
  PlanMemory& operator=(const PlanMemory&) = delete;

  const PlanScratch<Real>& view() const { return view_; }

 private:
  std::vector<PlanNumbers<double>> positions_;
  std::vector<PlanPose<Real>> poses_;
  std::vector<PlanTwist<Real>> twists_;
  std::vector<PlanCenter<Real>> centers_;
  std::vector<std::uint64_t> placed_;
  std::uint64_t evaluation_ = 0;
  std::vector<PlanCandidate> candidates_;
  std::vector<PlanTask> tasks_;
  std::vector<double> from_;
  std::vector<double> to_;
  std::vector<Real> rates_;
  std::vector<Real> speeds_;
  std::vector<Real> shifts_;
  std::vector<PlanMotionBound<Real>> body_bounds_;
  std::vector<PlanMotionBound<Real>> pair_bounds_;
  std::vector<PlanNumbers<Real>> path_work_;
  Real total_speed_ = 0;
  PlanRecent recent_{};
  std::unique_ptr<bool[]> has_bounds_;
  PlanScratch<Real> view_{};
};

extern template class PlanMemory<float>;
extern template class PlanMemory<double>;

}  // namespace spherule::internal

// A WidePlan with what it points to, and the memory that its kernel writes to.

namespace spherule::internal {

class CompiledWidePlan {
 public:
  // `compiled` is of the same source.
  CompiledWidePlan(const PlanSource& source, const CompiledPlan<float>& compiled);
  CompiledWidePlan(const CompiledWidePlan&) = delete;
  CompiledWidePlan& operator=(const CompiledWidePlan&) = delete;

  const WidePlan& plan() const { return plan_; }
  std::size_t task_count() const { return task_count_; }

 private:
  void add_body(const SearchTrees& trees, const Pose& pose, double inflation, bool is_confirmed,
                std::int32_t frame);
  void compile_partners(const CheckPlan<float>& plan, std::size_t bodies);

  WidePlan plan_{};
  std::vector<WideFrame> frames_{};
  std::vector<PackedTree> trees_{};
  std::vector<WideBody> bodies_{};
  std::vector<std::int32_t> tree_of_{};
  std::vector<WidePartners> partners_{};
  std::vector<std::int32_t> pair_tests_{};
  std::size_t placed_count_ = 0;
  int depth_ = 1;  // of the highest tree
  std::size_t task_count_ = 0;
};

class WideMemory {
 public:
  WideMemory(const CheckPlan<float>& plan, const CompiledWidePlan& wide);
  WideMemory(const WideMemory&) = delete;
  WideMemory& operator=(const WideMemory&) = delete;

  const WideScratch& view() const { return view_; }

 private:
  std::vector<double> positions_;
  std::vector<float> sines_;
  std::vector<float> cosines_;
  std::vector<WidePose> poses_;
  std::vector<float> roots_[3];
  std::vector<float> radii_;
  std::vector<WideSpheres> placed_;
  std::vector<std::uint64_t> stamps_;
  std::uint64_t evaluation_ = 0;
  std::vector<WideTask> tasks_;
  PlanRecent recent_{};
  WideScratch view_{};
};

}  // namespace spherule::internal

// Obstacles as a CheckPlan has them, rounded outward. The proofs are in plan_shapes.cpp.

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
