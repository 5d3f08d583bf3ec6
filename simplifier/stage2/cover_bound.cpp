// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_bound.h"

#include "mesh/geometry/point_grid.h"
#include "simplifier/solid/box_cell.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Rows = std::vector<std::uint32_t>;

// Shares of E.
constexpr double kFinest = 0.08;    // half diagonal of the smallest cells of centres
constexpr double kClosely = 0.3;    // and of the largest in which points are told apart
constexpr double kCube = 0.75;      // edge of the cubes that points are sorted into
constexpr double kTolerance = 0.2;  // of a cell's half diagonal, of the clearance there

constexpr int kLargestNorm = 64;
constexpr int kSteps = 12;  // for each norm
constexpr int kRounds = 2;  // of proof, and of balancing over the balls that it met
// What a cell of heavy balls holds is balanced over if that is news, by this factor, for a point.
constexpr double kNews = 1.03;
constexpr std::size_t kTasks = 512;
constexpr std::size_t kPart = 8;  // tasks in sequence
// Far above the rounding of sums of weights, below what matters.
constexpr double kRounding = 1e-9;

// Above the rounding of points of the mesh, and of balls about them.
double slack_of(const CoverBoundInput& input) {
  return kRounding * (largest_coordinate(input.clearance.box()) + input.max_error);
}

class Packing {
 public:
  Packing(const CoverBoundInput& input, std::vector<Vector3d> points)
      : clearance_(input.clearance),
        error_(input.max_error),
        least_external_(input.clearance.least_external()),
        slack_(slack_of(input)),
        stop_(input.stop),
        points_(std::move(points)),
        grid_(points_, kCube * error_),
        weights_(points_.size(), 1.0) {
    std::vector<Rows> columns(input.centers.size());
    tbb::parallel_for(std::size_t{0}, columns.size(), [&](std::size_t i) {
      const double radius = clearance_(input.centers[i]).upper + error_;
      if (radius > 0.0) grid_.find(input.centers[i], radius, columns[i]);
    });
    learn(std::move(columns));
  }

  // The sets of points that are balanced over; none may be heavier than 1.
  void learn(std::vector<Rows> columns) {
    columns_of_.resize(points_.size());
    for (Rows& column : columns) {
      for (const std::uint32_t r : column) {
        columns_of_[r].push_back(static_cast<std::uint32_t>(columns_.size()));
      }
      columns_.push_back(std::move(column));
    }
  }

  // Makes the weights large together while no known ball is heavier than 1: their sum over the
  // p-norm of the balls' weights is raised for p = 4, 8, ... kLargestNorm, where that norm is
  // nearly the greatest. There the price of a point, the sum of w^(p-1) over the balls that hold
  // it, is the same for all points with a weight: a point that is dearer than the mean loses, a
  // cheaper one gains, by the p-th root of the ratio.
  void balance() {
    weights_ = fitted();
    std::vector<double> best = weights_;
    for (int root = 2; (1 << root) <= kLargestNorm; ++root) {
      for (int i = 0; i < kSteps; ++i) {
        const std::vector<double> price = prices(root);
        double paid = 0.0;
        for (std::size_t r = 0; r < points_.size(); ++r) paid += price[r] * weights_[r];
        const double mean = paid / sum_of(weights_);
        for (std::size_t r = 0; r < points_.size(); ++r) {
          if (!(price[r] > 0.0)) continue;
          double factor = std::clamp(mean / price[r], 1e-6, 1e6);
          for (int k = 0; k < root; ++k) factor = std::sqrt(factor);
          weights_[r] *= factor;
        }
      }
      std::vector<double> now = fitted();
      if (sum_of(now) > sum_of(best)) best = std::move(now);
    }
    weights_ = std::move(best);
  }

  // Divides each weight by that of the heaviest ball there may be about the point, if that is
  // heavier than 1, and returns the sum. What cells of such balls hold is left in `heavy`. Nothing
  // is proved, and 0 returned, where a stop was requested before the end.
  double prove(std::vector<Rows>& heavy, const std::function<void(double)>& tell) {
    std::vector<BoxCell> cells{BoxCell::around(grown_box())};
    while (cells.size() < kTasks) {
      std::vector<BoxCell> next;
      for (const BoxCell& cell : cells) {
        for (const BoxCell& half : cell.halves()) next.push_back(half);
      }
      cells = std::move(next);
    }
    std::atomic<std::size_t> done = 0;
    const Heaviest none{std::vector<double>(points_.size(), 1.0), {}};
    // In the same parts whatever the threads: what is news depends on what a part saw before.
    Heaviest heaviest = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, cells.size(), kPart), none,
        [&](const tbb::blocked_range<std::size_t>& range, Heaviest found) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            search(cells[i], nullptr, found);
            tell(static_cast<double>(++done) / static_cast<double>(cells.size()));
          }
          return found;
        },
        [](Heaviest a, const Heaviest& b) {
          for (std::size_t r = 0; r < a.about.size(); ++r) {
            a.about[r] = std::max(a.about[r], b.about[r]);
          }
          a.held.insert(a.held.end(), b.held.begin(), b.held.end());
          return a;
        });
    if (stop_.stop_requested()) return 0.0;
    double sum = 0.0;
    for (std::size_t r = 0; r < points_.size(); ++r) sum += weights_[r] /= heaviest.about[r];
    heavy = std::move(heaviest.held);
    return sum;
  }

 private:
  struct Heaviest {
    std::vector<double> about;  // for every point, at least 1
    std::vector<Rows> held;     // by cells of balls heavier than 1
  };

  static double sum_of(const std::vector<double>& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
  }

  std::vector<double> loads() const {
    std::vector<double> load(columns_.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, columns_.size(), [&](std::size_t c) {
      for (const std::uint32_t r : columns_[c]) load[c] += weights_[r];
    });
    return load;
  }

  // For p = 2^root, with the heaviest ball for the unit.
  std::vector<double> prices(int root) const {
    std::vector<double> load = loads();
    const double greatest = *std::max_element(load.begin(), load.end());
    for (double& l : load) {
      double power = l / greatest;
      const double once = power;
      for (int k = 0; k < root; ++k) power *= power;
      l = once > 0.0 ? power / once : 0.0;
    }
    std::vector<double> price(points_.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t r) {
      for (const std::uint32_t c : columns_of_[r]) price[r] += load[c];
    });
    return price;
  }

  // The weights, each divided by that of the heaviest known ball that holds the point: twice, as
  // this raises what is then too light. 0 for a point that no known ball holds.
  std::vector<double> fitted() {
    std::vector<double> kept = weights_;
    for (int i = 0; i < 2; ++i) {
      const std::vector<double> load = loads();
      tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t r) {
        double heaviest = 0.0;
        for (const std::uint32_t c : columns_of_[r]) heaviest = std::max(heaviest, load[c]);
        weights_[r] = heaviest > 0.0 ? weights_[r] / heaviest : 0.0;
      });
    }
    std::swap(kept, weights_);
    return kept;
  }

  Eigen::AlignedBox3d grown_box() const {
    const Vector3d by = Vector3d::Constant(error_);
    return {clearance_.box().min() - by, clearance_.box().max() + by};
  }

  // The weight of the points that balls with a centre in the cell hold: of the points in the ball
  // about the centre q of the cell that contains all of these balls, radius D(q) + E + 2 g.
  // Closely, a point p counts only if |p - c| <= D(c) + E may hold for a c = q + d, |d| <= g: |p -
  // c| is at least |p - q| - e.d, e the direction to p, and D(c) at most D(q) + u.d + g^2 / (2 |q -
  // x|), where u points away from the contact at q, and x, |q - x| >= R + D(q), is the centre of
  // the external ball there.
  double weight(const BoxCell& cell, const ClearanceAt& at, double reach, Rows& held) const {
    const Vector3d& q = cell.center;
    const double radius = at.upper + error_ + slack_;
    const double to_external = least_external_ + at.lower;
    const double bend = reach * reach / (2.0 * to_external);
    double sum = 0.0;
    std::erase_if(held, [&](std::uint32_t r) {
      const Vector3d to_point = points_[r] - q;
      const double distance = to_point.norm();
      const double beyond = distance - radius;
      const bool out =
          beyond > 2.0 * reach || (beyond > 0.0 && to_external > reach &&
                                   beyond > bend + reach * (to_point / distance + at.away).norm());
      if (!out) sum += weights_[r];
      return out;
    });
    return sum * (1.0 + kRounding);
  }

  // Of the balls with a centre in the cell; `near` holds all points that they hold, if that is
  // known.
  void search(const BoxCell& cell, const Rows* near, Heaviest& found) const {
    if (stop_.stop_requested()) return;
    const double reach = cell.reach();
    const ClearanceAt at = clearance_(cell.center, kTolerance * reach);
    if (at.upper + reach < -error_) return;
    Rows held;
    const bool closely = reach <= kClosely * error_;
    if (closely) {
      if (near != nullptr) {
        held = *near;
      } else {
        grid_.find(cell.center, std::max(0.0, at.upper + error_ + slack_ + 2.0 * reach), held);
      }
      const double heavy = weight(cell, at, reach, held);
      if (heavy <= 1.0) return;
      if (reach <= kFinest * error_) {
        const bool news = std::ranges::any_of(
            held, [&](std::uint32_t r) { return heavy > kNews * found.about[r]; });
        for (const std::uint32_t r : held) found.about[r] = std::max(found.about[r], heavy);
        if (news) found.held.push_back(held);
        return;
      }
    }
    for (const BoxCell& half : cell.halves()) search(half, closely ? &held : nullptr, found);
  }

  const Clearance& clearance_;
  double error_;
  double least_external_;
  double slack_;
  std::stop_token stop_;
  std::vector<Vector3d> points_;
  PointGrid grid_;
  std::vector<double> weights_;
  std::vector<Rows> columns_;     // the points that each known ball holds
  std::vector<Rows> columns_of_;  // the known balls that hold each point
};

}  // namespace

std::size_t cover_bound(const CoverBoundInput& input) {
  if (input.max_error > input.clearance.least_external()) return 1;
  std::vector<Vector3d> points;
  const double slack = slack_of(input);
  for (const Vector3d& p : input.points) {
    if (input.clearance(p).lower >= 0.0 || input.distance(p, slack).triangle >= 0) {
      points.push_back(p);
    }
  }
  if (points.empty()) return 1;
  Packing packing(input, std::move(points));
  double best = 1.0;
  for (int round = 0; round < kRounds && !input.stop.stop_requested(); ++round) {
    packing.balance();
    std::vector<Rows> heavy;
    best = std::max(best, packing.prove(heavy, [&](double share) {
      if (input.progress) input.progress((round + share) / kRounds, "proving a lower bound");
    }));
    packing.learn(std::move(heavy));
  }
  return static_cast<std::size_t>(std::ceil(best * (1.0 - kRounding) - kRounding));
}

}  // namespace spherule::internal
