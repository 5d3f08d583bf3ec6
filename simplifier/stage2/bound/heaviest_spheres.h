// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/geometry/point_grid.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/clearance.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

namespace spherule::internal {

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
