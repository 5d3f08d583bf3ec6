// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/link_pairs.h"

#include "base/crc64.h"
#include "base/error.h"
#include "base/rounding.h"
#include "robot/model/link_paths.h"
#include "robot/model/shared_work.h"
#include "robot/pairs/link_pieces.h"
#include "robot/pairs/pair_search.h"
#include "robot/pairs/proof_scope.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace spherule {
namespace {

using Clock = std::chrono::steady_clock;

void check(const RobotModel& robot, std::span<const LinkBody> bodies,
           const LinkPairOptions& options) {
  for (const LinkBody& body : bodies) {
    if (body.link < 0 || static_cast<std::size_t>(body.link) >= robot.links().size()) {
      throw Error("link pairs", "a body is of link " + std::to_string(body.link) + " of " +
                                    std::to_string(robot.links().size()));
    }
    if ((body.mesh == nullptr) == (body.spheres == nullptr)) {
      throw Error("link pairs", "a body of link '" +
                                    robot.links()[static_cast<std::size_t>(body.link)].name +
                                    "' needs a mesh or spheres, and not both");
    }
  }
  if (!(options.smallest_motion >= 0.0) || !std::isfinite(options.smallest_motion) ||
      !(options.seconds >= 0.0) || !std::isfinite(options.seconds) || options.threads < 0) {
    throw Error("link pairs", "an option is negative or not finite");
  }
}

// Searches leave variables that change nothing between the two links at zero.
void keep_others_within_limits(const RobotModel& robot,
                               std::span<const FreeBoxes::Variable> variables,
                               std::vector<double>& configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const bool is_searched = std::ranges::any_of(variables, [&](const FreeBoxes::Variable& other) {
      return static_cast<std::size_t>(other.index) == i;
    });
    if (is_searched) continue;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.variable_joints()[i])];
    configuration[i] = std::clamp(configuration[i], joint.lower, joint.upper);
  }
}

LinkPair prove(const RobotModel& robot, int first, int second,
               std::span<const internal::LinkPieces> pieces, const LinkPairOptions& options,
               Clock::time_point end) {
  LinkPair result{.first = first, .second = second};
  const auto is_over = [&] {
    return options.stop.stop_requested() || (options.seconds > 0.0 && Clock::now() >= end);
  };
  if (is_over()) return result;
  const auto space =
      internal::make_pair_space(robot, first, second, pieces[static_cast<std::size_t>(first)],
                                pieces[static_cast<std::size_t>(second)]);
  if (!space || is_over()) return result;
  // Of its own for each pair, so that no thread and no other pair matters.
  const std::uint64_t seed = options.seed * 0x9E3779B97F4A7C15U +
                             static_cast<std::uint64_t>(first) * robot.links().size() +
                             static_cast<std::uint64_t>(second);
  std::optional<internal::PairWitness> witness;
  const auto search_witness = [&] {
    witness = internal::find_witness(*space, options.samples, seed);
    return witness->touches();
  };
  internal::PairSearchResult found =
      internal::search_free_boxes(*space, {.boxes = options.undecided_boxes,
                                           .boxes_once_touching = options.boxes,
                                           .finds_contact = search_witness,
                                           .smallest_motion = options.smallest_motion,
                                           .is_over = is_over});
  result.searched_boxes = found.boxes;
  result.boxes = FreeBoxes(space->variables, found.nodes);
  if (result.boxes.is_all_free()) {
    // A witness is within the rounding of the mesh test then.
    if (internal::take_all_positions(robot, space->variables)) result.verdict = PairVerdict::kNever;
    return result;
  }
  if (found.witness.empty() && !witness && !is_over()) search_witness();
  if (witness) {
    result.smallest_gap = witness->gap;
    if (witness->touches()) found.witness = std::move(witness->configuration);
  }
  if (!found.witness.empty()) {
    result.verdict = PairVerdict::kTouching;
    result.smallest_gap = 0.0;
    result.witness = std::move(found.witness);
    keep_others_within_limits(robot, space->variables, result.witness);
  }
  return result;
}

class Bytes {
 public:
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Eigen::Vector3d& v) {
    for (const double value : v) add(value);
  }
  void add(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
  }
  void add(int value) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(value))); }
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    bytes_ += text;
  }
  std::uint64_t sum() const { return crc64(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

std::string_view name_of(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::kNever:
      return "never";
    case PairVerdict::kTouching:
      return "touching";
    case PairVerdict::kUnknown:
      break;
  }
  return "unknown";
}

LinkPairs::LinkPairs(std::vector<LinkPair> pairs, std::size_t link_count, std::uint64_t mechanism,
                     std::uint64_t bodies, int tool_link)
    : pairs_(std::move(pairs)),
      link_count_(link_count),
      mechanism_(mechanism),
      bodies_(bodies),
      tool_link_(tool_link) {
  if (tool_link < -1 || tool_link >= static_cast<int>(link_count)) {
    throw Error("link pairs", "the link of a tool is not there");
  }
  std::pair<int, int> last{-1, -1};
  for (const LinkPair& pair : pairs_) {
    if (pair.first < 0 || pair.first >= pair.second ||
        static_cast<std::size_t>(pair.second) >= link_count ||
        !(last < std::pair(pair.first, pair.second))) {
      throw Error("link pairs", "the pairs are not in order");
    }
    if (tool_link >= 0 && pair.first != tool_link && pair.second != tool_link) {
      throw Error("link pairs", "a pair is not of the tool's link");
    }
    const bool is_touching = pair.verdict == PairVerdict::kTouching;
    if (is_touching == pair.witness.empty() || (is_touching && pair.boxes.is_all_free()) ||
        (pair.verdict == PairVerdict::kNever && !pair.boxes.is_all_free())) {
      throw Error("link pairs", "a verdict contradicts its proof");
    }
    last = {pair.first, pair.second};
  }
}

const LinkPair* LinkPairs::find(int first, int second) const noexcept {
  const std::pair<int, int> key(std::min(first, second), std::max(first, second));
  const auto found = std::lower_bound(
      pairs_.begin(), pairs_.end(), key,
      [](const LinkPair& pair, const auto& k) { return std::pair(pair.first, pair.second) < k; });
  if (found == pairs_.end() || std::pair(found->first, found->second) != key) return nullptr;
  return &*found;
}

namespace {

// Of all pairs, or those of a link that a tool stands for (-1: all).
LinkPairs prove_pairs_of(int only, const RobotModel& robot, std::span<const LinkBody> bodies,
                         const LinkPairOptions& options) {
  require_rounding_to_nearest();
  check(robot, bodies, options);
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::min(options.seconds, 1e9)));
  const std::size_t count = robot.links().size();
  const std::size_t threads = internal::thread_count(options.threads);
  std::vector<std::vector<LinkBody>> bodies_of(count);
  for (const LinkBody& body : bodies) {
    bodies_of[static_cast<std::size_t>(body.link)].push_back(body);
  }
  std::vector<internal::LinkPieces> pieces(count);
  internal::share_work(count, threads, [&](std::size_t, std::size_t link) {
    if (!bodies_of[link].empty()) pieces[link] = internal::make_link_pieces(bodies_of[link]);
  });
  std::vector<LinkPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const int first = static_cast<int>(i);
      const int second = static_cast<int>(j);
      if (bodies_of[i].empty() || bodies_of[j].empty()) continue;
      if (only >= 0 && first != only && second != only) continue;
      if (internal::moving_joints(robot, first, second).empty()) continue;
      pairs.push_back({.first = first, .second = second});
    }
  }
  std::mutex progress_lock;
  std::size_t done = 0;
  internal::share_work(pairs.size(), threads, [&](std::size_t, std::size_t i) {
    pairs[i] = prove(robot, pairs[i].first, pairs[i].second, pieces, options, end);
    if (!options.progress) return;
    const std::scoped_lock lock(progress_lock);
    options.progress(static_cast<double>(++done) / static_cast<double>(pairs.size()),
                     "pairs of links");
  });
  return LinkPairs(std::move(pairs), count, mechanism_fingerprint(robot),
                   bodies_fingerprint(bodies), only);
}

}  // namespace

LinkPairs prove_link_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                           const LinkPairOptions& options) {
  return prove_pairs_of(-1, robot, bodies, options);
}

LinkPairs prove_attached_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                               const LinkBody& tool, const LinkPairOptions& options) {
  std::vector<LinkBody> all;
  for (const LinkBody& body : bodies) {
    if (body.link != tool.link) all.push_back(body);
  }
  all.push_back(tool);
  return prove_pairs_of(tool.link, robot, all, options);
}

std::uint64_t mechanism_fingerprint(const RobotModel& robot) {
  Bytes bytes;
  for (const Link& link : robot.links()) bytes.add(link.name);
  for (const Joint& joint : robot.joints()) {
    bytes.add(joint.name);
    bytes.add(static_cast<int>(joint.type));
    bytes.add(joint.parent_link);
    bytes.add(joint.child_link);
    const Eigen::Quaterniond rotation = joint.parent_from_joint.rotation();
    for (const double value : rotation.coeffs()) bytes.add(value);
    bytes.add(joint.parent_from_joint.translation());
    bytes.add(joint.axis);
    bytes.add(joint.variable);
    bytes.add(joint.multiplier);
    bytes.add(joint.offset);
    bytes.add(joint.mimics);
  }
  return bytes.sum();
}

std::uint64_t bodies_fingerprint(std::span<const LinkBody> bodies) {
  Bytes bytes;
  for (const LinkBody& body : bodies) {
    bytes.add(body.link);
    if (body.mesh != nullptr) {
      bytes.add(body.mesh->inflation());
      const MeshTree& mesh = body.mesh->mesh();
      const auto count = static_cast<std::int32_t>(mesh.tree().spheres().size());
      bytes.add(static_cast<int>(count));
      for (std::int32_t i = 0; i < count; ++i) {
        for (const Eigen::Vector3d& corner : mesh.triangle(i)) bytes.add(corner);
      }
    } else if (body.spheres != nullptr) {
      bytes.add(-1);
      for (const Sphere& sphere : body.spheres->spheres()) {
        bytes.add(sphere.center);
        bytes.add(sphere.radius);
      }
    }
  }
  return bytes.sum();
}

}  // namespace spherule

namespace spherule::internal {

std::vector<PositionLimits> position_limits(const RobotModel& robot) {
  std::vector<PositionLimits> result;
  for (const int index : robot.variable_joints()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    result.emplace_back(joint.lower, joint.upper);
  }
  return result;
}

void require_proofs_of(const LinkPairs& pairs, const RobotModel& robot, int tool_link) {
  require_proofs_of(pairs, mechanism_fingerprint(robot), robot.links().size(),
                    static_cast<std::size_t>(robot.variable_count()), tool_link);
}

void require_proofs_of(const LinkPairs& pairs, std::uint64_t mechanism, std::size_t links,
                       std::size_t variables, int tool_link) {
  if (pairs.mechanism() != mechanism || pairs.link_count() != links) {
    throw Error("proofs of pairs", "they are of another robot: its links and joints are not these");
  }
  if (pairs.tool_link() != tool_link) {
    throw Error("proofs of pairs", tool_link < 0 ? "they are of a tool alone"
                                                 : "they are of no tool on the object's link");
  }
  for (const LinkPair& pair : pairs.pairs()) {
    for (const FreeBoxes::Variable& variable : pair.boxes.variables()) {
      if (static_cast<std::size_t>(variable.index) < variables) continue;
      throw Error("proofs of pairs", "they read a variable that the robot does not have");
    }
  }
}

void require_never_within(const LinkPairs& pairs, std::span<const PositionLimits> limits) {
  for (const LinkPair& pair : pairs.pairs()) {
    if (pair.verdict != PairVerdict::kNever) continue;
    for (const FreeBoxes::Variable& proved : pair.boxes.variables()) {
      const auto& [lower, upper] = limits[static_cast<std::size_t>(proved.index)];
      if (proved.wraps || (proved.lower <= lower && upper <= proved.upper)) continue;
      throw Error("proofs of pairs", "the limits of a joint are wider than those they hold for");
    }
  }
}

void require_never_holds(const LinkPairs& pairs, const RobotModel& robot) {
  require_proofs_of(pairs, robot);
  require_never_within(pairs, position_limits(robot));
}

}  // namespace spherule::internal
