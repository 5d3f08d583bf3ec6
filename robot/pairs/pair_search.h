// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/link_pieces.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::internal {

// Two links, the joints that move between them, and the box of the variables that move those.
struct PairSpace {
  const RobotModel* robot = nullptr;
  int first = 0;
  int second = 0;
  std::vector<int> joints;  // that move, from the first link on
  std::vector<FreeBoxes::Variable> variables;
  const LinkPieces* of_first = nullptr;
  const LinkPieces* of_second = nullptr;
  double error = 0.0;  // kinematics_error_bound() for the larger reach
};

// The variables of joints and the ranges that searches take: the limits of the joint that a
// variable is the position of. One that may turn without limits wraps, unless one of the joints
// mimics it.
std::vector<FreeBoxes::Variable> ranges_of(const RobotModel& robot, std::span<const int> joints);

// Whether ranges of variables are all that the limits allow: of a continuous joint, all turns.
bool take_all_positions(const RobotModel& robot, std::span<const FreeBoxes::Variable> ranges);

// None where the bounds do not hold: too many joints, or positions beyond
// FreeBoxes::kLargestPosition somewhere in the ranges, the other variables at zero.
std::optional<PairSpace> make_pair_space(const RobotModel& robot, int first, int second,
                                         const LinkPieces& of_first, const LinkPieces& of_second);

// What halving proved.
struct PairSearchResult {
  std::string nodes;  // as FreeBoxes takes them
  std::size_t boxes = 0;
  // The first middle of a box at which the links touch; empty if none did.
  std::vector<double> witness{};
};

// Where surfaces of fine meshes are near each other in most of a box, it takes thousands of tests
// of pieces. So a search of n boxes also ends once its boxes have taken n times as many as this.
inline constexpr std::size_t kTestsOfBox = 1000;

struct PairSearchLimits {
  std::size_t boxes = 0;
  // Where the links touch, or where so many boxes leave more than kHopeful of the ranges open.
  std::size_t boxes_once_touching = 0;
  // Called at most once, after so many boxes of which no middle touches: whether another search
  // finds that the links do.
  std::function<bool()> finds_contact{};
  double smallest_motion = 0.0;     // of boxes that are halved, metres
  std::function<bool()> is_over{};  // no time is left
};

// What boxes leave open halves more and more slowly, the more joints there are. Where it is more
// than this share of the ranges after LinkPairOptions::boxes, ten times as many do not finish it.
inline constexpr double kHopeful = 0.25;

// Proves boxes of the ranges free, the largest first, those around touching middles later: each box
// that is not proved at its middle is halved, along the variable that moves the links most against
// each other.
//
// Proof for one box (G9). Either the hulls of the links, grown by their radii, are apart throughout
// (pair_bound.h). Or all pairs of leaves (link_pieces.h) are, by pieces that
// hold them, so that the surfaces of meshes,
// grown, and spheres have no point in common throughout; and at the middle the solids have none, as
// exact tests say that know the inside. Then they have none anywhere in the box: it is connected,
// so that on the straight way from the middle a first point in common would have to be one of the
// surfaces, or of a sphere, which is a piece as a whole. The test at the middle holds for the exact
// mechanism too: the pieces' distance exceeds the error of the poses. A pair of nodes of the trees
// of pieces that is proved apart in a box is in its halves; pairs that are not are handed down to
// them.
PairSearchResult search_free_boxes(const PairSpace& space, const PairSearchLimits& limits);

// Where two links come nearest, as far as a search finds it.
struct PairWitness {
  double gap = std::numeric_limits<double>::infinity();  // not below the exact one but by rounding
  std::vector<double> configuration{};                   // of the whole robot
  bool touches() const { return gap == 0.0; }
};

// Searches for a configuration in which two links touch: samples of the ranges, every fourth with
// variables at their limits, then descents from those with the least gap by random steps that are
// cut off at the limits. Gaps are those of exact tests within clearances, inside counted. The same
// for the same seed.
PairWitness find_witness(const PairSpace& space, std::size_t samples, std::uint64_t seed);

}  // namespace spherule::internal
