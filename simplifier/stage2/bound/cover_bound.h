// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"
#include "geometry/mesh_distance.h"
#include "geometry/weld.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

namespace spherule::internal {

struct CoverBoundInput {
  const Clearance& clearance;
  const MeshDistance& distance;
  double max_error;  // E
  // Points of S; those that are not found to be so, up to rounding, are left out.
  std::span<const Eigen::Vector3d> points;
  // Centres of spheres that a cover might use: the better they are, the better the bound.
  std::span<const Eigen::Vector3d> centers;
  // Once requested, what is proved so far is returned, 1 at least.
  std::stop_token stop = {};
  Progress progress = {};
};

// A lower bound of the number of spheres in any cover of S that protrudes from it by at most E
// (docs/covering.md): the value of a fractional packing. Weights are given to points of S so
// that no sphere that a cover may use holds points of more than weight 1 together; as the spheres
// of a cover hold every point, there are at least as many of them as all points weigh. Proved for
// every sphere, and not for a list of them: such a sphere with centre c has at most the radius D(c)
// + E, D the clearance to the outside of S, negative outside (where E is at most the radius of
// every external sphere: the outside of S grown by E is then the union of the external spheres
// shrunk by E), and space is subdivided into cells of centres, each standing for one sphere that
// holds all of its own. Zones only shrink spheres, and the bound stands. Returns 1 where E is
// larger than an external sphere.
std::size_t cover_bound(const CoverBoundInput& input);

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

// Bounds what the spheres that may cover S hold of weighted points: those with a centre c and a
// radius up to D(c) + E, D the clearance to the outside of S, negative outside. Space is subdivided
// into cells of centres; what any sphere of a cell may hold is bounded together.
class HeaviestSpheres {
 public:
  using Held = std::vector<std::uint32_t>;

  // E is at most the radius of every external sphere.
  HeaviestSpheres(const Clearance& clearance, double max_error,
                  std::span<const Eigen::Vector3d> points);

  struct Search {
    std::span<const double> weights;  // of the points
    double finest = 0.0;              // half diagonal of the smallest cells
    double news = 0.0;                // see Found::held
    std::stop_token stop = {};
    std::function<void(double)> tell = {};  // of the share done
  };
  struct Found {
    // For every point at least 1, and at least what any sphere that holds it weighs.
    std::vector<double> about;
    // What cells of spheres heavier than 1 hold, if that was more by this factor for some point
    // than what was known.
    std::vector<Held> held;
  };
  // Nothing, if a stop was requested before the end. Equal on any number of threads.
  Found find(const Search& search) const;

  // What the largest sphere with this centre holds.
  Held held_by(const Eigen::Vector3d& center) const;

  // Above the rounding of the points, and of spheres about them.
  static double slack(const Clearance& clearance, double max_error);

 private:
  class Descent;

  const Clearance& clearance_;
  double error_;
  double slack_;
  std::vector<Eigen::Vector3d> points_;
  PointGrid grid_;
};

}  // namespace spherule::internal
