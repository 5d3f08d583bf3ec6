// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How often do a robot's spheres refuse postures that are free by its meshes?

#include "base/progress.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {

// Which proofs about pairs of links spare a test of their spheres.
enum class PairProofs : std::uint8_t {
  kNone,   // none
  kNever,  // pairs proved never to touch are not tested: what an SRDF or a list of pairs can say
  kBoxes,  // pairs are not tested in configurations that are proved free, LinkPairs::is_free()
};

// For people: what stands in tables, and what options of the command take.
std::string_view name_of(PairProofs proofs);

// How false alarms are counted.
struct FalseAlarmOptions {
  std::size_t postures = 20000;  // drawn evenly between the joint limits, as sample_collisions()
  std::uint64_t seed = 1;
  PairProofs proofs = PairProofs::kBoxes;  // by which pairs are blamed
  // Postures of a pair, the first ones that it refuses, whose gap between the meshes is measured.
  std::size_t gaps = 32;
  int threads = 0;      // 0: all; the result does not depend on it
  Progress progress{};  // called by one thread at a time
};

// Free postures, and how many of them are refused because of spheres.
struct RefusedShare {
  std::size_t free = 0;
  std::size_t refused = 0;

  // Of the free ones; 0 if there are none.
  double share() const;
  // The upper end of the one-sided confidence interval of Clopper and Pearson for the share among
  // all free postures from which these were drawn evenly; 1 if there are none.
  double upper_bound(double confidence = 0.95) const;
};

// What two links do to free postures.
struct PairAlarms {
  int first = 0;  // indices of links, the smaller one first
  int second = 0;
  std::size_t refused = 0;        // free postures in which their spheres overlap
  std::size_t refused_alone = 0;  // among these, those that no other pair refuses
  // The median of the gaps of their meshes in some of these postures, up to a tenth of it, in
  // metres: spheres of the two that protrude by less than that together refuse about half of them.
  double median_gap = std::numeric_limits<double>::infinity();
};

// False alarms among some postures.
struct FalseAlarms {
  std::size_t postures = 0;  // judged
  std::size_t free = 0;      // in which no tested pair of links touches, by the meshes
  // How many of the free ones spheres refuse, by the proofs that are used (PairProofs).
  std::array<std::size_t, 3> refused{};
  PairProofs proofs = PairProofs::kBoxes;  // as the options have them
  // Pairs of links that are not tested because their meshes touch in every one of
  // kAlwaysPostures random postures: with them, no posture is free.
  std::vector<std::pair<int, int>> always_touching{};
  // With these proofs; pairs that refuse something, those that refuse most first.
  std::vector<PairAlarms> pairs{};

  static constexpr std::size_t kAlwaysPostures = 200;

  // With the proofs of the options, or others.
  RefusedShare refused_share() const { return refused_share(proofs); }
  RefusedShare refused_share(PairProofs with) const {
    return {free, refused[static_cast<std::size_t>(with)]};
  }
};

// Counts the false alarms of a robot's own spheres (Link::trees) among random postures within the
// limits. A false alarm is a posture that is free by the meshes, insides counted
// (collide/shapes.h), in which the spheres of two links overlap that are neither
// allowed nor proved free by `proofs` (null: nothing is proved). Spheres must cover the bodies, as
// those of cover_robot() do: the meshes of a pair are tested only where its spheres overlap. A
// posture in which links touch that are allowed to is free. A pair that seems to touch always is
// left out and named (FalseAlarms::always_touching).
//
// Equal for equal input and options, on any number of threads. Throws Error for no postures, for a
// link with spheres and without a body that is tested, a body without or with both shapes, and
// proofs of another robot or other bodies.
FalseAlarms measure_false_alarms(const RobotModel& robot, std::span<const LinkBody> bodies,
                                 const AllowedCollisions& allowed, const LinkPairs* proofs,
                                 const FalseAlarmOptions& options = {});

// How many of the given postures, one configuration behind the other, are false alarms, in the
// sense of the function above without postures of its own. Throws Error, too, if these are not
// whole configurations, and as forward_kinematics().
FalseAlarms measure_false_alarms(const RobotModel& robot, std::span<const LinkBody> bodies,
                                 const AllowedCollisions& allowed, const LinkPairs* proofs,
                                 std::span<const double> postures,
                                 const FalseAlarmOptions& options = {});

}  // namespace spherule
