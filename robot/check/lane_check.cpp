// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/lane_check.h"

#include "collide/kernels/plan_kernels.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace spherule::internal {

LaneCheck::LaneCheck(const BodyPairs& pairs, const RobotPlanSource& source,
                     InstructionSet instructions)
    : pairs_(pairs),
      positions_(pairs.robot()),
      kernels_(plan_kernels_for(instructions)),
      pair_of_test_(source.pair_of_test) {
  const PlanSource& all = source.source;
  motion_plan_float_ = std::make_shared<const CompiledPlan<float>>(all);
  motion_plan_double_ = std::make_unique<const CompiledPlan<double>>(all);
  if (source.first_static_tree == all.tests.size()) {
    config_plan_ = motion_plan_float_;
    wide_config_plan_ = std::make_unique<const CompiledWidePlan>(all, *config_plan_);
  } else {
    PlanSource first = all;
    first.tests.resize(source.first_static_tree);
    config_plan_ = std::make_shared<const CompiledPlan<float>>(first);
    wide_config_plan_ = std::make_unique<const CompiledWidePlan>(first, *config_plan_);
  }
  decide_fixed_pairs(source.fixed_pairs);
  find_never_ranges();
}

void LaneCheck::find_never_ranges() {
  for (const CheckedPair& pair : pairs_.pairs()) {
    if (pair.boxes == nullptr || !pair.boxes->is_all_free()) continue;
    for (const FreeBoxes::Variable& variable : pair.boxes->variables()) {
      if (variable.wraps) continue;  // all positions are proved
      const auto index = static_cast<std::size_t>(variable.index);
      auto known = std::find_if(never_ranges_.begin(), never_ranges_.end(),
                                [&](const Range& range) { return range.variable == index; });
      if (known == never_ranges_.end()) {
        known = never_ranges_.insert(known, {index, variable.lower, variable.upper});
      }
      known->lower = std::max(known->lower, variable.lower);
      known->upper = std::min(known->upper, variable.upper);
    }
  }
}

// Ranges are intervals: on a straight motion it is enough to test both ends.
bool LaneCheck::never_touch(std::span<const double> configuration) const {
  return std::all_of(never_ranges_.begin(), never_ranges_.end(), [&](const Range& range) {
    const double value = configuration[range.variable];
    return range.lower <= value && value <= range.upper;
  });
}

// Pairs that no joint moves: of static ones the canonical poses are always the same. Those that
// move together are apart in all configurations if they are in one by far more than rounding; the
// others are tested one by one.
void LaneCheck::decide_fixed_pairs(std::span<const std::size_t> pairs) {
  // Of both bodies, in both configurations, with the slack of the canonical test: 4.
  constexpr double kFar = 8.0;
  BodyPairs::Scratch scratch;
  pairs_.place(std::vector<double>(static_cast<std::size_t>(pairs_.robot().variable_count())),
               scratch);
  const MovingFrames frames(pairs_.robot());
  for (const std::size_t pair : pairs) {
    const CheckedPiece& piece =
        pairs_.pieces()[static_cast<std::size_t>(pairs_.pairs()[pair].piece)];
    const bool is_static = frames.frame_of_link[static_cast<std::size_t>(piece.link)] < 0;
    if (is_static && pairs_.touches(pair, scratch)) {
      motions_have_static_contact_ = true;
      configs_have_static_contact_ |= pair < pairs_.static_tree_pairs_begin();
    }
    if (!is_static && pairs_.is_near(pair, kFar * pairs_.pose_error(), scratch)) {
      rigid_pairs_.push_back(pair);
    }
  }
}

template <class Real>
LaneCheck::Scratch::Stage<Real>::Stage(const CompiledPlan<Real>& compiled, const WidePlan* wide,
                                       const WideScratch* wide_scratch)
    : plan(compiled, wide, wide_scratch),
      open(static_cast<std::size_t>(compiled.plan().word_count) * kPlanLanes),
      near(open.size()) {}

LaneCheck::Scratch::Scratch(const LaneCheck& check)
    : wide_config_plan_(check.config_plan_->plan(), *check.wide_config_plan_),
      config_plan_(*check.config_plan_, &check.wide_config_plan_->plan(),
                   &wide_config_plan_.view()),
      motion_plan_float_(*check.motion_plan_float_,
                         check.motion_plan_float_ == check.config_plan_
                             ? &check.wide_config_plan_->plan()
                             : nullptr,
                         &wide_config_plan_.view()),
      motion_plan_double_(*check.motion_plan_double_, nullptr, nullptr),
      positions_(check.positions_.scratch_for(kLanes)),
      proofs_(check.pairs_) {
  const auto positions =
      static_cast<std::size_t>(std::max(1, check.motion_plan_float_->plan().position_count));
  from_.resize(positions);
  to_.resize(positions);
  variables_.resize(static_cast<std::size_t>(check.pairs_.robot().variable_count()));
}

namespace {

// The configurations of the lanes, for the canonical tests.
struct ConfigurationClient {
  const BodyPairs& pairs;
  const CompiledPlan<float>& plan;
  std::span<const std::size_t> pair_of_test;
  std::span<const std::span<const double>> configurations;
  BodyPairs::Scratch& scratch;
  int placed = -1;

  static bool touches(void* context, int lane, std::int32_t test) {
    auto& self = *static_cast<ConfigurationClient*>(context);
    if (std::exchange(self.placed, lane) != lane) {
      self.pairs.place(self.configurations[static_cast<std::size_t>(lane)], self.scratch);
    }
    return self.pairs.touches(self.pair_of(test), self.scratch);
  }
  static bool is_proved_free(void* context, int lane, std::int32_t test) {
    const auto& self = *static_cast<ConfigurationClient*>(context);
    return self.pairs.pairs()[self.pair_of(test)].boxes->contains(
        self.configurations[static_cast<std::size_t>(lane)]);
  }

  std::size_t pair_of(std::int32_t test) const {
    return pair_of_test[static_cast<std::size_t>(plan.source_test(test))];
  }
  // For one evaluation.
  PlanClient client(bool skips_never) {
    return {.touches = &touches,
            .near = nullptr,
            .is_proved_free = &is_proved_free,
            .is_motion_proved = nullptr,
            .proved_parts = nullptr,
            .context = this,
            .skips_never = skips_never};
  }
};

}  // namespace

bool LaneCheck::rigid_pairs_touch(std::span<const double> configuration,
                                  BodyPairs::Scratch& canonical) const {
  if (rigid_pairs_.empty()) return false;
  pairs_.place(configuration, canonical);
  return std::any_of(rigid_pairs_.begin(), rigid_pairs_.end(),
                     [&](std::size_t pair) { return pairs_.touches(pair, canonical); });
}

unsigned LaneCheck::contacts(std::span<const std::span<const double>> configurations,
                             Scratch& scratch, BodyPairs::Scratch& canonical) const {
  const unsigned all = (1U << configurations.size()) - 1;
  if (configs_have_static_contact_) return all;
  unsigned rigid = 0;
  for (std::size_t i = 0; i < configurations.size() && !rigid_pairs_.empty(); ++i) {
    rigid |= (rigid_pairs_touch(configurations[i], canonical) ? 1U : 0U) << i;
  }
  const CheckPlan<float>& plan = config_plan_->plan();
  if (plan.test_count == 0) return rigid;
  const PlanScratch<float>& lanes = scratch.config_plan_.view();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t i = std::min(lane, configurations.size() - 1);
    const std::span<const double> at = positions_.of(configurations[i], scratch.positions_, lane);
    for (std::size_t p = 0; p < at.size(); ++p) lanes.positions[p].lane[lane] = at[p];
  }
  ConfigurationClient client{pairs_, *config_plan_, pair_of_test_, configurations, canonical};
  const bool skips_never = std::all_of(
      configurations.begin(), configurations.end(),
      [&](std::span<const double> configuration) { return never_touch(configuration); });
  return rigid | kernels_.check_lanes(plan, lanes, all & ~rigid, client.client(skips_never));
}

bool LaneCheck::touches(std::span<const double> configuration, Scratch& scratch,
                        BodyPairs::Scratch& canonical) const {
  if (configs_have_static_contact_ || rigid_pairs_touch(configuration, canonical)) return true;
  const CheckPlan<float>& plan = config_plan_->plan();
  if (plan.test_count == 0) return false;
  const WideScratch& wide = scratch.wide_config_plan_.view();
  const std::span<const double> at = positions_.of(configuration, scratch.positions_);
  std::copy(at.begin(), at.end(), wide.positions);
  ConfigurationClient client{pairs_, *config_plan_, pair_of_test_, {&configuration, 1}, canonical};
  return kernels_.check_one(plan, wide_config_plan_->plan(), wide,
                            client.client(never_touch(configuration)));
}

}  // namespace spherule::internal

// A straight motion in joint space, proved by adaptive bisection in lanes (dynamic collision
// checking: Schwarzer, Saha, Latombe): the parts that wait are evaluated eight at a time at their
// middles; tests that are not proved apart all along a part are open in the parts that it is split
// into, so that the lanes stay full. A part in which a test is open though it was inflated by no
// more than half the resolution (in single precision: or than rounding allows to tell) is given up
// there: single precision leaves it to double precision, and that settles it by the canonical tests
// at three configurations.

namespace spherule::internal {
namespace {

// Where so many parts are given up, no contact is searched for behind the first of them any more.
constexpr int kMostGivenUp = 32;
// Single precision gives up what is inflated by no more than this many times the error of centres.
constexpr double kUndecided = 4.0;

}  // namespace

class LaneCheck::Edge {
 public:
  Edge(const LaneCheck& check, std::span<const double> from, std::span<const double> to, double end,
       const EdgeRequest& request, Scratch& scratch, BodyPairs::Scratch& canonical)
      : check_(check),
        pairs_(check.pairs_),
        from_(from),
        to_(to),
        end_(end),
        request_(request),
        scratch_(scratch),
        canonical_(canonical) {
    const std::span<const double> start = check_.positions_.of(from, scratch.positions_, 0);
    const std::span<const double> finish = check_.positions_.of(to, scratch.positions_, 1);
    std::copy(start.begin(), start.end(), scratch.from_.begin());
    std::copy(finish.begin(), finish.end(), scratch.to_.begin());
    scratch.proofs_.take(from, to);
    skips_never_ = check.never_touch(from) && check.never_touch(to);
  }

  EdgeResult run() {
    if (check_.motions_have_static_contact_ || check_.rigid_pairs_touch(from_, canonical_)) {
      result_ = {.verdict = Verdict::kCollision, .contact_at = 0.0};
      return result_;
    }
    if (!check_.rigid_pairs_.empty()) unproved_from_ = 0.0;
    if (check_.motion_plan_float_->plan().test_count > 0) prove<float>({0.0, end_}, nullptr);
    result_.free_until = std::min({unproved_from_, result_.contact_at, end_});
    result_.verdict = result_.contact_at <= 1.0 ? Verdict::kCollision
                      : unproved_from_ <= end_  ? Verdict::kUnknown
                                                : Verdict::kFree;
    return result_;
  }

 private:
  using Part = PartStack::Part;

  static double middle_of(const Part& part) { return 0.5 * part.begin + 0.5 * part.end; }

  template <class Real>
  Scratch::Stage<Real>& stage() {
    if constexpr (std::is_same_v<Real, float>) {
      return scratch_.motion_plan_float_;
    } else {
      return scratch_.motion_plan_double_;
    }
  }
  template <class Real>
  const CompiledPlan<Real>& compiled() const {
    if constexpr (std::is_same_v<Real, float>) {
      return *check_.motion_plan_float_;
    } else {
      return *check_.motion_plan_double_;
    }
  }
  template <class Real>
  EvaluateParts<Real> kernel() const {
    if constexpr (std::is_same_v<Real, float>) {
      return check_.kernels_.evaluate_float;
    } else {
      return check_.kernels_.evaluate_double;
    }
  }

  // The rates of the motion, once for each precision.
  template <class Real>
  void set_motion() {
    bool& is_bounded = std::is_same_v<Real, float> ? is_bounded_[0] : is_bounded_[1];
    if (std::exchange(is_bounded, true)) return;
    constexpr double kLonger = 1.0 + 0x1p-20;  // above the roundings of differences and of Real
    const PlanScratch<Real>& scratch = stage<Real>().plan.view();
    double total = 0.0;
    for (std::size_t p = 0; p < scratch_.from_.size(); ++p) {
      const double rate = scratch_.to_[p] - scratch_.from_[p];
      const double largest = std::max(std::abs(scratch_.from_[p]), std::abs(scratch_.to_[p]));
      scratch.from[p] = scratch_.from_[p];
      scratch.to[p] = scratch_.to_[p];
      scratch.rates[p] = static_cast<Real>(rate);
      scratch.speeds[p] = static_cast<Real>(std::abs(rate) * kLonger);
      scratch.shifts[p] = static_cast<Real>(largest * kLonger);
      total += std::abs(rate);
    }
    *scratch.total_speed = static_cast<Real>(total * kLonger);
    pad_ = (4.0 + 4.0 * total) * pairs_.pose_error() + pairs_.middle_error();
    std::fill_n(scratch.has_bounds, compiled<Real>().plan().bound_count, false);
  }

  // A part of the motion with the tests that are open in it (null: all). False once there is no
  // more to be found.
  template <class Real>
  bool prove(const Part& whole, const std::uint64_t* open) {
    set_motion<Real>();
    Scratch::Stage<Real>& stage = this->stage<Real>();
    stage.waiting.clear(static_cast<std::size_t>(compiled<Real>().plan().word_count));
    Batch batch;
    bool goes_on = true;
    if (open == nullptr) {
      const std::size_t pieces = std::max<std::size_t>(1, most_lanes());
      for (std::size_t i = 0; i < pieces; ++i) {
        batch.parts[i] = piece_of(whole, static_cast<int>(i), static_cast<int>(pieces));
      }
      batch.count = pieces;
      goes_on = evaluate<Real>(batch);
    } else {
      split(stage.waiting, whole, kPlanLanes, open);
    }
    while (goes_on && !stage.waiting.empty()) goes_on = !take<Real>(batch) || evaluate<Real>(batch);
    if (!goes_on) unproved_from_ = std::min(unproved_from_, stage.waiting.earliest());
    return goes_on;
  }

  // Parts that are evaluated side by side. All tests are open in them, or those of the stage's
  // sets.
  struct Batch {
    std::array<Part, kPlanLanes> parts;
    std::size_t count = 0;
    bool is_all = true;
  };

  static Part piece_of(const Part& part, int i, int pieces) {
    const double length = part.end - part.begin;
    const auto border = [&](int k) {
      return k == pieces ? part.end : part.begin + length * (static_cast<double>(k) / pieces);
    };
    return {border(i), border(i + 1)};
  }

  // The leftmost piece on top.
  static void split(PartStack& waiting, const Part& part, int pieces, const std::uint64_t* open) {
    for (int i = pieces - 1; i >= 0; --i) {
      const Part piece = piece_of(part, i, pieces);
      if (piece.begin < piece.end) waiting.push(piece, open);
    }
  }

  // Whether nothing can be found in a part any more: it is behind a contact, or behind what was
  // given up.
  bool is_behind(const Part& part) const {
    return part.begin >= result_.contact_at ||
           (given_up_ >= kMostGivenUp && part.begin >= unproved_from_);
  }

  // Up to eight parts from the top of the stack in which something may be found.
  template <class Real>
  bool take(Batch& batch) {
    Scratch::Stage<Real>& stage = this->stage<Real>();
    const auto words = static_cast<std::size_t>(compiled<Real>().plan().word_count);
    batch.count = 0;
    batch.is_all = false;
    const std::size_t most = std::max<std::size_t>(1, most_lanes());
    while (batch.count < most && !stage.waiting.empty()) {
      stage.waiting.pop(batch.parts[batch.count], stage.open.data() + batch.count * words);
      if (!is_behind(batch.parts[batch.count])) ++batch.count;
    }
    return batch.count != 0;
  }

  // So many configurations may be evaluated next.
  std::size_t most_lanes() const {
    const std::uint64_t left = request_.max_configurations - result_.configurations;
    return static_cast<std::size_t>(std::min<std::uint64_t>(left, kPlanLanes));
  }

  // False once there is no more to be found.
  template <class Real>
  bool evaluate(const Batch& taken) {
    Scratch::Stage<Real>& stage = this->stage<Real>();
    const CheckPlan<Real>& plan = compiled<Real>().plan();
    const auto words = static_cast<std::size_t>(plan.word_count);
    const std::array<Part, kPlanLanes>& parts = taken.parts;
    const std::size_t count = taken.count;
    const auto stop = [&] {
      for (std::size_t i = 0; i < count; ++i) {
        unproved_from_ = std::min(unproved_from_, parts[i].begin);
      }
      return false;
    };
    if (result_.configurations + count > request_.max_configurations) return stop();
    result_.configurations += count;
    PlanParts batch;
    batch.lanes = (1U << count) - 1;
    batch.open = taken.is_all ? nullptr : stage.open.data();
    batch.near = stage.near.data();
    batch.all_contacts = request_.first;
    batch.enough = 0.5 * request_.resolution;
    if constexpr (std::is_same_v<Real, float>) {
      batch.enough = std::max(batch.enough, kUndecided * check_.motion_plan_float_->center_error());
    }
    place({parts.data(), count}, batch);
    Client<Real> client{*this};
    kernel<Real>()(plan, stage.plan.view(), batch,
                   {.touches = &Client<Real>::touches,
                    .near = &Client<Real>::near,
                    .is_proved_free = &Client<Real>::is_proved_free,
                    .is_motion_proved = &Client<Real>::is_motion_proved,
                    .proved_parts = &Client<Real>::proved_parts,
                    .context = &client,
                    .skips_never = skips_never_});
    if (batch.contacts != 0) {
      for (std::size_t i = 0; i < count; ++i) {
        if ((batch.contacts >> i & 1U) != 0) {
          result_.contact_at = std::min(result_.contact_at, times_[i]);
        }
      }
      if (!request_.first) return stop();
    }
    const auto open = static_cast<std::size_t>(std::popcount(batch.any_near));
    const int pieces = std::max(2, static_cast<int>(kPlanLanes / std::max<std::size_t>(open, 1)));
    for (std::size_t i = count; i-- > 0;) {
      if ((batch.any_near >> i & 1U) == 0 || is_behind(parts[i])) continue;
      const std::uint64_t* const near = stage.near.data() + i * words;
      const bool is_shortest = !(parts[i].begin < times_[i] && times_[i] < parts[i].end);
      if (!is_shortest && (batch.given_up >> i & 1U) == 0) {
        split(stage.waiting, parts[i], pieces, near);
      } else if (!give_up<Real>(parts[i], near)) {
        return stop();
      }
    }
    return true;
  }

  // The middles of the parts; the lanes that are left over repeat the last.
  void place(std::span<const Part> parts, PlanParts& batch) {
    for (std::size_t lane = 0; lane < kPlanLanes; ++lane) {
      const Part& part = parts[std::min(lane, parts.size() - 1)];
      times_[lane] = middle_of(part);
      batch.middle[lane] = times_[lane];
      halves_[lane] = std::max(part.end - times_[lane], times_[lane] - part.begin);
      batch.half[lane] = halves_[lane];
    }
    placed_ = -1.0;
  }

  template <class Real>
  bool give_up(const Part& part, const std::uint64_t* open) {
    if constexpr (std::is_same_v<Real, float>) {
      if (!(part.begin < part.end)) {
        unproved_from_ = std::min(unproved_from_, part.begin);
        return true;
      }
      scratch_.undecided_.assign(open, open + check_.motion_plan_float_->plan().word_count);
      const auto times = times_;
      const auto halves = halves_;
      const bool goes_on = prove<double>(part, scratch_.undecided_.data());
      times_ = times;
      halves_ = halves;
      return goes_on;
    } else {
      unproved_from_ = std::min(unproved_from_, part.begin);
      settle(part, open);
      ++given_up_;
      return request_.first || (result_.contact_at > 1.0 && given_up_ < kMostGivenUp);
    }
  }

  // A part in which bodies nearly touch: whether they do, where that can be told.
  void settle(const Part& part, const std::uint64_t* open) {
    for (const double at : {part.begin, middle_of(part), part.end}) {
      if (at >= result_.contact_at) return;
      if (result_.configurations >= request_.max_configurations) return;
      ++result_.configurations;
      const CheckPlan<double>& plan = check_.motion_plan_double_->plan();
      for (std::int32_t test = 0; test < plan.test_count; ++test) {
        if ((open[test / 64] >> (test % 64) & 1U) == 0) continue;
        if (check_.motion_plan_double_->source_test(test) < 0 ||
            !touches(at, *check_.motion_plan_double_, test))
          continue;
        result_.contact_at = at;
        return;
      }
    }
  }

  template <class Real>
  std::size_t pair_of(const CompiledPlan<Real>& plan, std::int32_t test) const {
    return check_.pair_of_test_[static_cast<std::size_t>(plan.source_test(test))];
  }

  // By the canonical tests.
  template <class Real>
  std::size_t pair_at(double at, const CompiledPlan<Real>& plan, std::int32_t test) {
    if (std::exchange(placed_, at) != at) {
      take_between(from_, to_, at, scratch_.variables_);
      pairs_.place(scratch_.variables_, canonical_);
    }
    return pair_of(plan, test);
  }
  template <class Real>
  bool touches(double at, const CompiledPlan<Real>& plan, std::int32_t test) {
    return pairs_.touches(pair_at(at, plan, test), canonical_);
  }

  // Those of the lanes in whose parts a test is not proved apart: of several at once, as far as one
  // clearance serves them, which is cheaper than to test each.
  template <class Real>
  unsigned near_lanes(const CompiledPlan<Real>& plan, std::int32_t test, unsigned lanes,
                      double speed) {
    constexpr double kLonger = 1.0 + 1e-9;
    if (lanes == 0) return 0;
    unsigned upper = lanes;
    for (int i = std::popcount(lanes) / 2; i > 0; --i) upper &= upper - 1;
    const double middle = times_[static_cast<std::size_t>(std::countr_zero(upper))];
    double longest = 0.0;
    for (std::size_t lane = 0; lane < kPlanLanes; ++lane) {
      if ((lanes >> lane & 1U) == 0) continue;
      longest = std::max(longest, std::abs(times_[lane] - middle) + halves_[lane]);
    }
    const std::size_t pair = pair_at(middle, plan, test);
    if (!pairs_.is_near(pair, speed * longest * kLonger + pad_, canonical_)) return 0;
    if (std::has_single_bit(lanes)) return lanes;
    return near_lanes(plan, test, lanes & ~upper, speed) | near_lanes(plan, test, upper, speed);
  }

  template <class Real>
  struct Client {
    Edge& edge;

    static bool touches(void* context, int lane, std::int32_t test) {
      Edge& edge = static_cast<Client*>(context)->edge;
      return edge.touches(edge.times_[static_cast<std::size_t>(lane)], edge.compiled<Real>(), test);
    }
    static unsigned near(void* context, std::int32_t test, unsigned lanes, double speed) {
      Edge& edge = static_cast<Client*>(context)->edge;
      return edge.near_lanes(edge.compiled<Real>(), test, lanes, speed);
    }
    static bool is_proved_free(void* context, int lane, std::int32_t test) {
      Edge& edge = static_cast<Client*>(context)->edge;
      return edge.scratch_.proofs_.is_free_at(edge.pair_of(edge.compiled<Real>(), test),
                                              edge.times_[static_cast<std::size_t>(lane)]);
    }
    static bool is_motion_proved(void* context, std::int32_t test) {
      Edge& edge = static_cast<Client*>(context)->edge;
      return edge.scratch_.proofs_.is_free(edge.pair_of(edge.compiled<Real>(), test));
    }
    static unsigned proved_parts(void* context, std::int32_t test, unsigned lanes) {
      Edge& edge = static_cast<Client*>(context)->edge;
      return edge.scratch_.proofs_.free_parts(edge.pair_of(edge.compiled<Real>(), test),
                                              edge.times_, edge.halves_, lanes);
    }
  };

  const LaneCheck& check_;
  const BodyPairs& pairs_;
  std::span<const double> from_;
  std::span<const double> to_;
  const double end_;
  const EdgeRequest& request_;
  Scratch& scratch_;
  BodyPairs::Scratch& canonical_;
  EdgeResult result_;
  bool skips_never_ = false;
  std::array<bool, 2> is_bounded_{};
  std::array<double, kPlanLanes> times_{};
  std::array<double, kPlanLanes> halves_{};
  double placed_ = -1.0;  // the time whose configuration `canonical_` has
  double pad_ = 0.0;
  double unproved_from_ = std::numeric_limits<double>::infinity();
  int given_up_ = 0;
};

EdgeResult LaneCheck::check_edge(std::span<const double> from, std::span<const double> to,
                                 double end, const EdgeRequest& request, Scratch& scratch,
                                 BodyPairs::Scratch& canonical) const {
  return Edge(*this, from, to, end, request, scratch, canonical).run();
}

}  // namespace spherule::internal
