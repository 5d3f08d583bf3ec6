// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/false_alarms.h"

#include "robot/cover/internal/alarm_counts.h"
#include "robot/cover/internal/binomial_bound.h"
#include "robot/model/internal/shared_work.h"
#include "spheretree/error.h"

#include <utility>

namespace spherule {
namespace {

FalseAlarms measure(const RobotModel& robot, std::span<const LinkBody> bodies,
                    const AllowedCollisions& allowed, const LinkPairs* proofs,
                    std::vector<double> postures, const FalseAlarmOptions& options) {
  const internal::LinkTrees trees = internal::trees_of(robot);
  const internal::AlarmJudge judge(robot, bodies, allowed, proofs, [&](int link) {
    return !trees[static_cast<std::size_t>(link)].empty();
  });
  const internal::AlarmSample sample(judge, trees, std::move(postures),
                                     internal::thread_count(options.threads), [&](double share) {
                                       if (options.progress) options.progress(share, "postures");
                                     });
  return internal::count_alarms(judge, sample, trees, options);
}

}  // namespace

std::string_view name_of(PairProofs proofs) {
  switch (proofs) {
    case PairProofs::kNever:
      return "never";
    case PairProofs::kBoxes:
      return "boxes";
    case PairProofs::kNone:
      break;
  }
  return "none";
}

double RefusedShare::share() const {
  return free == 0 ? 0.0 : static_cast<double>(refused) / static_cast<double>(free);
}

double RefusedShare::upper_bound(double confidence) const {
  return internal::share_upper_bound(refused, free, confidence);
}

FalseAlarms measure_false_alarms(const RobotModel& robot, std::span<const LinkBody> bodies,
                                 const AllowedCollisions& allowed, const LinkPairs* proofs,
                                 const FalseAlarmOptions& options) {
  if (options.postures == 0) throw Error("postures", "there are none");
  return measure(robot, bodies, allowed, proofs,
                 internal::draw_postures(robot, options.postures, options.seed), options);
}

FalseAlarms measure_false_alarms(const RobotModel& robot, std::span<const LinkBody> bodies,
                                 const AllowedCollisions& allowed, const LinkPairs* proofs,
                                 std::span<const double> postures,
                                 const FalseAlarmOptions& options) {
  return measure(robot, bodies, allowed, proofs, {postures.begin(), postures.end()}, options);
}

}  // namespace spherule
