// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/false_alarms.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// A set of postures, by their indices below a number that is given when it is made.
class PostureSet {
 public:
  // Bits that are stored as one.
  static constexpr std::size_t kWordBits = 64;

  PostureSet() = default;
  // None of so many.
  explicit PostureSet(std::size_t count) : words_((count + kWordBits - 1) / kWordBits) {}

  bool contains(std::size_t i) const {
    return (words_[i / kWordBits] >> (i % kWordBits) & 1U) != 0;
  }
  void insert(std::size_t i) { words_[i / kWordBits] |= std::uint64_t{1} << (i % kWordBits); }

  // How many it holds.
  std::size_t size() const {
    std::size_t result = 0;
    for (const std::uint64_t word : words_) result += static_cast<std::size_t>(std::popcount(word));
    return result;
  }

  // Both are sets of the same number of postures.
  PostureSet& operator|=(const PostureSet& other) { return combine(other, std::bit_or<>()); }
  PostureSet& operator&=(const PostureSet& other) { return combine(other, std::bit_and<>()); }
  PostureSet& operator-=(const PostureSet& other) {
    return combine(other, [](std::uint64_t a, std::uint64_t b) { return a & ~b; });
  }

  // Words of kWordBits postures: threads may insert into different ones at once.
  std::size_t word_count() const { return words_.size(); }
  // Calls `visit` with each index within a word that the set holds, in order.
  template <class Visit>
  void for_each_in_word(std::size_t word, Visit visit) const {
    for (std::uint64_t left = words_[word]; left != 0; left &= left - 1) {
      visit(word * kWordBits + static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
  // Calls `visit` with each index that the set holds, in order.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t word = 0; word < words_.size(); ++word) for_each_in_word(word, visit);
  }

 private:
  template <class Combine>
  PostureSet& combine(const PostureSet& other, Combine by) {
    std::ranges::transform(words_, other.words_, words_.begin(), by);
    return *this;
  }

  std::vector<std::uint64_t> words_;
};

// The trees of each link.
using LinkTrees = std::vector<std::vector<std::shared_ptr<const SphereTree>>>;

// Two links that are tested against each other, the smaller index first.
struct TestedPair {
  int first = 0;
  int second = 0;
};

// What false alarms are judged by: the bodies of all links, and the pairs that are tested.
class AlarmJudge {
 public:
  // Pairs of links that `has_spheres` tells to have some and `allowed` does not allow. `robot` and
  // `proofs` are kept by reference. Throws Error as measure_false_alarms().
  AlarmJudge(const RobotModel& robot, std::span<const LinkBody> bodies,
             const AllowedCollisions& allowed, const LinkPairs* proofs,
             const std::function<bool(int)>& has_spheres);

  const RobotModel& robot() const { return robot_; }
  const std::vector<TestedPair>& pairs() const { return pairs_; }
  // As FalseAlarms has them; they are not among the pairs.
  const std::vector<std::pair<int, int>>& always_touching() const { return always_touching_; }
  // Whether the meshes of a pair come within a clearance of each other.
  bool touches(const TestedPair& pair, std::span<const Pose> poses, double clearance) const;
  // Whether the test of a pair's spheres is spared: by kNever everywhere, as by ignore lists, by
  // kBoxes where the pair is proved free.
  bool is_spared(const TestedPair& pair, PairProofs with, std::span<const double> posture) const;

 private:
  void leave_out_always_touching();

  const RobotModel& robot_;
  const LinkPairs* proofs_;
  std::vector<std::vector<LinkBody>> bodies_;  // of each link
  std::vector<TestedPair> pairs_;
  std::vector<std::pair<int, int>> always_touching_;
};

// The free ones of some postures, by the meshes. What is free does not depend on the trees by which
// it is found, as long as these cover the bodies.
class AlarmSample {
 public:
  // Of postures one behind the other. Where `trees` do not overlap, no mesh is tested.
  AlarmSample(const AlarmJudge& judge, const LinkTrees& trees, std::vector<double> postures,
              std::size_t threads, const std::function<void(double)>& progress);

  // How many were judged, and how many of them are free. Sets below are of the free ones.
  std::size_t postures() const { return posture_count_; }
  std::size_t free() const { return free_.size(); }

  // In which the test of a pair's spheres is not spared.
  PostureSet open(std::size_t pair, PairProofs with) const;
  // Those among some in which any two trees of the two links of a pair overlap.
  PostureSet overlaps(std::size_t pair, std::span<const std::shared_ptr<const SphereTree>> first,
                      std::span<const std::shared_ptr<const SphereTree>> second,
                      const PostureSet& among) const;
  // The gap of the meshes of a pair in a free posture, up to a tenth of it and a micrometre.
  double gap(std::size_t pair, std::size_t free) const;

 private:
  std::span<const double> posture(std::size_t index) const {
    return std::span(postures_).subspan(index * width_, width_);
  }
  // Of a link that is tested, in a free posture.
  const Pose& pose(std::size_t free, int link) const {
    return poses_[free * slot_count_ + slot_of_[static_cast<std::size_t>(link)]];
  }
  void place_free_postures();

  const AlarmJudge& judge_;
  std::vector<double> postures_;
  std::size_t width_;
  std::size_t posture_count_;
  std::size_t threads_;
  std::vector<std::size_t> free_;     // indices of postures
  std::vector<std::size_t> slot_of_;  // of each link that is tested, among the poses of a posture
  std::size_t slot_count_ = 0;
  std::vector<Pose> poses_;  // of all tested links, for each free posture
};

// Draws positions evenly between the limits of the joints that the variables move; turning joints
// without limits get a whole turn. `configuration` has variable_count() numbers.
void draw_configuration(const RobotModel& robot, std::mt19937_64& bits,
                        std::span<double> configuration);

// So many postures, drawn with a seed.
std::vector<double> draw_postures(const RobotModel& robot, std::size_t count, std::uint64_t seed);

// The trees of the robot's own links.
LinkTrees trees_of(const RobotModel& robot);

// Adds what was counted in other postures of the same robot, by the same options.
void add(const FalseAlarms& other, FalseAlarms& sum);

// What spheres do to a sample.
FalseAlarms count_alarms(const AlarmJudge& judge, const AlarmSample& sample, const LinkTrees& trees,
                         const FalseAlarmOptions& options);

// The upper end of the one-sided confidence interval of Clopper and Pearson (1934) for the
// probability of an event that `hits` of `trials` independent trials showed: the largest
// probability under which so few hits have at least the probability 1 - confidence. In at least the
// share `confidence` of all samples it is not below the true probability, whatever that is. Up to
// rounding of about 1e-12; 1 without trials. At most `trials` hits, confidence in (0, 1).
double share_upper_bound(std::size_t hits, std::size_t trials, double confidence);

}  // namespace spherule::internal
