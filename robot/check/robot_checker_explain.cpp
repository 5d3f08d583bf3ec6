// SPDX-License-Identifier: BSD-3-Clause
#include "collide/within.h"
#include "robot/check/internal/checker_parts.h"
#include "robot/check/robot_checker.h"
#include "robot/model/kinematics.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule {

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
