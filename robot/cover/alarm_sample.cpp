// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/alarm_sample.h"

#include "base/error.h"
#include "base/threads.h"
#include "collide/collide.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/link_pieces.h"
#include "robot/pairs/proof_scope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// Postures that a thread judges at once.
constexpr std::size_t kPiece = 256;
constexpr double kLeastGap = 1e-6;
// No gap of links is beyond that, in metres.
constexpr double kMostGap = 1e6;

using Trees = std::span<const std::shared_ptr<const SphereTree>>;

bool overlap(Trees first, const Pose& world_from_first, Trees second,
             const Pose& world_from_second) {
  for (const auto& a : first) {
    for (const auto& b : second) {
      if (collides(*a, world_from_first, *b, world_from_second)) return true;
    }
  }
  return false;
}

const Pose& pose_of(std::span<const Pose> poses, int link) {
  return poses[static_cast<std::size_t>(link)];
}

std::size_t piece_count(std::size_t count) {
  return (count + kPiece - 1) / kPiece;
}

}  // namespace

AlarmJudge::AlarmJudge(const RobotModel& robot, std::span<const LinkBody> bodies,
                       const AllowedCollisions& allowed, const LinkPairs* proofs,
                       const std::function<bool(int)>& has_spheres)
    : robot_(robot), proofs_(proofs), bodies_(bodies_by_link(robot, bodies)) {
  const int count = static_cast<int>(robot.links().size());
  if (proofs != nullptr) {
    require_proofs_of(*proofs, robot);
    if (proofs->bodies() != bodies_fingerprint(bodies)) {
      throw Error("proofs of pairs", "they are of other bodies");
    }
  }
  for (int first = 0; first < count; ++first) {
    for (int second = first + 1; second < count; ++second) {
      if (!has_spheres(first) || !has_spheres(second) || allowed.allows(first, second)) continue;
      for (const int link : {first, second}) {
        if (!bodies_[static_cast<std::size_t>(link)].empty()) continue;
        throw Error("link " + robot.links()[static_cast<std::size_t>(link)].name,
                    "has spheres and no body: what is a false alarm is not known");
      }
      pairs_.push_back({first, second});
    }
  }
  leave_out_always_touching();
}

void AlarmJudge::leave_out_always_touching() {
  const auto width = static_cast<std::size_t>(robot_.variable_count());
  const std::vector<double> postures = draw_postures(robot_, FalseAlarms::kAlwaysPostures, 1);
  std::vector<TestedPair> left = pairs_;
  std::vector<Pose> poses;
  for (std::size_t at = 0; at < postures.size() && !left.empty(); at += width) {
    forward_kinematics(robot_, std::span(postures).subspan(at, width), poses);
    std::erase_if(left, [&](const TestedPair& pair) { return !touches(pair, poses, 0.0); });
  }
  for (const TestedPair& pair : left) {
    always_touching_.emplace_back(pair.first, pair.second);
    std::erase_if(pairs_, [&](const TestedPair& one) {
      return one.first == pair.first && one.second == pair.second;
    });
  }
}

bool AlarmJudge::touches(const TestedPair& pair, std::span<const Pose> poses,
                         double clearance) const {
  return internal::touches(
      bodies_[static_cast<std::size_t>(pair.first)], pose_of(poses, pair.first),
      bodies_[static_cast<std::size_t>(pair.second)], pose_of(poses, pair.second), clearance);
}

bool AlarmJudge::is_spared(const TestedPair& pair, PairProofs with,
                           std::span<const double> posture) const {
  if (proofs_ == nullptr || with == PairProofs::kNone) return false;
  const LinkPair* const proof = proofs_->find(pair.first, pair.second);
  if (proof == nullptr) return false;
  return with == PairProofs::kNever ? proof->verdict == PairVerdict::kNever
                                    : proof->boxes.contains(posture);
}

AlarmSample::AlarmSample(const AlarmJudge& judge, const LinkTrees& trees,
                         std::vector<double> postures, std::size_t threads,
                         const std::function<void(double)>& progress)
    : judge_(judge),
      postures_(std::move(postures)),
      width_(static_cast<std::size_t>(judge.robot().variable_count())),
      posture_count_(width_ == 0 ? 0 : postures_.size() / width_),
      threads_(threads) {
  if (posture_count_ == 0 || posture_count_ * width_ != postures_.size()) {
    throw Error("postures", std::to_string(postures_.size()) +
                                " numbers are no configurations of " + std::to_string(width_));
  }
  std::vector<std::uint8_t> is_free(posture_count_);
  const std::size_t pieces = piece_count(posture_count_);
  std::size_t done = 0;
  std::mutex mutex;
  share_work(pieces, threads_, [&](std::size_t, std::size_t piece) {
    std::vector<Pose> world;
    const std::size_t end = std::min((piece + 1) * kPiece, posture_count_);
    for (std::size_t i = piece * kPiece; i < end; ++i) {
      forward_kinematics(judge_.robot(), posture(i), world);
      is_free[i] =
          std::none_of(judge_.pairs().begin(), judge_.pairs().end(), [&](const TestedPair& pair) {
            return overlap(trees[static_cast<std::size_t>(pair.first)], pose_of(world, pair.first),
                           trees[static_cast<std::size_t>(pair.second)],
                           pose_of(world, pair.second)) &&
                   !judge_.is_spared(pair, PairProofs::kBoxes, posture(i)) &&
                   judge_.touches(pair, world, 0.0);
          });
    }
    if (!progress) return;
    const std::lock_guard lock(mutex);
    progress(static_cast<double>(++done) / static_cast<double>(pieces));
  });
  for (std::size_t i = 0; i < posture_count_; ++i) {
    if (is_free[i] != 0) free_.push_back(i);
  }
  place_free_postures();
}

void AlarmSample::place_free_postures() {
  std::vector<int> links;
  for (const TestedPair& pair : judge_.pairs()) {
    for (const int link : {pair.first, pair.second}) {
      if (std::find(links.begin(), links.end(), link) == links.end()) links.push_back(link);
    }
  }
  slot_count_ = links.size();
  slot_of_.resize(judge_.robot().links().size());
  for (std::size_t slot = 0; slot < slot_count_; ++slot) {
    slot_of_[static_cast<std::size_t>(links[slot])] = slot;
  }
  poses_.resize(free_.size() * slot_count_);
  share_work(piece_count(free_.size()), threads_, [&](std::size_t, std::size_t piece) {
    std::vector<Pose> world;
    const std::size_t end = std::min((piece + 1) * kPiece, free_.size());
    for (std::size_t i = piece * kPiece; i < end; ++i) {
      forward_kinematics(judge_.robot(), posture(free_[i]), world);
      for (std::size_t slot = 0; slot < slot_count_; ++slot) {
        poses_[i * slot_count_ + slot] = pose_of(world, links[slot]);
      }
    }
  });
}

PostureSet AlarmSample::open(std::size_t pair, PairProofs with) const {
  PostureSet result(free_.size());
  const TestedPair& tested = judge_.pairs()[pair];
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (!judge_.is_spared(tested, with, posture(free_[i]))) result.insert(i);
  }
  return result;
}

PostureSet AlarmSample::overlaps(std::size_t pair, Trees first, Trees second,
                                 const PostureSet& among) const {
  PostureSet result(free_.size());
  const TestedPair& tested = judge_.pairs()[pair];
  constexpr std::size_t kWords = kPiece / PostureSet::kWordBits;
  const std::size_t pieces = (among.word_count() + kWords - 1) / kWords;
  share_work(pieces, threads_, [&](std::size_t, std::size_t piece) {
    const std::size_t end = std::min((piece + 1) * kWords, among.word_count());
    for (std::size_t word = piece * kWords; word < end; ++word) {
      among.for_each_in_word(word, [&](std::size_t i) {
        if (overlap(first, pose(i, tested.first), second, pose(i, tested.second))) result.insert(i);
      });
    }
  });
  return result;
}

double AlarmSample::gap(std::size_t pair, std::size_t free) const {
  std::vector<Pose> world;
  forward_kinematics(judge_.robot(), posture(free_[free]), world);
  const auto comes_within = [&](double clearance) {
    return judge_.touches(judge_.pairs()[pair], world, clearance);
  };
  double low = 0.0;
  double high = 1e-3;
  while (high < kMostGap && !comes_within(high)) {
    low = high;
    high *= 2.0;
  }
  while (high - low > 0.1 * high && high > kLeastGap) {
    const double middle = 0.5 * (low + high);
    (comes_within(middle) ? high : low) = middle;
  }
  return high;
}

void draw_configuration(const RobotModel& robot, std::mt19937_64& bits,
                        std::span<double> configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const auto joint = static_cast<std::size_t>(robot.variable_joints()[i]);
    const double lower = robot.joints()[joint].lower;
    const double part = static_cast<double>(bits() >> 11) * 0x1p-53;
    configuration[i] = lower + (robot.joints()[joint].upper - lower) * part;
  }
}

std::vector<double> draw_postures(const RobotModel& robot, std::size_t count, std::uint64_t seed) {
  require_limits(robot);
  const auto width = static_cast<std::size_t>(robot.variable_count());
  std::vector<double> result(count * width);
  std::mt19937_64 bits(seed);
  for (std::size_t i = 0; i < count; ++i) {
    draw_configuration(robot, bits, std::span(result).subspan(i * width, width));
  }
  return result;
}

LinkTrees trees_of(const RobotModel& robot) {
  LinkTrees result;
  for (const Link& link : robot.links()) result.push_back(link.trees);
  return result;
}

namespace {

double median_gap(const AlarmSample& sample, std::size_t pair, const PostureSet& alarms,
                  const FalseAlarmOptions& options) {
  std::vector<std::size_t> postures;
  alarms.for_each([&](std::size_t i) {
    if (postures.size() < options.gaps) postures.push_back(i);
  });
  if (postures.empty()) return PairAlarms{}.median_gap;
  std::vector<double> gaps(postures.size());
  share_work(gaps.size(), thread_count(options.threads),
             [&](std::size_t, std::size_t i) { gaps[i] = sample.gap(pair, postures[i]); });
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

void sort_pairs(std::vector<PairAlarms>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const PairAlarms& a, const PairAlarms& b) {
    return std::tuple(b.refused, a.first, a.second) < std::tuple(a.refused, b.first, b.second);
  });
}

}  // namespace

void add(const FalseAlarms& other, FalseAlarms& sum) {
  sum.postures += other.postures;
  sum.free += other.free;
  sum.always_touching = other.always_touching;
  for (std::size_t i = 0; i < sum.refused.size(); ++i) sum.refused[i] += other.refused[i];
  for (const PairAlarms& pair : other.pairs) {
    const auto known = std::find_if(sum.pairs.begin(), sum.pairs.end(), [&](const PairAlarms& one) {
      return one.first == pair.first && one.second == pair.second;
    });
    if (known == sum.pairs.end()) {
      sum.pairs.push_back(pair);
      continue;
    }
    known->refused += pair.refused;
    known->refused_alone += pair.refused_alone;
  }
  sort_pairs(sum.pairs);
}

FalseAlarms count_alarms(const AlarmJudge& judge, const AlarmSample& sample, const LinkTrees& trees,
                         const FalseAlarmOptions& options) {
  FalseAlarms result{.postures = sample.postures(),
                     .free = sample.free(),
                     .proofs = options.proofs,
                     .always_touching = judge.always_touching()};
  std::array<PostureSet, 3> refused;
  refused.fill(PostureSet(sample.free()));
  PostureSet once(sample.free());  // by the proofs that blame pairs
  std::vector<PostureSet> alarms;
  PostureSet seen(sample.free());
  for (std::size_t pair = 0; pair < judge.pairs().size(); ++pair) {
    const TestedPair& tested = judge.pairs()[pair];
    const PostureSet all = sample.overlaps(pair, trees[static_cast<std::size_t>(tested.first)],
                                           trees[static_cast<std::size_t>(tested.second)],
                                           sample.open(pair, PairProofs::kNone));
    for (const PairProofs with : {PairProofs::kNone, PairProofs::kNever, PairProofs::kBoxes}) {
      PostureSet open = sample.open(pair, with);
      open &= all;
      refused[static_cast<std::size_t>(with)] |= open;
      if (with != options.proofs) continue;
      PostureSet again = open;
      again &= seen;
      once |= open;
      once -= again;
      seen |= open;
      alarms.push_back(std::move(open));
    }
  }
  for (std::size_t i = 0; i < refused.size(); ++i) result.refused[i] = refused[i].size();
  for (std::size_t pair = 0; pair < alarms.size(); ++pair) {
    const std::size_t count = alarms[pair].size();
    if (count == 0) continue;
    const double gap = median_gap(sample, pair, alarms[pair], options);
    alarms[pair] &= once;
    result.pairs.push_back(
        {judge.pairs()[pair].first, judge.pairs()[pair].second, count, alarms[pair].size(), gap});
  }
  sort_pairs(result.pairs);
  return result;
}

namespace {

constexpr int kHalvings = 60;

// Of at most `hits` hits, by the logarithms of the terms: no term of a large sample underflows.
double probability_of_so_few(std::size_t hits, std::size_t trials, double share) {
  const double odds = std::log(share) - std::log1p(-share);
  double term = static_cast<double>(trials) * std::log1p(-share);
  double sum = std::exp(term);
  for (std::size_t i = 0; i < hits; ++i) {
    term += odds + std::log(static_cast<double>(trials - i) / static_cast<double>(i + 1));
    sum += std::exp(term);
  }
  return sum;
}

}  // namespace

double share_upper_bound(std::size_t hits, std::size_t trials, double confidence) {
  if (hits >= trials) return 1.0;
  double low = 0.0;
  double high = 1.0;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (probability_of_so_few(hits, trials, middle) > 1.0 - confidence ? low : high) = middle;
  }
  return high;
}

}  // namespace spherule::internal
