// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sets of configurations that are proved free, as LinkPair has them.
//
// @code{.cpp}
// #include <spherule/robot/pairs/free_boxes.h>
// #include <cassert>
//
// // From -1 to 1 rad, halved once: free below 0, nothing proved above.
// const spherule::FreeBoxes boxes({{.index = 0, .lower = -1.0, .upper = 1.0}},
//                                 std::string{spherule::FreeBoxes::kFirstHalving,
//                                             spherule::FreeBoxes::kFree,
//                                             spherule::FreeBoxes::kNotProved});
// assert(boxes.contains(std::vector{-0.5}) && !boxes.contains(std::vector{0.5}));
// assert(boxes.contains_edge(std::vector{-0.9}, std::vector{-0.1}) && boxes.free_share() == 0.5);
// @endcode

#include "robot/model/kinematics.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// A set of configurations that are proved free of something, as a tree of halvings (kd-tree) over a
// box of some of a robot's variables: each inner node halves its box at the middle of one of them,
// and a leaf is free as a whole, or not proved. Only those variables matter. Immutable; threads may
// share it, and no query allocates.
//
// Whoever makes it proves every configuration within kMargin of a free leaf in each of its
// variables; the margin is what the arithmetic of the queries and of points on edges may take. A
// configuration within kTolerance of a free leaf counts as in it, so that points of an edge that is
// free are free themselves, whichever way they are rounded.
class FreeBoxes {
 public:
  // With |position| <= kLargestPosition = 100 at both ends of an edge and u = 2^-53, a point (1 -
  // t) a + t b as computed errs by 3 u 200, the place where an edge crosses a plane by 8 u 400, and
  // taking up to 16 turns off by 3e-14: together less than kTolerance, and with that, and with what
  // the end of a motion by the shorter way is off (kTurnError), less than kMargin.
  static constexpr double kMargin = 1e-12;
  static constexpr double kTolerance = 4.7e-13;
  static constexpr std::size_t kMostVariables = 16;
  static constexpr double kLargestPosition = kLargestJointPosition;

  // A variable of the robot, by its index in a configuration, and the proved range of its values,
  // in radians or metres. Values of one that wraps are taken modulo one turn; its range is then
  // -pi to pi.
  struct Variable {
    std::int32_t index = 0;
    bool wraps = false;
    double lower = 0.0;
    double upper = 0.0;

    // Whether all four are the same.
    bool operator==(const Variable&) const = default;
  };

  // The leaf states, and the first of the numbers that stand for halvings: of variables()[i - 2].
  static constexpr std::uint8_t kNotProved = 0;
  static constexpr std::uint8_t kFree = 1;
  static constexpr std::uint8_t kFirstHalving = 2;

  // Nothing is proved.
  FreeBoxes() : FreeBoxes({}, std::string(1, '\0')) {}
  // A tree from its nodes, one byte each, every node before its first and then its second half.
  // Throws Error for more than kMostVariables variables, one that is there twice, a range that is
  // not finite, reversed or beyond kLargestPosition, or other than -pi to pi of one that wraps, and
  // bytes that are no tree.
  FreeBoxes(std::vector<Variable> variables, std::string_view nodes);

  // Whether a configuration of the whole robot lies in a free box, or within kTolerance of one.
  // False for numbers that are not finite and for what lies outside the ranges.
  bool contains(std::span<const double> configuration) const noexcept;

  // Whether every configuration of the straight edge between two lies in free boxes. False, too,
  // for an edge on which a variable that wraps passes the end of its range.
  bool contains_edge(std::span<const double> from, std::span<const double> to) const noexcept;

  // Calls a function for each leaf: whether it is free, and its interval of each of variables().
  void for_each_leaf(const std::function<void(bool is_free, std::span<const double> lower,
                                              std::span<const double> upper)>& visit) const;

  // The bytes it was made of, halves of equal leaves joined.
  const std::string& nodes() const { return bytes_; }
  // What the boxes are of, in the order of their intervals.
  const std::vector<Variable>& variables() const { return variables_; }
  // Leaves, and boxes that are halved.
  std::size_t node_count() const { return nodes_.size(); }
  // Whether any box is free, and the whole box of the ranges.
  bool has_free_box() const { return bytes_[0] != static_cast<char>(kNotProved); }
  bool is_all_free() const { return bytes_[0] == static_cast<char>(kFree); }
  // The share of the box of the ranges that is free, by volume.
  double free_share() const;

 private:
  struct Node {
    double at = 0.0;          // where the box is halved
    std::int32_t state = 0;   // as in nodes()
    std::int32_t second = 0;  // the second half; the first one follows the node
  };
  using Values = std::array<double, kMostVariables>;

  bool take(std::span<const double> configuration, double beyond, const Values* turns,
            Values& values, Values& turns_taken) const noexcept;
  bool point_is_free(std::size_t node, const Values& values) const noexcept;
  bool seam_is_free(Values& values, std::size_t first) const noexcept;
  bool edge_is_free(std::size_t node, const Values& from, const Values& to, double first,
                    double last) const noexcept;

  std::vector<Variable> variables_;
  std::string bytes_;
  std::vector<Node> nodes_;
};

}  // namespace spherule
