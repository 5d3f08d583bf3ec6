// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_checker.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "collide/collide.h"
#include "robot/check/checker_parts.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Edges that a thread takes at a time, and configurations: whole blocks of TreeCheck, and so
// many that what a scratch remembers is worth something. To start and end a thread takes 40 to 75
// us on a small cloud machine, a configuration against static trees of an easy cell 41 ns: for
// kFewestShared the second thread saves what it costs. Others take longer: more than one piece of
// them is worth a thread.
constexpr std::size_t kEdgesAPiece = 16;
constexpr std::size_t kPiece = 512;
constexpr std::size_t kFewestShared = 4096;
static_assert(kPiece % internal::TreeCheck::kBlock == 0);

void require_size(const RobotModel& robot, std::span<const double> configuration) {
  if (configuration.size() != static_cast<std::size_t>(robot.variable_count())) {
    throw Error("configuration", "it has " + std::to_string(configuration.size()) +
                                     " numbers where the robot has " +
                                     std::to_string(robot.variable_count()) + " variables");
  }
}

void require_finite(std::span<const double> configuration) {
  if (!std::all_of(configuration.begin(), configuration.end(),
                   [](double position) { return std::isfinite(position); })) {
    throw Error("configuration", "a position is not finite");
  }
}

// Up to this fraction a motion that starts within the limits stays there; above 1 if it does not
// leave them. What rounding leaves uncertain at the end counts as inside it.
double leaves_limits_at(const RobotModel& robot, std::span<const double> from,
                        std::span<const double> to) {
  double first = std::numeric_limits<double>::infinity();
  for (const Joint& joint : robot.joints()) {
    if (!has_limits(joint)) continue;
    const double start = joint.position(from);
    const double end = joint.position(to);
    const double limit = end > joint.upper ? joint.upper : joint.lower;
    if (joint.lower <= end && end <= joint.upper) continue;
    const double at = (limit - start) / (end - start);
    first = std::min(first, std::clamp(at * (1.0 - 1e-12), 0.0, 1.0));
  }
  return first;
}

}  // namespace

RobotChecker::RobotChecker(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}

const RobotModel& RobotChecker::robot() const {
  return parts_->robot;
}

RobotChecker::Scratch::Scratch(const RobotChecker& checker)
    : memory_(std::make_unique<Memory>(checker.parts_, *checker.parts_->lanes)) {
  require_rounding_to_nearest();
  if (checker.parts_->static_trees) memory_->static_trees.emplace(*checker.parts_->static_trees);
}
RobotChecker::Scratch::~Scratch() = default;
RobotChecker::Scratch::Scratch(Scratch&&) noexcept = default;
RobotChecker::Scratch& RobotChecker::Scratch::operator=(Scratch&&) noexcept = default;

// A scratch keeps what it was made for, so that no later snapshot is at its address.
void RobotChecker::require_own(const Scratch& scratch) const {
  if (!scratch.memory_ || scratch.memory_->owner != parts_) {
    throw Error("scratch", "it was made for another checker");
  }
}

// Numbers that are not finite are refused where that costs nothing: by StaticTrees, and where
// BodyPairs::in_filter_range() has been queried.
bool RobotChecker::check_config(std::span<const double> configuration, Scratch& scratch) const {
  require_own(scratch);
  require_size(parts_->robot, configuration);
  if (parts_->requires_finite()) require_finite(configuration);
  if (parts_->enforces_limits && joint_outside_limits(parts_->robot, configuration) != nullptr)
    return false;
  Scratch::Memory& memory = *scratch.memory_;
  if (parts_->static_trees && parts_->static_trees->touch(configuration, *memory.static_trees))
    return false;
  return is_free_of_itself(configuration, scratch);
}

// Of itself, and of all that is not a static tree.
bool RobotChecker::is_free_of_itself(std::span<const double> configuration,
                                     Scratch& scratch) const {
  if (parts_->pairs.static_tree_pairs_begin() == 0) return true;
  Scratch::Memory& memory = *scratch.memory_;
  if (parts_->pairs.in_filter_range(configuration)) {
    return !parts_->lanes->touches(configuration, memory.lanes, memory.pairs);
  }
  require_finite(configuration);
  parts_->pairs.place(configuration, memory.pairs);
  return !parts_->pairs.any_touches(memory.pairs);
}

void RobotChecker::check_configs(std::span<const double> configurations, Scratch& scratch,
                                 std::span<std::uint8_t> free) const {
  require_own(scratch);
  const std::size_t variables = internal::require_sizes(parts_->robot, configurations, free);
  const auto configuration = [&](std::size_t i) {
    return configurations.subspan(i * variables, variables);
  };
  Scratch::Memory& memory = *scratch.memory_;
  if (parts_->static_trees) {
    parts_->static_trees->find_free(configurations, *memory.static_trees, free);
    if (parts_->pairs.static_tree_pairs_begin() == 0 && !parts_->enforces_limits) return;
  } else {
    if (parts_->requires_finite()) require_finite(configurations);
    std::fill(free.begin(), free.end(), std::uint8_t{1});
  }
  // Those that are free so far wait until the lanes are full.
  constexpr std::size_t kLanes = internal::LaneCheck::kLanes;
  std::array<std::span<const double>, kLanes> waiting;
  std::array<std::size_t, kLanes> index{};
  std::size_t count = 0;
  const auto settle = [&] {
    if (count == 0) return;
    const unsigned contacts =
        parts_->lanes->contacts({waiting.data(), count}, memory.lanes, memory.pairs);
    for (std::size_t i = 0; i < count; ++i) {
      free[index[i]] = (contacts >> i & 1U) == 0 ? std::uint8_t{1} : std::uint8_t{0};
    }
    count = 0;
  };
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i] == 0) continue;
    if (parts_->enforces_limits &&
        joint_outside_limits(parts_->robot, configuration(i)) != nullptr) {
      free[i] = 0;
      continue;
    }
    if (!parts_->pairs.in_filter_range(configuration(i))) {
      free[i] = is_free_of_itself(configuration(i), scratch) ? 1 : 0;
      continue;
    }
    waiting[count] = configuration(i);
    index[count] = i;
    if (++count == kLanes) settle();
  }
  settle();
}

void RobotChecker::check_configs(std::span<const double> configurations,
                                 std::span<Scratch> scratches, std::span<std::uint8_t> free) const {
  const std::size_t variables = internal::require_sizes(parts_->robot, configurations, free);
  for (const Scratch& scratch : scratches) require_own(scratch);
  const internal::Sharing sharing{
      .piece = kPiece,
      .fewest = parts_->pairs.static_tree_pairs_begin() == 0 ? kFewestShared : kPiece + 1};
  internal::share_configurations(
      configurations, variables, sharing, scratches, free,
      [&](std::span<const double> piece, Scratch& scratch, std::span<std::uint8_t> its_answers) {
        check_configs(piece, scratch, its_answers);
      });
}

void RobotChecker::require_end_of_edge(std::span<const double> configuration) const {
  require_size(parts_->robot, configuration);
  if (parts_->pairs.in_filter_range(configuration)) return;
  require_finite(configuration);
  throw Error("edge",
              "a joint's position is beyond " + std::to_string(kLargestPosition) + " in magnitude");
}

std::span<const double> RobotChecker::end_of_motion(std::span<const double> from,
                                                    std::span<const double> to,
                                                    ContinuousMotion continuous,
                                                    std::vector<double>& memory) const {
  require_end_of_edge(from);
  require_end_of_edge(to);
  if (continuous == ContinuousMotion::kAsGiven) return to;
  parts_->shortest.require();
  const std::span<const double> end = parts_->shortest.end_of(from, to, memory);
  require_end_of_edge(end);
  return end;
}

EdgeResult RobotChecker::check_edge(std::span<const double> from, std::span<const double> to,
                                    Scratch& scratch, const EdgeRequest& request) const {
  require_own(scratch);
  to = end_of_motion(from, to, request.continuous, scratch.memory_->motion_end);
  require_resolution(request.resolution);
  if (!parts_->enforces_limits) return check_within_limits(from, to, 1.0, scratch, request);
  if (joint_outside_limits(parts_->robot, from) != nullptr) {
    return {.verdict = Verdict::kCollision, .contact_at = 0.0};
  }
  const double leaves_at = leaves_limits_at(parts_->robot, from, to);
  if (leaves_at > 1.0) return check_within_limits(from, to, 1.0, scratch, request);
  if (!request.first) return {.verdict = Verdict::kCollision, .contact_at = 1.0};
  EdgeResult result = check_within_limits(from, to, leaves_at, scratch, request);
  result.verdict = Verdict::kCollision;
  result.contact_at = std::min(result.contact_at, 1.0);
  return result;
}

// The motion up to the fraction `end`, whatever the limits.
EdgeResult RobotChecker::check_within_limits(std::span<const double> from,
                                             std::span<const double> to, double end,
                                             Scratch& scratch, const EdgeRequest& request) const {
  Scratch::Memory& memory = *scratch.memory_;
  // Against static trees alone, what the last motions have shown often decides the next one.
  if (end == 1.0 && request.max_configurations > 0 && parts_->static_trees &&
      parts_->pairs.static_tree_pairs_begin() == 0) {
    using Finding = internal::StaticTrees::AlongFinding;
    switch (parts_->static_trees->check_along(from, to, !request.first, *memory.static_trees)) {
      case Finding::kFree:
        return {.verdict = Verdict::kFree, .free_until = 1.0, .configurations = 1};
      case Finding::kTouchesInTheMiddle:
        return {.verdict = Verdict::kCollision, .contact_at = 0.5, .configurations = 1};
      case Finding::kUndecided:
        break;
    }
  }
  return parts_->lanes->check_edge(from, to, end, request, memory.lanes, memory.pairs);
}

std::vector<EdgeResult> RobotChecker::check_edges(std::span<const double> from,
                                                  std::span<const double> to,
                                                  std::span<Scratch> scratches,
                                                  const EdgeRequest& request) const {
  const auto variables = static_cast<std::size_t>(parts_->robot.variable_count());
  if (from.size() != to.size() || (variables == 0 ? !from.empty() : from.size() % variables != 0)) {
    throw Error("edges", std::to_string(from.size()) + " numbers for their starts and " +
                             std::to_string(to.size()) + " for their ends, on a robot with " +
                             std::to_string(variables) + " variables");
  }
  if (scratches.empty()) throw Error("edges", "there is no scratch to judge them with");
  for (const Scratch& scratch : scratches) require_own(scratch);
  const std::size_t count = variables == 0 ? 0 : from.size() / variables;
  std::vector<EdgeResult> results(count);
  const std::size_t pieces = (count + kEdgesAPiece - 1) / kEdgesAPiece;
  internal::share_work(pieces, scratches.size(), [&](std::size_t worker, std::size_t piece) {
    const std::size_t last = std::min(count, (piece + 1) * kEdgesAPiece);
    for (std::size_t i = piece * kEdgesAPiece; i < last; ++i) {
      results[i] = check_edge(from.subspan(i * variables, variables),
                              to.subspan(i * variables, variables), scratches[worker], request);
    }
  });
  return results;
}

double RobotChecker::measure_edge(std::span<const double> from, std::span<const double> to,
                                  Scratch& scratch, double resolution,
                                  ContinuousMotion continuous) const {
  const EdgeRequest request{.resolution = resolution, .first = true, .continuous = continuous};
  return check_edge(from, to, scratch, request).free_until;
}

std::vector<double> RobotChecker::configuration_on_edge(std::span<const double> from,
                                                        std::span<const double> to, double fraction,
                                                        ContinuousMotion continuous) const {
  if (!(fraction >= 0.0 && fraction <= 1.0)) {
    throw Error("edge", "the fraction must be from 0 to 1");
  }
  std::vector<double> memory;
  const std::span<const double> end = end_of_motion(from, to, continuous, memory);
  std::vector<double> configuration(from.size());
  internal::take_between(from, end, fraction, configuration);
  return configuration;
}

CheckedBody RobotChecker::body_of(int piece, std::int32_t sphere) const {
  const internal::CheckedPiece& checked = parts_->pairs.pieces()[static_cast<std::size_t>(piece)];
  const Parts::Named& named = parts_->bodies[checked.body];
  const bool is_part = sphere >= 0 && !checked.spheres.empty();
  return {named.kind, named.name, checked.body_tree,
          is_part ? checked.spheres[static_cast<std::size_t>(sphere)] : sphere};
}

CheckedBody RobotChecker::other_of(std::size_t index, std::int32_t sphere) const {
  const internal::CheckedPair& pair = parts_->pairs.pairs()[index];
  if (!pair.is_obstacle) return body_of(pair.other, sphere);
  const Parts::Named& named = parts_->obstacles[static_cast<std::size_t>(pair.other)];
  return {named.kind, named.name, 0, sphere};
}

double RobotChecker::padding_of(std::size_t index) const {
  const internal::CheckedPair& pair = parts_->pairs.pairs()[index];
  const auto& pieces = parts_->pairs.pieces();
  const double first = pieces[static_cast<std::size_t>(pair.piece)].padding;
  if (pair.is_obstacle) return first;
  return sum_up(first, pieces[static_cast<std::size_t>(pair.other)].padding);
}

std::vector<CheckedContact> RobotChecker::explain(std::span<const double> configuration,
                                                  Scratch& scratch,
                                                  const ExplainRequest& request) const {
  require_own(scratch);
  std::vector<CheckedContact> result;
  const auto body = [&](int piece) {
    return parts_->pairs.pieces()[static_cast<std::size_t>(piece)].body;
  };
  // Of a body with another one or an obstacle, by their indices: its place in the result.
  std::map<std::tuple<std::size_t, bool, std::size_t>, std::size_t> places;
  internal::BodyPairs::Scratch& canonical = scratch.memory_->pairs;
  parts_->pairs.place(configuration, canonical);
  for (std::size_t i = 0; i < parts_->pairs.pairs().size(); ++i) {
    const bool touches = parts_->pairs.touches(i, canonical);
    const bool is_proved_free = !touches && parts_->pairs.is_proved_free(i, canonical);
    if (!touches && !(request.proved_free && is_proved_free)) continue;
    const internal::CheckedPair& pair = parts_->pairs.pairs()[i];
    const auto contact = parts_->pairs.deepest_contact(i, canonical);
    if (!contact) continue;
    CheckedContact found{body_of(pair.piece, contact->sphere),
                         other_of(i, contact->other_sphere),
                         contact->overlap_depth,
                         padding_of(i),
                         contact->world_point,
                         is_proved_free};
    const std::size_t other =
        pair.is_obstacle ? static_cast<std::size_t>(pair.other) : body(pair.other);
    const auto [known, is_new] =
        places.try_emplace({body(pair.piece), pair.is_obstacle, other}, result.size());
    if (is_new) {
      result.push_back(std::move(found));
    } else if (CheckedContact& deepest = result[known->second];
               found.overlap_depth > deepest.overlap_depth) {
      deepest = std::move(found);
    }
  }
  std::stable_partition(result.begin(), result.end(),
                        [](const CheckedContact& contact) { return !contact.is_proved_free; });
  if (result.size() > request.max_contacts) result.resize(request.max_contacts);
  return result;
}

bool RobotChecker::within(std::span<const double> configuration, double clearance,
                          Scratch& scratch) const {
  require_own(scratch);
  require_clearance(clearance);
  internal::BodyPairs::Scratch& canonical = scratch.memory_->pairs;
  const internal::BodyPairs& pairs = parts_->pairs;
  pairs.place(configuration, canonical);
  for (std::size_t i = 0; i < pairs.pairs().size(); ++i) {
    if (pairs.is_near(i, clearance, canonical)) return true;
  }
  return false;
}

// The pairs that may be nearest come first; a search ends where its pair cannot be nearer than the
// nearest so far. What is apart under the computed poses is apart by no less than twice the error
// of a pose under those of the exact mechanism, a bound that holds for positions
// in_filter_range() alone.
RobotClearance RobotChecker::clearance(std::span<const double> configuration, Scratch& scratch,
                                       const ClearanceRequest& request) const {
  require_own(scratch);
  internal::BodyPairs::Scratch& canonical = scratch.memory_->pairs;
  const internal::BodyPairs& pairs = parts_->pairs;
  pairs.place(configuration, canonical);
  RobotClearance result;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < pairs.pairs().size(); ++i) {
    if (request.skip_proved_free && pairs.is_proved_free(i, canonical)) {
      result.skipped = true;
    } else {
      order.emplace_back(pairs.gap_bound(i, canonical), i);
    }
  }
  std::sort(order.begin(), order.end());
  for (const auto& [bound, i] : order) {
    if (bound > result.upper) break;
    const DistanceResult found = pairs.distance(i, canonical, {.enough = result.upper});
    result.lower = std::min(result.lower, found.lower);
    if (!(found.upper < result.upper)) continue;
    result.upper = found.upper;
    const internal::CheckedPair& pair = pairs.pairs()[i];
    result.first = body_of(pair.piece, found.nearest.a);
    const bool is_tree =
        !pair.is_obstacle || std::holds_alternative<std::shared_ptr<const SphereTree>>(
                                 pairs.obstacles()[static_cast<std::size_t>(pair.other)].shape);
    result.second = other_of(i, is_tree ? found.nearest.b : -1);
  }
  if (std::isfinite(result.lower)) {
    result.lower = pairs.in_filter_range(configuration)
                       ? std::max(0.0, sub_down(result.lower, 2.0 * pairs.pose_error()))
                       : 0.0;
  }
  return result;
}

}  // namespace spherule
