// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A WidePlan with what it points to, and the memory that its kernel writes to.

#include "collide/kernels/compiled_plan.h"
#include "collide/kernels/wide_plan.h"
#include "collide/search/packed_tree.h"

#include <cstddef>
#include <cstdint>
#include <vector>

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
