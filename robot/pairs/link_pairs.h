// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which links of a robot can touch each other: prove_link_pairs(). Before it, sets of
// configurations that are proved free, as LinkPair has them.
//
// @code{.cpp}
// #include <spherule/robot/pairs/link_pairs.h>
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

#include "base/progress.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stop_token>
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

// Which links of a robot can touch each other within the limits of the joints, proved where
// possible.
//
// @code{.cpp}
// #include <spherule/spheretree/sphere_tree.h>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const auto sphere_at = [](double x) {
//   const std::vector<spherule::Sphere> spheres{{{x, 0, 0}, 0.1}};
//   return std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// };
// const std::vector<spherule::LinkBody> bodies{{.link = 0, .spheres = sphere_at(0.0)},
//                                              {.link = 1, .spheres = sphere_at(1.0)}};
// const spherule::LinkPairs pairs = spherule::prove_link_pairs(robot, bodies);
// assert(pairs.find(0, 1)->verdict == spherule::PairVerdict::kNever);
// @endcode

// What a link, or a tool that is fixed to it, is made of, in the frame of the link, in metres. One
// of the two: a mesh with its inside (its growth counts), or spheres, of which each is solid.
struct LinkBody {
  int link = 0;
  std::shared_ptr<const SolidMesh> mesh{};
  std::shared_ptr<const SphereTree> spheres{};
};

// What is known of two links, wherever the limits let the joints be. Continuous joints take every
// position; a joint that mimics another one is where that puts it, whatever its own limits say.
enum class PairVerdict : std::uint8_t {
  kNever,     // proved: they have no point in common in any configuration
  kTouching,  // they have one in the configuration `witness`, up to the rounding of mesh tests, by
              // the meshes that stand for them
  kUnknown,   // neither was found
};

// For people: what stands in tables.
std::string_view name_of(PairVerdict verdict);

// Two links that joints move against each other. Inside counts: a link within a closed other one
// touches it.
struct LinkPair {
  int first = 0;  // indices of links, the smaller one first
  int second = 0;
  PairVerdict verdict = PairVerdict::kUnknown;
  // A configuration of the whole robot, empty unless they touch. Joints that do not move one of the
  // links against the other are as near to zero as their limits allow.
  std::vector<double> witness{};
  // An upper bound of the smallest gap found, up to rounding, in metres; 0 where they touch.
  // Infinite where no samples were taken or kept: of kNever, and of kUnknown where the boxes are
  // all free, no time was left, the joints or positions are too many or too large, or no samples
  // were requested.
  double smallest_gap = std::numeric_limits<double>::infinity();
  // Proved: in no configuration of these boxes the two have a point in common, of the exact
  // mechanism, or under the poses that forward_kinematics() computes with the root at the world's
  // origin. All of the ranges for kNever. For kUnknown that is so, too, where the ranges are not
  // all that the joints can do: of a continuous joint that a mimic follows.
  FreeBoxes boxes{};
  std::size_t searched_boxes = 0;
};

// How long is searched. Equal options give equal results on any number of threads, unless `seconds`
// is set or a stop is requested.
struct LinkPairOptions {
  // How many boxes of the joints' ranges are examined for a pair, at most: where a configuration is
  // found in which it touches, or where more than a quarter of the ranges is not proved free after
  // so many; and where a proof of all is near. Fewer where they take more than 1000 tests each of
  // pieces of the links, on average.
  std::size_t boxes = 8000;
  std::size_t undecided_boxes = 100000;
  std::size_t samples = 300;  // configurations from which a witness is searched
  // Boxes in which the two move against each other by less are not halved, in metres.
  double smallest_motion = 1e-4;
  double seconds = 0.0;  // limit for all pairs together; what is left then is kUnknown. 0: none
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  // Once requested, what is not decided is kUnknown.
  std::stop_token stop{};
  // Called with the share of the pairs that are done and a word, from one thread at a time.
  Progress progress{};
};

// The pairs of a robot's links that joints move against each other, and what is proved of each.
// Immutable; threads may share it.
class LinkPairs {
 public:
  // No pairs, of no robot.
  LinkPairs() = default;
  // Pairs in the order of their indices, each once, first before second, and the fingerprints of
  // what they hold for. Where they are of a tool, `tool_link` is the link that carries it, and one
  // of each pair. Throws Error otherwise, for indices beyond the number of links, and a verdict
  // that contradicts the boxes or the witness.
  LinkPairs(std::vector<LinkPair> pairs, std::size_t link_count, std::uint64_t mechanism,
            std::uint64_t bodies, int tool_link = -1);

  // In the order of their indices.
  const std::vector<LinkPair>& pairs() const { return pairs_; }
  // Of the robot that they were proved for.
  std::size_t link_count() const { return link_count_; }
  // The fingerprints of that robot, and of its bodies.
  std::uint64_t mechanism() const { return mechanism_; }
  std::uint64_t bodies() const { return bodies_; }
  // The link for which a tool that it carries stands alone (prove_attached_pairs()); -1: none.
  int tool_link() const { return tool_link_; }

  // The pair of two links in either order, or null: rigidly joined, or a link without a body. Who
  // queries often keeps it: a binary search.
  const LinkPair* find(int first, int second) const noexcept;

  // Whether two links are proved free in a configuration, or on all of the straight edge between
  // two. False where nothing is proved. Neither allocates.
  bool is_free(int first, int second, std::span<const double> configuration) const noexcept {
    const LinkPair* const pair = find(first, second);
    return pair != nullptr && pair->boxes.contains(configuration);
  }
  bool is_edge_free(int first, int second, std::span<const double> from,
                    std::span<const double> to) const noexcept {
    const LinkPair* const pair = find(first, second);
    return pair != nullptr && pair->boxes.contains_edge(from, to);
  }

 private:
  std::vector<LinkPair> pairs_;
  std::size_t link_count_ = 0;
  std::uint64_t mechanism_ = 0;
  std::uint64_t bodies_ = 0;
  int tool_link_ = -1;
};

// Proves what it can of all pairs of links with bodies, within the limits of the joints; continuous
// joints take all positions, but where a mimic follows one, boxes reach from -pi to pi, and the
// pair is kUnknown even if all of that is free. Pairs with more than 16 joints between them or
// positions beyond 100 stay kUnknown. Several bodies of a link count together. The trees of the
// robot's links are not examined. The proof is in pair_bound.h and
// pair_search.h. Throws Error for a body without or with both shapes, a link out of range,
// and options that are negative or not finite.
LinkPairs prove_link_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                           const LinkPairOptions& options = {});

// Proves what it can of a tool that is fixed to a link, or of what a gripper holds, as
// prove_link_pairs() does: of the pairs of its link with all others, in which the tool alone stands
// for that link. `bodies` are those of the links; those of links that do not move against the tool
// are of no matter. Throws Error as above.
LinkPairs prove_attached_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                               const LinkBody& tool, const LinkPairOptions& options = {});

// Of links, joints, origins, axes and mimics, not of limits and trees, bit by bit.
std::uint64_t mechanism_fingerprint(const RobotModel& robot);
// Of triangles, spheres and growth, bit by bit.
std::uint64_t bodies_fingerprint(std::span<const LinkBody> bodies);

// Proofs about pairs of links in files (docs/link-pairs-file.md).
//
// @code{.cpp}
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// const std::vector<spherule::LinkBody> bodies{{.link = 0, .spheres = sphere},
//                                              {.link = 1, .spheres = sphere}};
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.pairs";
// spherule::save_link_pairs(spherule::prove_link_pairs(robot, bodies), path);
// const spherule::LinkPairs pairs = spherule::load_link_pairs(path, robot, bodies);
// assert(pairs.find(0, 1)->verdict == spherule::PairVerdict::kTouching);
// @endcode

// Writes proofs to a file, at once or not at all: little-endian bytes,
// one for each node of a tree of boxes, and a checksum. Throws Error naming the file.
void save_link_pairs(const LinkPairs& pairs, const std::filesystem::path& path);

// Reads them for the robot and the bodies they were made for. Limits that are tighter than those of
// the proofs leave them valid; a witness may then be beyond them. Throws Error naming the file: for
// one that cannot be read, is damaged, is no such file or of a later version; for another robot,
// that is, another mechanism, mesh, sphere or attached body; and for limits of a joint that are
// wider than those the proofs were made with.
LinkPairs load_link_pairs(const std::filesystem::path& path, const RobotModel& robot,
                          std::span<const LinkBody> bodies);

}  // namespace spherule
