// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism_check.h"

#include "collide/mechanism/mechanism_parts.h"
#include "spheretree/error.h"
#include "spheretree/rounding_mode.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace spherule {
namespace {

int filled_up(int count) {
  return (count + 3) / 4 * 4;
}

}  // namespace

MechanismCheck::~MechanismCheck() = default;
MechanismCheck::MechanismCheck(const MechanismCheck&) noexcept = default;
MechanismCheck& MechanismCheck::operator=(const MechanismCheck&) noexcept = default;

MechanismCheck::Scratch::Scratch(const MechanismCheck& check)
    : memory_(std::make_unique<Memory>()) {
  require_rounding_to_nearest();
  const Parts& parts = *check.parts_;
  memory_->owner = check.parts_;
  const auto variables = static_cast<std::size_t>(filled_up(parts.problem.variable_count));
  memory_->middle.resize(variables);
  memory_->sines.resize(variables);
  memory_->cosines.resize(variables);
  memory_->poses.resize(parts.frames.size());
  memory_->roots.resize(parts.bodies.size());
  memory_->tasks.resize(static_cast<std::size_t>(parts.task_count));
  memory_->lane_variables.resize(variables);
  memory_->lane_poses.resize(parts.frames.size());
  std::size_t nodes = 0;
  for (const internal::KernelBody& body : parts.bodies) {
    nodes = std::max(nodes, static_cast<std::size_t>(body.node_count));
  }
  memory_->queues.resize(5);
  memory_->placed.resize(nodes + 1);
  memory_->generations.resize(nodes + 1);
  memory_->memories.resize(parts.scene.pairs.size());
  memory_->view = {.sines = memory_->sines.data(),
                   .cosines = memory_->cosines.data(),
                   .poses = memory_->poses.data(),
                   .roots = memory_->roots.data(),
                   .tasks = memory_->tasks.data(),
                   .lane_variables = memory_->lane_variables.data(),
                   .lane_poses = memory_->lane_poses.data(),
                   .queues = {memory_->queues.data(), memory_->placed.data(),
                              memory_->generations.data(), &memory_->generation},
                   .memories = memory_->memories.data()};
  memory_->motion.emplace(parts.problem, parts.reach, parts.tilt);
}

MechanismCheck::Scratch::~Scratch() = default;
MechanismCheck::Scratch::Scratch(Scratch&&) noexcept = default;
MechanismCheck::Scratch& MechanismCheck::Scratch::operator=(Scratch&&) noexcept = default;

void MechanismCheck::require_own(const Scratch& scratch) const {
  if (!scratch.memory_ || scratch.memory_->owner != parts_) {
    throw Error("scratch", "it was made for another check");
  }
}

bool MechanismCheck::is_in_range(std::span<const double> variables) {
  return std::all_of(variables.begin(), variables.end(),
                     [](double v) { return std::abs(v) <= MechanismCheck::kLargestVariable; });
}

bool MechanismCheck::collides(std::span<const double> variables, Scratch& scratch,
                              ConfirmFunction confirm_function, void* context) const {
  assert(is_in_range(variables));
  assert(variables.size() >= static_cast<std::size_t>(parts_->problem.variable_count));
  require_own(scratch);
  Translator translator{parts_->scene, confirm_function, context};
  Scratch::Memory& memory = *scratch.memory_;
  return memory.motion->collides(*parts_->kernels, parts_->problem, variables.data(), memory.view,
                                 &Translator::confirm, &translator);
}

std::optional<bool> MechanismCheck::is_free_along(std::span<const double> from,
                                                  std::span<const double> to,
                                                  Scratch& scratch) const {
  assert(is_in_range(from) && is_in_range(to));
  require_own(scratch);
  Scratch::Memory& memory = *scratch.memory_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(parts_->problem.variable_count); ++i) {
    memory.middle[i] = 0.5 * from[i] + 0.5 * to[i];
  }
  return memory.motion->is_free_along(*parts_->kernels, parts_->problem, from.data(), to.data(),
                                      memory.middle.data(), memory.view);
}

bool MechanismCheck::is_following(const Scratch& scratch) const {
  require_own(scratch);
  return scratch.memory_->motion->is_following();
}

void MechanismCheck::remember_contact(int frame, const Sphere& sphere, double depth,
                                      Scratch& scratch) const {
  require_own(scratch);
  scratch.memory_->motion->remember_contact(frame, sphere, depth, scratch.memory_->view);
}

MechanismCheck::BlockAnswer MechanismCheck::collides(
    std::span<const double* const, kBlock> configurations, Scratch& scratch,
    ConfirmFunction confirm_function, void* context) const {
  static_assert(kBlock == internal::kLanes && kLargestVariable == internal::kLargestKernelVariable);
  require_own(scratch);
  Translator translator{parts_->scene, confirm_function, context};
  const auto [hits, refused] =
      parts_->kernels->check_block(parts_->problem, configurations.data(), scratch.memory_->view,
                                   &Translator::confirm, &translator);
  return {hits, refused};
}

}  // namespace spherule
