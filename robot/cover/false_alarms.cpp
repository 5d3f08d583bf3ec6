// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/false_alarms.h"

#include "base/error.h"
#include "base/threads.h"
#include "robot/cover/alarm_sample.h"
#include "robot/cover/goal_cover.h"
#include "robot/cover/robot_spheres.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string_view>
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
  constexpr std::array<std::string_view, 3> kNames = {"none", "never", "boxes"};
  static_assert(kNames.size() == static_cast<std::size_t>(PairProofs::kBoxes) + 1);
  return kNames[static_cast<std::size_t>(proofs)];
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

namespace {

// The robot with the geometry of these links alone.
RobotDescription with_geometry_of(const RobotDescription& robot, const std::set<int>& links) {
  RobotDescription result = robot;
  for (std::size_t i = 0; i < result.links.size(); ++i) {
    if (links.contains(static_cast<int>(i))) continue;
    result.links[i].collision.clear();
    result.links[i].visual.clear();
  }
  return result;
}

// Covers links at some E and keeps what it has covered.
class Covers {
 public:
  Covers(const RobotDescription& robot, const RobotCoverOptions& options)
      : robot_(robot), options_(options) {}

  // Each link once.
  std::vector<std::shared_ptr<const SphereTree>> operator()(std::span<const LinkError> errors) {
    std::map<int, double> wanted;
    for (const LinkError& error : errors) {
      if (!known_.contains({error.link, error.max_error})) wanted[error.link] = error.max_error;
    }
    if (!wanted.empty()) cover(wanted);
    std::vector<std::shared_ptr<const SphereTree>> result;
    for (const LinkError& error : errors) {
      result.push_back(
          std::make_shared<const SphereTree>(build_tree(of(error.link, error.max_error).spheres)));
    }
    return result;
  }

  const LinkCover& of(int link, double max_error) const { return known_.at({link, max_error}); }

 private:
  void cover(const std::map<int, double>& errors) {
    RobotCoverOptions options = options_;
    std::map<std::string, LinkCoverOptions> links;
    std::set<int> indices;
    for (const auto& [link, max_error] : errors) {
      const std::string& name = robot_.links[static_cast<std::size_t>(link)].name;
      if (options.links.contains(name)) links[name] = options.links[name];
      links[name].max_error = max_error;
      indices.insert(link);
    }
    options.links = links;
    RobotCover cover = cover_robot(with_geometry_of(robot_, indices), options);
    for (const auto& [link, max_error] : errors) {
      known_[{link, max_error}] = std::move(cover.links[static_cast<std::size_t>(link)]);
    }
  }

  const RobotDescription& robot_;
  const RobotCoverOptions options_;
  std::map<std::pair<int, double>, LinkCover> known_;
};

}  // namespace

std::vector<LinkBody> covered_bodies(const RobotDescription& robot,
                                     const RobotCoverOptions& options) {
  std::vector<LinkBody> result;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const auto own = options.links.find(robot.links[i].name);
    const double padding = own == options.links.end()
                               ? options.padding
                               : own->second.padding.value_or(options.padding);
    auto body = link_body(robot, static_cast<int>(i),
                          {.geometry = options.geometry, .weld = options.weld}, padding);
    if (body) result.push_back(std::move(*body));
  }
  return result;
}

GoalCover cover_robot_to_goal(const RobotDescription& robot, std::span<const LinkBody> bodies,
                              std::span<const DisabledPair> disabled, const LinkPairs* proofs,
                              const RobotCoverOptions& options, const LinkErrorOptions& goal) {
  LinkErrorOptions choice_options = goal;
  RobotCoverOptions first_options = options;
  first_options.effort = 0;
  first_options.seconds = 0.0;
  Covers first(robot, first_options);
  Covers last(robot, options);
  const bool is_same = options.effort == 0;

  // Which links have spheres is known before any cover: those with bodies.
  RobotModel model = robot.model;
  const auto placeholder = std::make_shared<const SphereTree>(
      build_tree(std::vector{Sphere{Eigen::Vector3d::Zero(), 1.0}}));
  for (const LinkBody& body : bodies) {
    const LinkDescription& link = robot.links[static_cast<std::size_t>(body.link)];
    model.attach(link.name, placeholder);
    const auto own = options.links.find(link.name);
    if (own == options.links.end() || !own->second.max_error) continue;
    choice_options.fixed.push_back({body.link, *own->second.max_error});
  }
  AllowedCollisions allowed(model);
  allowed.allow(disabled);

  GoalCover result;
  result.choice = choose_link_errors(
      robot.model, bodies, allowed, proofs,
      [&](std::span<const LinkError> errors) { return first(errors); },
      is_same ? CoverLinks()
              : CoverLinks([&](std::span<const LinkError> errors) { return last(errors); }),
      choice_options);
  result.cover = {.robot = robot.name, .links = {}, .options = options};
  result.cover.options.max_error = goal.coarsest_error;
  for (const LinkDescription& link : robot.links) result.cover.links.push_back({.link = link.name});
  for (const ChosenError& chosen : result.choice.links) {
    result.cover.links[static_cast<std::size_t>(chosen.link)] =
        (is_same ? first : last).of(chosen.link, chosen.max_error);
  }
  return result;
}

}  // namespace spherule
