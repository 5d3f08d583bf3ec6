// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A CheckPlan with what it points to, and the memory that its kernels write to.

#include "collide/kernels/check_plan.h"
#include "collide/kernels/check_plan_source.h"

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
