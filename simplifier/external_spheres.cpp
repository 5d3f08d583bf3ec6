// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/concave_edges.h"
#include "simplifier/internal/stages.h"
#include "simplifier/simplify.h"
#include "simplifier/solid/cells.h"
#include "simplifier/stage1/flood_grid.h"
#include "simplifier/stage1/random_placement.h"
#include "simplifier/types/simplification.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::FloodGrid;
using internal::LocalDiameter;

void check_options(const ExternalOptions& options) {
  if (!(options.padding >= 0.0 && options.padding <= kMaxCoordinate)) {
    throw Error("padding", "must be finite and not negative");
  }
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  if (!usable(options.max_error)) throw Error("max error", "must be finite and not negative");
  if (!usable(options.grid_step)) throw Error("grid step", "must be finite and not negative");
  if (!(options.tightness > 0.0 && options.tightness <= ExternalOptions::kNoTightness)) {
    throw Error("tightness", "must be above 0 and at most 10");
  }
  const double infinity = std::numeric_limits<double>::infinity();
  if (options.max_cells == 0 || options.max_cells > ExternalOptions::kMostCells) {
    throw Error("max cells", "must be at least 1 and at most 2^27");
  }
  const bool none = options.placement == ExternalPlacement::kNone;
  check_zones(options.zones, options.max_error > 0.0 ? options.max_error : infinity,
              none ? infinity : options.min_external_diameter);
  if (options.placement != ExternalPlacement::kReachable) {
    if (std::ranges::any_of(options.zones,
                            [](const Zone& z) { return !!z.min_external_diameter; })) {
      throw Error("zones", "a smaller min external diameter needs the placement \"reachable\"");
    }
    if (options.keep_concave_edges) {
      throw Error("keep concave edges", "needs the placement \"reachable\"");
    }
  }
  if (none) return;
  const double d = options.min_external_diameter;
  if (!(d > 0.0 && d <= kMaxCoordinate)) {
    throw Error("min external diameter", "must be positive and finite");
  }
  // Products of four lengths vanish where those are some 1e-80, and distances then have no bounds.
  if (d < 1e-60) throw Error("min external diameter", "is below 1e-60: another unit?");
  if (options.placement == ExternalPlacement::kRandom && options.limit > 100'000'000) {
    throw Error("external limit", "at most 100 million attempts");
  }
}

// Of the coordinates of the box: how far a sphere that is left out may reach into it.
constexpr double kBoxRounding = 1e-12;

Eigen::AlignedBox3d inflated_outwards(const Eigen::AlignedBox3d& box, double by) {
  Eigen::AlignedBox3d inflated;
  for (int axis = 0; axis < 3; ++axis) {
    inflated.min()[axis] = sub_down(box.min()[axis], by);
    inflated.max()[axis] = add_up(box.max()[axis], by);
  }
  return inflated;
}

// The steps of the grid.
struct Steps {
  // The scallops of S along a flat wall, E / 50 with the steps that are chosen, grow with their
  // square: to E / 8 at most, where there would be many cells.
  static constexpr double kCoarsest = 2.5;

  const ExternalOptions* options;
  double coarsening = 1.0;  // of those that are chosen

  double operator()() const { return of(options->min_external_diameter, options->max_error); }
  double operator()(const Zone& zone) const {
    return of(zone.min_external_diameter.value_or(options->min_external_diameter),
              zone.max_error.value_or(options->max_error));
  }

 private:
  // For spheres of this diameter that intersect S with this error.
  double of(double diameter, double max_error) const {
    if (options->grid_step > 0.0) {
      return options->grid_step * (diameter / options->min_external_diameter);
    }
    const double coarsest = diameter / 8.0;
    const double finest =
        max_error > 0.0 ? std::sqrt(0.08 * max_error * diameter / 2.0) : coarsest / 2.0;
    return std::min(coarsest, coarsening * finest);
  }
};

// A cube around the box that leaves a sphere of radius rho and three steps of room on every side.
// Zones halve the step up to `halvings` times.
FloodGrid::Shape grid_shape(const Eigen::AlignedBox3d& box, double rho, double step, int halvings) {
  constexpr int kMostLevels = 20;
  const double edge = box.sizes().maxCoeff() + 2.0 * (rho + 3.0 * step);
  FloodGrid::Shape shape{.origin = Vector3d::Zero(), .step = step};
  // A step that has vanished, of the least diameters there are, never gets there.
  while (shape.levels <= kMostLevels && std::ldexp(step, shape.levels) < edge) ++shape.levels;
  const double magnitude = internal::largest_coordinate(box) + edge;
  const bool is_far = std::ldexp(step, -halvings) < 1e6 * kUnitRoundoff * magnitude;
  if (is_far || shape.levels + halvings > kMostLevels) {
    std::ostringstream reason;
    reason << std::setprecision(3) << "too fine for a model ";
    if (is_far && magnitude > 10.0 * edge) {
      reason << "with coordinates of up to " << magnitude << ", which numbers do not tell apart so "
             << "finely: move it nearer to its origin, or choose";
    } else {
      reason << "of this size, which is " << edge / step
             << " steps wide: fit it in parts, or choose";
    }
    throw Error("grid step", reason.str() + " a larger max error or min external diameter");
  }
  shape.origin = box.center() - Vector3d::Constant(std::ldexp(step, shape.levels) / 2.0);
  return shape;
}

void place_reachable(const TriangleMesh& mesh, const MeshDistance& distance, const Steps& steps,
                     std::size_t grid_cells, ExternalSpheres& result) {
  const ExternalOptions& options = *steps.options;
  const double step = steps();
  std::vector<Zone> zones = options.zones;
  if (options.keep_concave_edges) {
    result.concave_edges = concave_edge_zones(
        mesh, {.min_external_diameter = options.min_external_diameter,
               .max_error = options.max_error > 0.0 ? options.max_error
                                                    : options.min_external_diameter / 4.0,
               .padding = result.padding,
               .margin = 2.0 * step});
    zones.insert(zones.end(), result.concave_edges.begin(), result.concave_edges.end());
  }
  std::vector<double> zone_steps;
  for (const Zone& zone : zones) zone_steps.push_back(steps(zone));
  const LocalDiameter diameter(options.min_external_diameter, step, zones, zone_steps);
  FloodGrid::Shape shape =
      grid_shape(result.box, diameter.radius(), step, diameter.most_halvings());
  shape.grid_cells = grid_cells;
  shape.max_cells = options.max_cells;
  std::optional<FloodGrid> made;
  std::optional<double> share;
  using Borders = FloodGrid::ZoneBorders;
  for (const auto& [own_spheres, borders] :
       {std::pair{true, Borders::kOpen}, {true, Borders::kFollowed}, {false, Borders::kFollowed}}) {
    if (share) break;
    // Without zones there is no border.
    if (made && !made->has_zones() && own_spheres) continue;
    shape.own_spheres = own_spheres;
    made.emplace(distance, result.padding, diameter, shape, options.progress);
    made->flood();
    share = made->tighten(options.tightness, borders, options.progress);
  }
  const FloodGrid& grid = *made;
  result.closing_slack = 2.0 * diameter.radius() * share.value();
  result.grid_step = step;
  result.nodes_examined = grid.cells_examined();
  // Zones make the grid so fine that it pays to leave out what lies in a larger sphere.
  result.spheres = zones.empty() ? grid.reached_spheres() : grid.reached_spheres_that_count();
  const std::vector<FloodGrid::Frontier> frontier = grid.frontier();
  std::vector<std::vector<Sphere>> fitted(frontier.size());
  const internal::ConcaveFitSpheres fit(distance, result.padding, diameter, result.spheres);
  internal::parallel_for(0, frontier.size(), [&](std::size_t i) { fitted[i] = fit(frontier[i]); });
  for (const std::vector<Sphere>& spheres : fitted) {
    result.spheres.insert(result.spheres.end(), spheres.begin(), spheres.end());
  }
  if (options.progress) options.progress(1.0, "placing external spheres");
}

// With steps that are coarser where there would be many cells, and as many cells as are allowed
// where that is not enough.
void place_reachable(const TriangleMesh& mesh, const MeshDistance& distance,
                     const ExternalOptions& options, std::size_t most_grid_cells,
                     ExternalSpheres& result) {
  const bool is_chosen = options.grid_step == 0.0;
  // With zones, cells are counted only as they are made.
  const bool is_foreseen = options.zones.empty() && !options.keep_concave_edges;
  Steps steps{&options};
  const std::size_t most = std::min(options.max_cells, most_grid_cells);
  std::size_t grid_cells = is_chosen ? std::min(most, ExternalOptions::kManyCells) : most;
  for (;;) {
    try {
      return place_reachable(mesh, distance, steps, grid_cells, result);
    } catch (const internal::TooManyCells& too_many) {
      if (is_chosen && steps.coarsening < Steps::kCoarsest) {
        const double needed = too_many.coarsening() * steps.coarsening;
        steps.coarsening = is_foreseen ? std::min(Steps::kCoarsest, needed) : Steps::kCoarsest;
      } else if (grid_cells < most) {
        grid_cells = most;
      } else {
        throw;
      }
    }
  }
}

}  // namespace

ExternalSpheres place_external_spheres(const TriangleMesh& mesh, const ExternalOptions& options) {
  validate(mesh, "mesh");
  check_options(options);
  return internal::place_external_spheres(mesh, MeshDistance(mesh), options);
}

ExternalSpheres internal::place_external_spheres(const TriangleMesh& mesh,
                                                 const MeshDistance& distance,
                                                 const ExternalOptions& options,
                                                 std::size_t most_grid_cells) {
  require_rounding_to_nearest();
  check_options(options);
  const ThreadLimit threads(options.threads);
  ExternalSpheres result;
  result.padding = sum_up(options.padding, mesh.vertex_error);
  result.min_external_diameter = options.min_external_diameter;
  result.box = inflated_outwards(distance.box(), result.padding);
  switch (options.placement) {
    case ExternalPlacement::kReachable:
      place_reachable(mesh, distance, options, most_grid_cells, result);
      break;
    case ExternalPlacement::kRandom: {
      internal::RandomPlacement placement = internal::place_random(
          distance, result.padding, options.min_external_diameter / 2.0, result.box, options);
      result.spheres = std::move(placement.spheres);
      result.nodes_examined = placement.attempts;
      break;
    }
    case ExternalPlacement::kNone:
      break;
  }
  // What does not meet the box, or by rounding only, as beside a face of the box that is one of the
  // mesh, takes nothing from S.
  const double magnitude = internal::largest_coordinate(result.box);
  std::erase_if(result.spheres, [&](const Sphere& s) {
    return result.box.exteriorDistance(s.center) + kBoxRounding * (magnitude + s.radius) >=
           s.radius;
  });
  return result;
}

ExternalSpheres internal::place_with_default_diameter(const TriangleMesh& mesh,
                                                      const MeshDistance& distance,
                                                      const ExternalOptions& options) {
  constexpr double kLargest = 0.1;  // of the diagonal of the box
  // So that the steps are those of the same D where it is requested: an audit finds the same S.
  static_assert(ExternalOptions::kManyCells <= ExternalOptions::kMostCells / 4);
  const double largest = kLargest * distance.box().diagonal().norm();
  const bool is_foreseen = options.zones.empty() && !options.keep_concave_edges;
  ExternalOptions chosen = options;
  while (is_foreseen && chosen.min_external_diameter <= largest) {
    try {
      return place_external_spheres(mesh, distance, chosen, options.max_cells / 4);
    } catch (const TooManyCells& too_many) {
      chosen.min_external_diameter *= too_many.coarsening();
    }
  }
  return place_external_spheres(mesh, distance, options);
}

}  // namespace spherule
