// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace spherule::internal {

// The fractional packing of points in sets: weights of points, none negative, as large together as
// possible while no set holds more than 1. It is the dual of the fractional cover of the points by
// the sets, and both are approached together by the primal-dual hybrid gradient method (Chambolle
// and Pock 2011, diagonally preconditioned as in their paper of the same year, restarted from the
// mean of what it has passed). Deterministic on any number of threads.
class FractionalPacking {
 public:
  using Set = std::vector<std::uint32_t>;

  explicit FractionalPacking(std::size_t points);

  // Points that are in no set weigh 0.
  void add(std::vector<Set> sets);

  // Goes on from where the last call ended, for so many steps or until a stop is requested.
  void solve(int steps, const std::stop_token& stop = {});

  // No known set holds more than 1, up to rounding.
  std::vector<double> weights() const;

 private:
  // Both, each per point or set.
  struct Iterate {
    std::vector<double> weights;
    std::vector<double> cover;
  };

  std::vector<double> loads(const std::vector<double>& weights) const;
  std::vector<double> covered_by(const std::vector<double>& cover) const;
  void step(std::vector<double>& extrapolated);
  void restart(Iterate& mean, int steps);

  std::vector<Set> points_of_;  // every set
  std::vector<Set> sets_of_;    // that every point is in
  Iterate now_;
  Iterate last_;          // restart
  double balance_ = 1.0;  // steps of the weights over those of the cover
};

}  // namespace spherule::internal
