// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/pair_search.h"

#include "base/rounding.h"
#include "robot/model/kinematics.h"
#include "robot/model/link_paths.h"
#include "robot/pairs/pair_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>

namespace spherule::internal {
namespace {

const Joint& joint_of(const RobotModel& robot, int index) {
  return robot.joints()[static_cast<std::size_t>(index)];
}

// With each variable anywhere in its range, and zero without one.
bool positions_are_small(const RobotModel& robot, std::span<const FreeBoxes::Variable> variables) {
  return std::all_of(robot.joints().begin(), robot.joints().end(), [&](const Joint& joint) {
    if (!joint.moves()) return true;
    double most = 0.0;
    for (const FreeBoxes::Variable& variable : variables) {
      if (variable.index == joint.variable) {
        most = std::max(std::abs(variable.lower), std::abs(variable.upper));
      }
    }
    return most + 1.0 <= FreeBoxes::kLargestPosition &&
           std::abs(joint.multiplier) * (most + 1.0) + std::abs(joint.offset) <=
               FreeBoxes::kLargestPosition;
  });
}

}  // namespace

bool take_all_positions(const RobotModel& robot, std::span<const FreeBoxes::Variable> ranges) {
  return std::all_of(ranges.begin(), ranges.end(), [&](const FreeBoxes::Variable& range) {
    const auto variable = static_cast<std::size_t>(range.index);
    return range.wraps ||
           joint_of(robot, robot.variable_joints()[variable]).type != JointType::kContinuous;
  });
}

std::vector<FreeBoxes::Variable> ranges_of(const RobotModel& robot, std::span<const int> joints) {
  std::vector<FreeBoxes::Variable> result;
  for (const int index : joints) {
    const int variable = joint_of(robot, index).variable;
    const Joint& leader =
        joint_of(robot, robot.variable_joints()[static_cast<std::size_t>(variable)]);
    const auto known = std::find_if(result.begin(), result.end(),
                                    [&](const auto& other) { return other.index == variable; });
    const bool follows = joint_of(robot, index).mimics >= 0;
    if (known != result.end()) {
      known->wraps &= !follows;
      continue;
    }
    result.push_back(
        {variable, leader.type == JointType::kContinuous && !follows, leader.lower, leader.upper});
  }
  return result;
}

std::optional<PairSpace> make_pair_space(const RobotModel& robot, int first, int second,
                                         const LinkPieces& of_first, const LinkPieces& of_second) {
  PairSpace space{&robot, first,     second,     moving_joints(robot, first, second),
                  {},     &of_first, &of_second, 0.0};
  if (space.joints.size() > PairBound::kMostJoints) return std::nullopt;
  space.variables = ranges_of(robot, space.joints);
  if (space.variables.size() > FreeBoxes::kMostVariables ||
      !positions_are_small(robot, space.variables)) {
    return std::nullopt;
  }
  space.error = kinematics_error_bound(robot, std::max(of_first.reach, of_second.reach));
  return space;
}

namespace {

// A pair that touches at the middles of all of so many boxes is given up: links that always touch.
constexpr std::size_t kAlwaysTouching = 1000;

// What halves are worth beside their whole, and beside that if the links touch at its middle: where
// they mostly touch, there is less to prove.
constexpr double kHalf = 0.5;
constexpr double kWhereTouching = 0.5;

using Bounds = std::array<double, FreeBoxes::kMostVariables>;

struct Box {
  Bounds lower{};
  Bounds upper{};
  std::size_t node = 0;
  Vector3d direction = Vector3d::UnitX();  // that separated the hulls at the middle of the whole
  std::vector<PieceNodes> front{{0, 0}};
  double worth = 1.0;
  double share = 1.0;  // of the ranges

  // The heap's order: what is worth most first, then what came first.
  friend bool operator<(const Box& a, const Box& b) {
    return a.worth < b.worth || (a.worth == b.worth && a.node > b.node);
  }
};

enum class Outcome { kFree, kOpen, kTouching };

class Search {
 public:
  Search(const PairSpace& space, const PairSearchLimits& limits)
      : space_(space),
        limits_(limits),
        bound_(*space.robot, space.joints, space.error),
        configuration_(static_cast<std::size_t>(space.robot->variable_count()), 0.0),
        half_widths_(configuration_.size(), 0.0) {}

  PairSearchResult run() {
    PairSearchResult result;
    Box whole;
    for (std::size_t i = 0; i < space_.variables.size(); ++i) {
      whole.lower[i] = space_.variables[i].lower;
      whole.upper[i] = space_.variables[i].upper;
    }
    tree_.emplace_back();
    std::vector<Box> open;
    open.push_back(std::move(whole));
    bool always = true;
    while (!open.empty() && !is_finished(result)) {
      if (result.boxes % 16 == 0 && limits_.is_over && limits_.is_over()) break;
      if (always && result.boxes >= kAlwaysTouching) break;
      std::pop_heap(open.begin(), open.end());
      Box box = std::move(open.back());
      open.pop_back();
      ++result.boxes;
      place(box);
      const Outcome outcome = judge(box);
      always &= outcome == Outcome::kTouching;
      if (outcome == Outcome::kFree) {
        tree_[box.node].state = FreeBoxes::kFree;
        open_share_ -= box.share;
        continue;
      }
      if (outcome == Outcome::kTouching && result.witness.empty()) result.witness = configuration_;
      box.worth *= outcome == Outcome::kTouching ? kHalf * kWhereTouching : kHalf;
      halve(std::move(box), open);
    }
    write(0, result.nodes);
    return result;
  }

 private:
  struct Node {
    std::uint8_t state = FreeBoxes::kNotProved;
    std::size_t first = 0;  // the second half follows it
  };

  const Pose& first_pose() const { return poses_[static_cast<std::size_t>(space_.first)]; }
  const Pose& second_pose() const { return poses_[static_cast<std::size_t>(space_.second)]; }

  bool is_finished(const PairSearchResult& so_far) {
    const auto is_reached = [&](std::size_t boxes) {
      return so_far.boxes >= boxes || tests_ / kTestsOfBox >= boxes;
    };
    if (!so_far.witness.empty()) return is_reached(limits_.boxes_once_touching);
    if (is_proof_near_) return is_reached(limits_.boxes);
    if (!is_reached(std::min(limits_.boxes_once_touching, limits_.boxes))) return false;
    is_proof_near_ = limits_.boxes_once_touching < limits_.boxes && open_share_ <= kHopeful &&
                     !(limits_.finds_contact && limits_.finds_contact());
    return !is_proof_near_;
  }

  void place(const Box& box) {
    for (std::size_t i = 0; i < space_.variables.size(); ++i) {
      const auto index = static_cast<std::size_t>(space_.variables[i].index);
      const double middle = 0.5 * (box.lower[i] + box.upper[i]);
      configuration_[index] = middle;
      half_widths_[index] = std::max(sub_up(box.upper[i], middle), sub_up(middle, box.lower[i]));
    }
    forward_kinematics(*space_.robot, configuration_, poses_);
    bound_.place(poses_, half_widths_);
  }

  bool touch_at_middle() const {
    return touches(*space_.of_first, first_pose(), *space_.of_second, second_pose(), 0.0);
  }

  Outcome judge(Box& box) {
    const LinkPieces& a = *space_.of_first;
    const LinkPieces& b = *space_.of_second;
    const double radii = add_up(a.hull_radius, b.hull_radius);
    const PlacedPair placed{a, first_pose(), b, second_pose(), bound_};
    const double gap = placed.direction_between(a.hull, b.hull, box.direction) - radii;
    if (gap > 0.0 &&
        bound_.are_apart(box.direction, first_pose(), a.hull, second_pose(), b.hull, radii)) {
      return Outcome::kFree;
    }
    if (gap > 0.0 && a.is_convex && b.is_convex) return Outcome::kOpen;
    if (gap <= 0.0 && touch_at_middle()) return Outcome::kTouching;
    if (!clear_front(placed, box.front, tests_)) return Outcome::kOpen;
    return gap <= 0.0 || !touch_at_middle() ? Outcome::kFree : Outcome::kTouching;
  }

  void halve(Box box, std::vector<Box>& open) {
    const Vector3d first = first_pose() * space_.of_first->nodes[0].sphere.center;
    const Vector3d second = second_pose() * space_.of_second->nodes[0].sphere.center;
    const double radius =
        std::min(space_.of_first->nodes[0].sphere.radius, space_.of_second->nodes[0].sphere.radius);
    std::array<double, FreeBoxes::kMostVariables> motions{};
    double sum = 0.0;
    for (std::size_t step = 0; step < space_.joints.size(); ++step) {
      const Joint& joint = space_.robot->joints()[static_cast<std::size_t>(space_.joints[step])];
      const double scale = joint.mimics < 0 ? 1.0 : std::abs(joint.multiplier);
      const double half = half_widths_[static_cast<std::size_t>(joint.variable)] * scale;
      const double motion =
          bound_.motion(step, first, second) + (joint.turns() ? half * radius : 0.0);
      sum += motion;
      for (std::size_t i = 0; i < space_.variables.size(); ++i) {
        if (space_.variables[i].index == joint.variable) motions[i] += motion;
      }
    }
    if (!(sum > limits_.smallest_motion)) return;
    const auto v = static_cast<std::size_t>(
        std::max_element(motions.begin(), motions.begin() + std::ssize(space_.variables)) -
        motions.begin());
    const double middle = 0.5 * (box.lower[v] + box.upper[v]);
    if (!(box.lower[v] < middle && middle < box.upper[v])) return;
    tree_[box.node].state = static_cast<std::uint8_t>(FreeBoxes::kFirstHalving + v);
    tree_[box.node].first = tree_.size();
    box.share *= 0.5;
    Box other = box;
    box.node = tree_.size();
    box.upper[v] = middle;
    other.node = tree_.size() + 1;
    other.lower[v] = middle;
    tree_.resize(tree_.size() + 2);
    open.push_back(std::move(box));
    std::push_heap(open.begin(), open.end());
    open.push_back(std::move(other));
    std::push_heap(open.begin(), open.end());
  }

  void write(std::size_t index, std::string& nodes) const {
    nodes.push_back(static_cast<char>(tree_[index].state));
    if (tree_[index].state < FreeBoxes::kFirstHalving) return;
    write(tree_[index].first, nodes);
    write(tree_[index].first + 1, nodes);
  }

  const PairSpace& space_;
  const PairSearchLimits& limits_;
  PairBound bound_;
  std::vector<double> configuration_;  // of the middle
  std::vector<double> half_widths_;
  std::vector<Pose> poses_;
  std::vector<Node> tree_;
  std::size_t tests_ = 0;    // of pairs of pieces
  double open_share_ = 1.0;  // of the ranges, not proved yet
  bool is_proof_near_ = false;
};

}  // namespace

PairSearchResult search_free_boxes(const PairSpace& space, const PairSearchLimits& limits) {
  return Search(space, limits).run();
}

namespace {

constexpr double kFarthest = 1.0;   // gaps beyond are taken as this, metres
constexpr double kLeastGap = 1e-7;  // a descent that came as near as that ends
constexpr std::size_t kDescents = 4;
constexpr int kSteps = 200;
constexpr double kShrink = 0.9;         // by which a step has to reduce the gap
constexpr double kSmallestStep = 1e-5;  // of the ranges

class WitnessSearch {
 public:
  WitnessSearch(const PairSpace& space, std::uint64_t seed)
      : space_(space),
        bits_(seed),
        configuration_(static_cast<std::size_t>(space.robot->variable_count()), 0.0) {}

  PairWitness run(std::size_t samples) {
    struct Sample {
      double gap;
      std::vector<double> values;
    };
    std::vector<Sample> found;
    for (std::size_t n = 0; n < samples; ++n) {
      std::vector<double> values = draw(n % 4 == 3);
      const double gap = gap_at(values, kFarthest);
      if (keep(values, gap)) return best_;
      found.push_back({gap, std::move(values)});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Sample& a, const Sample& b) { return a.gap < b.gap; });
    for (std::size_t i = 0; i < std::min(kDescents, found.size()); ++i) {
      if (descend(std::move(found[i].values), found[i].gap)) break;
    }
    return best_;
  }

 private:
  double even() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

  std::vector<double> draw(bool at_limits) {
    std::vector<double> values;
    for (const FreeBoxes::Variable& variable : space_.variables) {
      const double part = even();
      const double place = at_limits && even() < 0.5 ? (part < 0.5 ? 0.0 : 1.0) : part;
      values.push_back(std::clamp(variable.lower + (variable.upper - variable.lower) * place,
                                  variable.lower, variable.upper));
    }
    return values;
  }

  bool comes_within(const std::vector<double>& values, double clearance) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      configuration_[static_cast<std::size_t>(space_.variables[i].index)] = values[i];
    }
    forward_kinematics(*space_.robot, configuration_, poses_);
    return touches(*space_.of_first, poses_[static_cast<std::size_t>(space_.first)],
                   *space_.of_second, poses_[static_cast<std::size_t>(space_.second)], clearance);
  }

  // To about a tenth; 0 where they touch, and `most` beyond it.
  double gap_at(const std::vector<double>& values, double most) {
    if (!comes_within(values, most)) return most;
    if (comes_within(values, 0.0)) return 0.0;
    double low = 0.0;
    double high = most;
    while (high - low > 0.1 * high && high > kLeastGap) {
      const double middle = 0.5 * (low + high);
      (comes_within(values, middle) ? high : low) = middle;
    }
    return high;
  }

  // Whether they touch.
  bool keep(const std::vector<double>& values, double gap) {
    if (gap >= best_.gap) return best_.touches();
    best_.gap = gap;
    for (std::size_t i = 0; i < values.size(); ++i) {
      configuration_[static_cast<std::size_t>(space_.variables[i].index)] = values[i];
    }
    best_.configuration = configuration_;
    return best_.touches();
  }

  bool descend(std::vector<double> values, double gap) {
    double step = 0.2;
    for (int n = 0; n < kSteps && step > kSmallestStep && gap > kLeastGap; ++n) {
      std::vector<double> next = values;
      for (std::size_t i = 0; i < next.size(); ++i) {
        const FreeBoxes::Variable& variable = space_.variables[i];
        const double change = step * (even() + even() + even() - 1.5);
        next[i] = std::clamp(next[i] + change * (variable.upper - variable.lower), variable.lower,
                             variable.upper);
      }
      if (comes_within(next, kShrink * gap)) {
        values = std::move(next);
        gap = gap_at(values, kShrink * gap);
        if (keep(values, gap)) return true;
        step *= 1.5;
      } else {
        step *= 0.95;
      }
    }
    return false;
  }

  const PairSpace& space_;
  std::mt19937_64 bits_;
  std::vector<double> configuration_;
  std::vector<Pose> poses_;
  PairWitness best_;
};

}  // namespace

PairWitness find_witness(const PairSpace& space, std::size_t samples, std::uint64_t seed) {
  return WitnessSearch(space, seed).run(samples);
}

}  // namespace spherule::internal
