// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/bound/cover_bound.h"

#include "base/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Weights = std::vector<double>;

// A round packs the points, bounds what any sphere holds, and hands on what cells of centres hold
// that are too heavy, as sets that are packed next.
struct Round {
  double finest;  // half diagonal of the smallest cells, share of E
  double news;    // what a cell holds is handed on if it is heavier by this factor, for a point
};
constexpr std::array kRounds{Round{0.08, 1.3}, Round{0.04, 1.1}, Round{0.03, 1.03},
                             Round{0.03, 1.02}, Round{0.02, 1.02}};
constexpr int kSteps = 300;  // of the packing
// Spheres heavier than 1 by less are not worth finding: the weights are lessened by as much.
constexpr double kReserve = 0.01;
constexpr double kRounding = 1e-9;

std::vector<Vector3d> certain_points(const CoverBoundInput& input) {
  const double slack = HeaviestSpheres::slack(input.clearance, input.max_error);
  std::vector<Vector3d> points;
  for (const Vector3d& p : input.points) {
    if (input.clearance(p).lower >= 0.0 || input.distance(p, slack).triangle >= 0) {
      points.push_back(p);
    }
  }
  return points;
}

// Of the weights, each over what the heaviest sphere about the point weighs.
double proved_sum(const Weights& weights, const Weights& heaviest_about) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] / heaviest_about[i];
  return sum;
}

}  // namespace

std::size_t cover_bound(const CoverBoundInput& input) {
  if (input.max_error > input.clearance.least_external()) return 1;
  const std::vector<Vector3d> points = certain_points(input);
  if (points.empty()) return 1;
  const HeaviestSpheres spheres(input.clearance, input.max_error, points);
  FractionalPacking packing(points.size());
  std::vector<FractionalPacking::Set> sets(input.centers.size());
  parallel_for(0, sets.size(), [&](std::size_t i) { sets[i] = spheres.held_by(input.centers[i]); });
  packing.add(std::move(sets));
  double best = 1.0;
  for (std::size_t round = 0; round < kRounds.size(); ++round) {
    const auto tell = [&](double share) {
      if (!input.progress) return;
      input.progress((static_cast<double>(round) + share) / kRounds.size(),
                     "proving a lower bound");
    };
    packing.solve(kSteps, input.stop);
    Weights weights = packing.weights();
    for (double& w : weights) w *= 1.0 - kReserve;
    HeaviestSpheres::Found found = spheres.find({.weights = weights,
                                                 .finest = kRounds[round].finest * input.max_error,
                                                 .news = kRounds[round].news,
                                                 .stop = input.stop,
                                                 .tell = tell});
    if (input.stop.stop_requested()) break;
    best = std::max(best, proved_sum(weights, found.about));
    packing.add(std::move(found.held));
  }
  return static_cast<std::size_t>(std::ceil(best * (1.0 - kRounding) - kRounding));
}

namespace {

using Values = std::vector<double>;

constexpr int kPeriod = 60;  // steps between restarts
constexpr double kLargestBalance = 10.0;

// For each list the sum of the values that it names.
Values sums(const std::vector<FractionalPacking::Set>& lists, const Values& values) {
  Values result(lists.size());
  parallel_for(0, lists.size(), [&](std::size_t i) {
    double sum = 0.0;
    for (const std::uint32_t k : lists[i]) sum += values[k];
    result[i] = sum;
  });
  return result;
}

// Of the change, in the metric of the steps.
double change(const std::vector<FractionalPacking::Set>& lists, const Values& a, const Values& b) {
  double squared = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squared += static_cast<double>(lists[i].size()) * (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(squared);
}

}  // namespace

FractionalPacking::FractionalPacking(std::size_t points)
    : sets_of_(points), now_{Values(points, 0.0), {}} {}

void FractionalPacking::add(std::vector<Set> sets) {
  for (Set& set : sets) {
    if (set.empty()) continue;
    for (const std::uint32_t p : set) {
      sets_of_[p].push_back(static_cast<std::uint32_t>(points_of_.size()));
    }
    points_of_.push_back(std::move(set));
  }
  now_.cover.resize(points_of_.size(), 0.0);
}

Values FractionalPacking::loads(const Values& weights) const {
  return sums(points_of_, weights);
}

Values FractionalPacking::covered_by(const Values& cover) const {
  return sums(sets_of_, cover);
}

void FractionalPacking::step(Values& extrapolated) {
  const Values load = loads(now_.weights);
  parallel_for(0, load.size(), [&](std::size_t s) {
    const double size = balance_ * static_cast<double>(points_of_[s].size());
    const double next = std::max(0.0, now_.cover[s] - (1.0 - load[s]) / size);
    extrapolated[s] = 2.0 * next - now_.cover[s];
    now_.cover[s] = next;
  });
  const Values covered = covered_by(extrapolated);
  parallel_for(0, covered.size(), [&](std::size_t p) {
    if (sets_of_[p].empty()) return;
    const double size = balance_ / static_cast<double>(sets_of_[p].size());
    now_.weights[p] = std::max(0.0, now_.weights[p] + size * (1.0 - covered[p]));
  });
}

void FractionalPacking::restart(Iterate& mean, int steps) {
  const auto take = [steps](Values& now, Values& sum) {
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = sum[i] / steps;
    std::fill(sum.begin(), sum.end(), 0.0);
  };
  take(now_.weights, mean.weights);
  take(now_.cover, mean.cover);
  const double up = change(sets_of_, now_.weights, last_.weights);
  const double down = change(points_of_, now_.cover, last_.cover);
  if (up > 0.0 && down > 0.0) {
    balance_ = std::clamp(std::sqrt(balance_ * up / down), 1.0 / kLargestBalance, kLargestBalance);
  }
  last_ = now_;
}

void FractionalPacking::solve(int steps, const std::stop_token& stop) {
  last_ = now_;
  Iterate sum{Values(now_.weights.size(), 0.0), Values(now_.cover.size(), 0.0)};
  Values extrapolated(now_.cover.size());
  int since = 0;
  for (int i = 0; i < steps && !stop.stop_requested(); ++i) {
    step(extrapolated);
    for (std::size_t p = 0; p < now_.weights.size(); ++p) sum.weights[p] += now_.weights[p];
    for (std::size_t s = 0; s < now_.cover.size(); ++s) sum.cover[s] += now_.cover[s];
    if (++since == kPeriod) {
      restart(sum, since);
      since = 0;
    }
  }
}

// Each is divided by the load of the heaviest set that holds the point: twice, as this raises what
// is then too light.
Values FractionalPacking::weights() const {
  Values weights = now_.weights;
  for (int i = 0; i < 2; ++i) {
    const Values load = loads(weights);
    parallel_for(0, weights.size(), [&](std::size_t p) {
      double heaviest = 0.0;
      for (const std::uint32_t s : sets_of_[p]) heaviest = std::max(heaviest, load[s]);
      weights[p] = heaviest > 0.0 ? weights[p] / heaviest : 0.0;
    });
  }
  return weights;
}

namespace {

using Eigen::Vector3d;

// Shares of E.
constexpr double kClosely = 0.3;  // half diagonal of the largest cells where points are told apart
constexpr double kDeep = 0.5;     // that they are larger by where S is deep, of the clearance
constexpr double kCube = 0.75;    // edge of the cubes that points are sorted into

// Shares of a cell's half diagonal.
constexpr double kAhead = 2.0;  // of the step at which another contact is searched for

constexpr std::size_t kTasks = 512;
constexpr std::size_t kPart = 8;  // tasks in sequence
// Far above the rounding of sums of weights, below what matters.

// D(q + d) <= value + slope.d + excess for every d no longer than the half diagonal of the cell at
// q.
struct Slope {
  double value;
  Vector3d slope;
  double excess;
};

}  // namespace

// Of the cells of one task: depth first, with what every sphere of the cell holds on a stack.
class HeaviestSpheres::Descent {
 public:
  Descent(const HeaviestSpheres& of, const Search& search, Found& found)
      : of_(of), search_(search), found_(found) {}

  // `near` holds all other points that spheres of the cell may hold, if that is known; the
  // clearance at the centre is below `limit`.
  void run(const BoxCell& cell, const Held* near, double limit) {
    if (search_.stop.stop_requested()) return;
    const double reach = cell.reach();
    const ClearanceAt at = of_.clearance_(cell.center, limit);
    if (at.upper + reach < -of_.error_) return;
    const bool closely =
        near != nullptr || reach <= kClosely * of_.error_ + kDeep * std::max(0.0, at.lower);
    const std::size_t sure = sure_.size();
    const double sure_weight = sure_weight_;
    Held held;
    if (!closely || is_heavy(cell, at, reach, near, held)) {
      const auto below = [&](const BoxCell& half) {
        const double step = (half.center - cell.center).norm();
        return (at.upper + step) + kRounding * (std::abs(at.upper) + step) + of_.slack_;
      };
      for (const BoxCell& half : cell.halves()) run(half, closely ? &held : nullptr, below(half));
    }
    sure_.resize(sure);
    sure_weight_ = sure_weight;
  }

 private:
  // Whether the cell has to be halved: it is noted if it is heavy and too small for that.
  bool is_heavy(const BoxCell& cell, const ClearanceAt& at, double reach, const Held* near,
                Held& held) {
    if (near != nullptr) {
      held = *near;
    } else {
      of_.grid_.find(cell.center, std::max(0.0, at.upper + of_.error_ + of_.slack_ + 2.0 * reach),
                     held);
    }
    std::array<Slope, 3> slopes{slope_at(at, Vector3d::Zero(), reach)};
    double weight = weigh(cell, std::span(slopes).first(1), at.lower, reach, held);
    if (weight <= 1.0) return false;
    // On the medial axis another contact limits the clearance beyond.
    const Vector3d ahead = kAhead * reach * at.away;
    const ClearanceAt there = of_.clearance_(cell.center + ahead);
    slopes[1] = slope_at(there, ahead, reach);
    slopes[2] = {(slopes[0].value + slopes[1].value) / 2.0,
                 (slopes[0].slope + slopes[1].slope) / 2.0,
                 (slopes[0].excess + slopes[1].excess) / 2.0};
    if ((slopes[1].slope - slopes[0].slope).squaredNorm() > 0.01) {
      weight = weigh(cell, std::span(slopes).last(2), at.lower, reach, held);
      if (weight <= 1.0) return false;
    }
    if (reach > search_.finest) return true;
    note(weight, held);
    return false;
  }

  // From the contact at m = q + ahead, with an external sphere about x: with z the unit vector from
  // x to m, |m + v - x| <= |m - x| + z.v + |v|^2 / (2 |m - x|), as the root is concave.
  Slope slope_at(const ClearanceAt& at, const Vector3d& ahead, double reach) const {
    const double far = ahead.norm() + reach;
    const double to_center = of_.clearance_.least_external() + at.lower;
    const double excess = to_center > 0.0 ? far * far / (2.0 * to_center) : 2.0 * far;
    return {at.upper - at.away.dot(ahead), at.away, excess};
  }

  // The weight of what spheres with a centre c = q + d in the cell may hold. A point p is out if
  // |p - c| > D(c) + E for all of them; |p - c| is at least |p - q| - e.d, e the direction to p.
  double weigh(const BoxCell& cell, std::span<const Slope> slopes, double lower, double reach,
               Held& held) {
    const double certain = lower + of_.error_ - 2.0 * reach;
    double sum = 0.0;
    std::erase_if(held, [&](std::uint32_t r) {
      const Vector3d to_point = of_.points_[r] - cell.center;
      const double distance = to_point.norm();
      if (distance <= certain) {
        sure_.push_back(r);
        sure_weight_ += search_.weights[r];
        return true;
      }
      for (const Slope& s : slopes) {
        const double beyond = distance - of_.error_ - of_.slack_ - s.value - s.excess;
        if (beyond <= 0.0) continue;
        if ((to_point / distance + s.slope).cwiseAbs().dot(cell.half) < beyond) return true;
      }
      sum += search_.weights[r];
      return false;
    });
    return (sum + sure_weight_) * (1.0 + kRounding);
  }

  void note(double weight, const Held& held) {
    bool news = false;
    for (const Held* some : {&std::as_const(sure_), &held}) {
      for (const std::uint32_t r : *some) {
        news = news || weight > search_.news * found_.about[r];
        found_.about[r] = std::max(found_.about[r], weight);
      }
    }
    if (!news) return;
    Held all = sure_;
    all.insert(all.end(), held.begin(), held.end());
    found_.held.push_back(std::move(all));
  }

  const HeaviestSpheres& of_;
  const Search& search_;
  Found& found_;
  Held sure_;  // that every sphere of the cell holds
  double sure_weight_ = 0.0;
};

HeaviestSpheres::HeaviestSpheres(const Clearance& clearance, double max_error,
                                 std::span<const Vector3d> points)
    : clearance_(clearance),
      error_(max_error),
      slack_(slack(clearance, max_error)),
      points_(points.begin(), points.end()),
      grid_(points, kCube * max_error) {}

double HeaviestSpheres::slack(const Clearance& clearance, double max_error) {
  return kRounding * (largest_coordinate(clearance.box()) + max_error);
}

HeaviestSpheres::Held HeaviestSpheres::held_by(const Vector3d& center) const {
  Held held;
  const double radius = clearance_(center).upper + error_;
  if (radius > 0.0) grid_.find(center, radius, held);
  return held;
}

HeaviestSpheres::Found HeaviestSpheres::find(const Search& search) const {
  const Vector3d by = Vector3d::Constant(error_);
  std::vector<BoxCell> cells{
      BoxCell::around({clearance_.box().min() - by, clearance_.box().max() + by})};
  while (cells.size() < kTasks) {
    std::vector<BoxCell> next;
    for (const BoxCell& cell : cells) {
      for (const BoxCell& half : cell.halves()) next.push_back(half);
    }
    cells = std::move(next);
  }
  std::atomic<std::size_t> done = 0;
  const Found none{std::vector<double>(points_.size(), 1.0), {}};
  // In the same parts whatever the threads: what is news depends on what a part saw before.
  Found found = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, cells.size(), kPart), none,
      [&](const tbb::blocked_range<std::size_t>& range, Found part) {
        Descent descent(*this, search, part);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          descent.run(cells[i], nullptr, std::numeric_limits<double>::infinity());
          if (search.tell) {
            search.tell(static_cast<double>(++done) / static_cast<double>(cells.size()));
          }
        }
        return part;
      },
      [](Found a, const Found& b) {
        for (std::size_t r = 0; r < a.about.size(); ++r) {
          a.about[r] = std::max(a.about[r], b.about[r]);
        }
        a.held.insert(a.held.end(), b.held.begin(), b.held.end());
        return a;
      });
  return search.stop.stop_requested() ? Found{} : found;
}

}  // namespace spherule::internal
