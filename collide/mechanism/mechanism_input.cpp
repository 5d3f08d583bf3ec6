// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/mechanism_input.h"

#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <string>

namespace spherule::internal {
namespace {

constexpr int kLargestIndex = 1 << 20;  // of a variable: there is memory for all up to it

[[noreturn]] void refuse(const std::string& what, std::size_t index, const std::string& why) {
  throw Error("mechanism", what + " " + std::to_string(index) + ' ' + why);
}

bool is_below(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

}  // namespace

void check_frames(std::span<const MechanismFrame> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].parent < -1 || frames[i].parent >= static_cast<int>(i)) {
      refuse("frame", i, "does not come after its parent");
    }
    if (frames[i].variable < 0 || frames[i].variable > kLargestIndex) {
      refuse("frame", i, "has no variable that could be");
    }
  }
}

void check_body(std::size_t body, int frame, std::size_t frame_count, bool has_shape) {
  if (!is_below(frame, frame_count)) refuse("body", body, "is on no frame");
  if (!has_shape) refuse("body", body, "has no shape");
}

void check_obstacles(std::span<const MechanismObstacle> obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].tree) refuse("obstacle", i, "has no tree");
  }
}

void check_pairs(std::span<const MechanismPair> pairs, std::size_t bodies, std::size_t obstacles) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_below(pairs[i].body, bodies) || !is_below(pairs[i].obstacle, obstacles)) {
      refuse("pair", i, "names what is not there");
    }
  }
}

void check_pose_error(double pose_error) {
  if (!(pose_error >= 0.0 && pose_error <= kMaxCoordinate)) {
    throw Error("pose error", "it is negative, not finite or too large");
  }
}

KernelFrame kernel_frame(const MechanismFrame& frame) {
  KernelFrame result = {};
  const Eigen::Matrix3d rotation = frame.parent_from_frame.matrix();
  const Eigen::Vector3d& origin = frame.parent_from_frame.translation();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.rotation[j][i] = rotation(i, j);
    result.origin[i] = origin[i];
  }
  result.parent = frame.parent;
  result.variable = frame.variable;
  result.prismatic = frame.prismatic;
  return result;
}

int variable_count(std::span<const MechanismFrame> frames) {
  int count = 0;
  for (const MechanismFrame& frame : frames) count = std::max(count, frame.variable + 1);
  return count;
}

std::vector<Chain> chains_of(std::span<const MechanismFrame> frames) {
  std::vector<Chain> chains;
  for (const MechanismFrame& frame : frames) {
    Chain chain = frame.parent < 0 ? Chain() : chains[static_cast<std::size_t>(frame.parent)];
    chain.length += frame.parent_from_frame.translation().norm() +
                    (frame.prismatic ? MechanismCheck::kLargestVariable : 0.0);
    chain.frames += 1.0;
    if (chain.frames > kLongestLaneChain) {
      throw Error("mechanism", "too many frames stand on each other");
    }
    chains.push_back(chain);
  }
  return chains;
}

const Kernels& kernels_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("instruction set", "this machine has not got it");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx512) return avx512_kernels();
  if (instructions == InstructionSet::kAvx2) return avx2_kernels();
#endif
  return portable_kernels();
}

}  // namespace spherule::internal
