// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/pair_witness.h"

#include "robot/model/kinematics.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace spherule::internal {
namespace {

constexpr double kFarthest = 1.0;   // gaps beyond are taken as this, metres
constexpr double kLeastGap = 1e-7;  // a descent that came as near as that ends
constexpr std::size_t kDescents = 4;
constexpr int kSteps = 200;
constexpr double kShrink = 0.9;         // by which a step has to reduce the gap
constexpr double kSmallestStep = 1e-5;  // of the ranges

class Search {
 public:
  Search(const PairSpace& space, std::uint64_t seed)
      : space_(space),
        bits_(seed),
        configuration_(static_cast<std::size_t>(space.robot->variable_count()), 0.0) {}

  PairWitness run(std::size_t samples) {
    struct Sample {
      double gap;
      std::vector<double> values;
    };
    std::vector<Sample> found;
    for (std::size_t n = 0; n < samples; ++n) {
      std::vector<double> values = draw(n % 4 == 3);
      const double gap = gap_at(values, kFarthest);
      if (keep(values, gap)) return best_;
      found.push_back({gap, std::move(values)});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Sample& a, const Sample& b) { return a.gap < b.gap; });
    for (std::size_t i = 0; i < std::min(kDescents, found.size()); ++i) {
      if (descend(std::move(found[i].values), found[i].gap)) break;
    }
    return best_;
  }

 private:
  double even() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

  std::vector<double> draw(bool at_limits) {
    std::vector<double> values;
    for (const FreeBoxes::Variable& variable : space_.variables) {
      const double part = even();
      const double place = at_limits && even() < 0.5 ? (part < 0.5 ? 0.0 : 1.0) : part;
      values.push_back(std::clamp(variable.lower + (variable.upper - variable.lower) * place,
                                  variable.lower, variable.upper));
    }
    return values;
  }

  bool comes_within(const std::vector<double>& values, double clearance) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      configuration_[static_cast<std::size_t>(space_.variables[i].index)] = values[i];
    }
    forward_kinematics(*space_.robot, configuration_, poses_);
    return touches(*space_.of_first, poses_[static_cast<std::size_t>(space_.first)],
                   *space_.of_second, poses_[static_cast<std::size_t>(space_.second)], clearance);
  }

  // To about a tenth; 0 where they touch, and `most` beyond it.
  double gap_at(const std::vector<double>& values, double most) {
    if (!comes_within(values, most)) return most;
    if (comes_within(values, 0.0)) return 0.0;
    double low = 0.0;
    double high = most;
    while (high - low > 0.1 * high && high > kLeastGap) {
      const double middle = 0.5 * (low + high);
      (comes_within(values, middle) ? high : low) = middle;
    }
    return high;
  }

  // Whether they touch.
  bool keep(const std::vector<double>& values, double gap) {
    if (gap >= best_.gap) return best_.touches();
    best_.gap = gap;
    for (std::size_t i = 0; i < values.size(); ++i) {
      configuration_[static_cast<std::size_t>(space_.variables[i].index)] = values[i];
    }
    best_.configuration = configuration_;
    return best_.touches();
  }

  bool descend(std::vector<double> values, double gap) {
    double step = 0.2;
    for (int n = 0; n < kSteps && step > kSmallestStep && gap > kLeastGap; ++n) {
      std::vector<double> next = values;
      for (std::size_t i = 0; i < next.size(); ++i) {
        const FreeBoxes::Variable& variable = space_.variables[i];
        const double change = step * (even() + even() + even() - 1.5);
        next[i] = std::clamp(next[i] + change * (variable.upper - variable.lower), variable.lower,
                             variable.upper);
      }
      if (comes_within(next, kShrink * gap)) {
        values = std::move(next);
        gap = gap_at(values, kShrink * gap);
        if (keep(values, gap)) return true;
        step *= 1.5;
      } else {
        step *= 0.95;
      }
    }
    return false;
  }

  const PairSpace& space_;
  std::mt19937_64 bits_;
  std::vector<double> configuration_;
  std::vector<Pose> poses_;
  PairWitness best_;
};

}  // namespace

PairWitness find_witness(const PairSpace& space, std::size_t samples, std::uint64_t seed) {
  return Search(space, seed).run(samples);
}

}  // namespace spherule::internal
