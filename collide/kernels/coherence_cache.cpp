// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/coherence_cache.h"

#include "collide/search/packed_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

double length(const double* v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

MovedSphere::MovedSphere(const KernelFrame* frames, std::size_t count, double error)
    : frames_(frames), error_(error), joints_(count) {}

void MovedSphere::place(std::int32_t frame, const double* center, double radius,
                        const KernelPose* poses, const double* configuration) {
  const auto& at = poses[frame].columns;
  double c[3];
  for (int i = 0; i < 3; ++i) {
    c[i] = at[0][i] * center[0] + at[1][i] * center[1] + at[2][i] * center[2] + at[3][i];
  }
  radius_ = radius;
  count_ = 0;
  double farthest = 0.0;
  for (std::int32_t f = frame; f >= 0; f = frames_[f].parent) {
    const KernelFrame& of = frames_[f];
    const auto& axis = poses[f].columns[2];
    const auto& origin = poses[f].columns[3];
    const double from[3] = {c[0] - origin[0], c[1] - origin[1], c[2] - origin[2]};
    Joint& joint = joints_[count_++];
    joint.variable = of.variable;
    joint.prismatic = of.prismatic;
    joint.at = configuration[of.variable];
    joint.reach = length(from) + radius;
    farthest = std::max(farthest, joint.reach);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      joint.turn_rate[i] = of.prismatic ? 0.0 : axis[i];
      joint.center_rate[i] = of.prismatic ? axis[i] : axis[j] * from[k] - axis[k] * from[j];
    }
  }
  room_ = kRoom * farthest;
  for (std::size_t i = 0; i < count_; ++i) {
    joints_[i].reach = joints_[i].prismatic ? 1.0 : joints_[i].reach + room_;
  }
}

double MovedSphere::way_to(const double* configuration) const {
  return way({configuration});
}

double MovedSphere::way_along(const double* from, const double* to) const {
  return way({from, to});
}

template <std::size_t kEnds>
double MovedSphere::way(const double* const (&ends)[kEnds]) const {
  double moved[kEnds][3] = {};
  double turned[kEnds][3] = {};
  double changes = 0.0;
  double ways = 0.0;  // sum of |D_k| L_k
  double second = 0.0;
  for (std::size_t n = 0; n < count_; ++n) {
    const Joint& joint = joints_[n];
    double size = 0.0;
    for (std::size_t end = 0; end < kEnds; ++end) {
      const double change = ends[end][joint.variable] - joint.at;
      for (int i = 0; i < 3; ++i) {
        moved[end][i] += change * joint.center_rate[i];
        turned[end][i] += change * joint.turn_rate[i];
      }
      size = std::max(size, std::abs(change));
    }
    // From the tip: a rotation intersects the ways of itself, half, and of all beyond it.
    const double way = size * joint.reach;
    if (!joint.prismatic) second += size * (0.5 * way + ways);
    ways += way;
    changes += size;
  }
  if (count_ == 0 || !(ways <= room_)) return std::numeric_limits<double>::infinity();
  double first = 0.0;
  for (std::size_t end = 0; end < kEnds; ++end) {
    first = std::max(first, length(moved[end]) + length(turned[end]) * radius_);
  }
  return (first + second) * (1.0 + kRelative) + changes * error_;
}

namespace {

// A configuration is near the one before if no point has moved by more than this part of how far
// the bodies reach.
constexpr double kNearStep = 0.125;
// What clearance is searched for: a bit more than the last one that was found, twice as much where
// that was for few steps; after a test that fails less, as long as it lasts for some steps.
constexpr double kMostSteps = 1024.0;
constexpr double kFewestSteps = 2.0;
constexpr double kFirstSteps = 8.0;
constexpr double kMore = 1.25;
constexpr float kLess = 0.5F;
constexpr int kMostTests = 2;

// What a query saves by the cache, in searches of a configuration, measured roughly: if that alone
// answers; if bodies that are grown are apart; if they are searched as they are after all; if
// nothing was tried. Where the cache has cost more than it saved by kMostLost, it pauses.
constexpr double kFromMemory = 0.75;
constexpr double kGrown = -0.5;
constexpr double kGrownInVain = -1.5;
constexpr double kNotTried = -0.5;
constexpr double kMostLost = 8.0;
constexpr double kFirstPause = 64.0;
constexpr double kLongestPause = 4096.0;

// The way starts anew beyond 2^10 near steps: every addition errs by less than 2^-42 near steps,
// which kStepRest, a part of every step, covers. So do the sums that it is compared with.
constexpr double kStepUp = 1.0 + 1e-9;
constexpr double kStepRest = 0x1p-38;
constexpr double kLongestWay = 1024.0;

// Bodies are grown by what is rounded to single precision: by at least this part of it.
constexpr double kInflationDown = 1.0 - 0x1p-18;

// Of any point of a body from a joint that carries it, at most, summed up for each variable.
std::vector<double> reaches(const KernelProblem& problem) {
  std::vector<double> of_frame(static_cast<std::size_t>(problem.frame_count), 0.0);
  for (std::int32_t i = 0; i < problem.body_count; ++i) {
    const KernelBody& body = problem.bodies[i];
    double distance = length(body.center) + static_cast<double>(body.radius);
    for (std::int32_t f = body.frame; f >= 0; f = problem.frames[f].parent) {
      const KernelFrame& frame = problem.frames[f];
      double& reach = of_frame[static_cast<std::size_t>(f)];
      reach = std::max(reach, frame.prismatic ? 1.0 : distance);
      distance += length(frame.origin) + (frame.prismatic ? kLargestPosition : 0.0);
    }
  }
  std::vector<double> result(static_cast<std::size_t>(problem.variable_count), 0.0);
  for (std::int32_t f = 0; f < problem.frame_count; ++f) {
    result[static_cast<std::size_t>(problem.frames[f].variable)] +=
        of_frame[static_cast<std::size_t>(f)] * kStepUp;
  }
  return result;
}

double largest(std::span<const double> numbers) {
  return numbers.empty() ? 0.0 : *std::max_element(numbers.begin(), numbers.end());
}

bool never(void*, std::int32_t, KernelPair, std::int32_t, std::int32_t) {
  return false;
}

}  // namespace

CoherenceCache::CoherenceCache(const KernelProblem& problem, std::span<const double> reach,
                               std::span<const double> tilt)
    : reach_(reaches(problem)),
      near_step_(kNearStep * largest(reach)),
      last_(reach_.size(), 1e300),
      next_pause_(kFirstPause),
      contact_(problem.frames, static_cast<std::size_t>(problem.frame_count),
               4.0 * largest(tilt) * std::max(1.0, largest(reach))),
      is_due_(static_cast<std::size_t>(problem.body_count), 0) {
  bodies_.assign(static_cast<std::size_t>(problem.body_count), Body{.sphere = contact_});
  due_.reserve(bodies_.size());
  pairs_.reserve(static_cast<std::size_t>(problem.pair_count));
}

bool CoherenceCache::check(const Kernels& kernels, const KernelProblem& problem,
                           const double* configuration, const KernelScratch& scratch,
                           ConfirmContact confirm, void* context) {
  struct WhileConfirming {
    explicit WhileConfirming(bool& flag) : is_confirming(flag) { is_confirming = true; }
    ~WhileConfirming() { is_confirming = false; }
    bool& is_confirming;
  };
  const WhileConfirming guard(is_confirming_);
  return kernels.check(problem, configuration, scratch, confirm, context);
}

// Whether the configuration is near the one before, as that was near its own.
bool CoherenceCache::follow(const double* configuration) {
  double step = kStepRest * near_step_;
  for (std::size_t i = 0; i < last_.size(); ++i) {
    step += std::abs(configuration[i] - last_[i]) * reach_[i];
    last_[i] = configuration[i];
  }
  const bool was_near = was_near_;
  was_near_ = step <= near_step_;
  is_following_ = was_near_ && was_near;
  way_ = knows_ ? way_ + step : 0.0;
  queries_ += 1.0;
  if (knows_ && (!is_following_ || way_ > kLongestWay * near_step_)) forget();
  return is_following_;
}

void CoherenceCache::forget() {
  for (Body& body : bodies_) body.forget();
  depth_ = -1.0;
  way_ = 0.0;
  queries_ = 0.0;
  knows_ = false;
}

// Books what a query has saved.
void CoherenceCache::account(double saved) {
  saved_ = std::min(saved_ + saved, kMostLost);
  if (saved_ >= kMostLost) next_pause_ = kFirstPause;
  if (saved_ > -kMostLost) return;
  forget();
  saved_ = 0.0;
  pause_ = next_pause_;
  next_pause_ = std::min(2.0 * next_pause_, kLongestPause);
}

// Lists the bodies that may have moved by more than their clearance; false if there are none.
bool CoherenceCache::find_due(const double* configuration) {
  due_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (way_ <= body.free_until) continue;
    body.wanted = 0.0F;
    if (body.placed_at >= 0.0) {
      const double moved = body.sphere.way_to(configuration);
      if (moved <= body.clearance) {
        body.free_until = way_ + (body.clearance - moved);
        continue;
      }
      body.step = moved / (queries_ - body.placed_at);
      if (body.ambition <= 0.0) body.ambition = kFirstSteps * body.step;
      const double wanted = std::min({body.ambition, kMostSteps * body.step, near_step_});
      if (wanted >= kFewestSteps * body.step) body.wanted = static_cast<float>(wanted);
    }
    due_.push_back(static_cast<std::int32_t>(i));
  }
  return !due_.empty();
}

// Puts the mechanism in its place and looks which bodies that are due are apart when grown; those
// are due no more. True if one touches for sure.
bool CoherenceCache::grow_due(const Kernels& kernels, const KernelProblem& problem,
                              const double* configuration, const KernelScratch& scratch) {
  kernels.place(problem, configuration, scratch);
  std::size_t left = 0;
  for (const std::int32_t index : due_) {
    Body& body = bodies_[static_cast<std::size_t>(index)];
    KernelFinding finding = KernelFinding::kNear;
    const float few = static_cast<float>(kFewestSteps * body.step);
    int tests = 0;
    for (float inflation = body.wanted; inflation > 0.0F; inflation *= kLess) {
      if (inflation < few || tests == kMostTests) break;
      finding = test(kernels, problem, index, inflation, scratch);
      ++tests;
      if (finding == KernelFinding::kTouch) return true;
      if (finding == KernelFinding::kNear) continue;
      place(problem, index, configuration, scratch,
            static_cast<double>(inflation) * kInflationDown);
      body.ambition =
          tests == 1 ? static_cast<double>(inflation) * kMore : static_cast<double>(inflation);
      break;
    }
    if (finding == KernelFinding::kApart) continue;
    if (tests > 0) body.ambition = static_cast<double>(kLess * body.wanted);
    if (tests == 0) body.ambition = kFirstSteps * body.step;
    due_[left++] = index;
  }
  due_.resize(left);
  return false;
}

std::optional<bool> CoherenceCache::is_free_along(const Kernels& kernels,
                                                  const KernelProblem& problem, const double* from,
                                                  const double* to, const double* middle,
                                                  const KernelScratch& scratch) {
  if (!follow(middle)) return std::nullopt;
  // From the middle to either end.
  double half = kStepRest * near_step_;
  for (std::size_t i = 0; i < last_.size(); ++i) {
    half += std::max(std::abs(from[i] - middle[i]), std::abs(to[i] - middle[i])) * reach_[i];
  }
  if (!(half <= near_step_)) return std::nullopt;
  bool is_placed = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    if (way_ + half <= body.free_until) continue;
    if (body.placed_at >= 0.0 && body.sphere.way_along(from, to) <= body.clearance) continue;
    if (!std::exchange(is_placed, true)) kernels.place(problem, middle, scratch);
    if (!grow_along(kernels, problem, static_cast<std::int32_t>(i), from, to, middle, scratch)) {
      return false;
    }
  }
  return true;
}

// Whether the body is apart, grown by what it moves from the middle or, to know more for the next
// motions, by more.
bool CoherenceCache::grow_along(const Kernels& kernels, const KernelProblem& problem,
                                std::int32_t index, const double* from, const double* to,
                                const double* middle, const KernelScratch& scratch) {
  Body& body = bodies_[static_cast<std::size_t>(index)];
  place(problem, index, middle, scratch, 0.0);
  const double moved = body.sphere.way_along(from, to) + kStepRest * near_step_;
  if (!(moved <= near_step_)) return false;
  const double needed = moved * (1.0 + 1e-5);  // above what kInflationDown takes
  const double wanted = std::clamp(body.ambition, needed, std::max(needed, near_step_));
  for (const double inflation : {wanted, needed}) {
    if (test(kernels, problem, index, static_cast<float>(inflation), scratch) ==
        KernelFinding::kApart) {
      place(problem, index, middle, scratch, inflation * kInflationDown);
      const bool is_more = inflation > needed;
      body.ambition = is_more ? kMore * inflation : wanted > needed ? needed : kFirstSteps * needed;
      return true;
    }
    if (inflation <= needed) break;
  }
  body.forget();
  return false;
}

KernelFinding CoherenceCache::test(const Kernels& kernels, const KernelProblem& problem,
                                   std::int32_t body, float inflation,
                                   const KernelScratch& scratch) {
  for (std::int32_t i = 0; i < problem.pair_count; ++i) {
    if (problem.pairs[i].body != body) continue;
    const KernelFinding finding =
        kernels.test(problem, problem.pairs[i], inflation, scratch, &never, nullptr);
    if (finding != KernelFinding::kApart) return finding;
  }
  return KernelFinding::kApart;
}

void CoherenceCache::place(const KernelProblem& problem, std::int32_t index,
                           const double* configuration, const KernelScratch& scratch,
                           double clearance) {
  const KernelBody& of = problem.bodies[index];
  Body& body = bodies_[static_cast<std::size_t>(index)];
  body.sphere.place(of.frame, of.center, static_cast<double>(of.radius), scratch.poses,
                    configuration);
  body.clearance = clearance - kStepRest * near_step_;
  body.free_until = way_ + body.clearance;
  body.placed_at = queries_;
  knows_ = true;
}

bool CoherenceCache::collides(const Kernels& kernels, const KernelProblem& problem,
                              const double* configuration, const KernelScratch& scratch,
                              ConfirmContact confirm, void* context) {
  if (pause_ > 0.0) {
    pause_ -= 1.0;
    is_following_ = was_near_ = false;
    return check(kernels, problem, configuration, scratch, confirm, context);
  }
  if (!follow(configuration)) {
    return check(kernels, problem, configuration, scratch, confirm, context);
  }
  if (depth_ >= 0.0 && contact_.way_to(configuration) <= depth_) {
    account(kFromMemory);
    return true;
  }
  depth_ = -1.0;
  if (!find_due(configuration)) {
    account(kFromMemory);
    return false;
  }
  const bool grows = std::any_of(due_.begin(), due_.end(), [&](std::int32_t i) {
    return bodies_[static_cast<std::size_t>(i)].wanted > 0.0F;
  });
  if (grows && grow_due(kernels, problem, configuration, scratch)) {
    account(kGrown);
    return true;
  }
  if (due_.empty()) {
    account(kGrown);
    return false;
  }
  pairs_.clear();
  for (const std::int32_t index : due_) is_due_[static_cast<std::size_t>(index)] = 1;
  for (std::int32_t i = 0; i < problem.pair_count; ++i) {
    if (is_due_[static_cast<std::size_t>(problem.pairs[i].body)] != 0) {
      pairs_.push_back(problem.pairs[i]);
    }
  }
  for (const std::int32_t index : due_) is_due_[static_cast<std::size_t>(index)] = 0;
  KernelProblem rest = problem;
  rest.pairs = pairs_.data();
  rest.pair_count = static_cast<std::int32_t>(pairs_.size());
  const bool touches = check(kernels, rest, configuration, scratch, confirm, context);
  for (const std::int32_t index : due_) {
    if (touches) {
      bodies_[static_cast<std::size_t>(index)].forget();
    } else {
      place(problem, index, configuration, scratch, 0.0);
    }
  }
  account(grows ? kGrownInVain : kNotTried);
  return touches;
}

void CoherenceCache::remember_contact(std::int32_t frame, const Sphere& sphere, double depth,
                                      const KernelScratch& scratch) {
  if (!is_following()) return;
  contact_.place(frame, sphere.center.data(), sphere.radius, scratch.poses, last_.data());
  depth_ = depth;
  knows_ = true;
}

}  // namespace spherule::internal
