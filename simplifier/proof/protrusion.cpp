// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/protrusion.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr double kRelativeTolerance = 0.02;

// Distance from `c` to some point of S.
double distance_to_solid(const Clearance& clearance, const MeshDistance& distance,
                         const Vector3d& c, double radius) {
  double nearest = distance(c).upper;
  for (const AscentStep& step :
       ascend(clearance, c, {.first_step = 0.01 * radius, .least_step = 1e-4 * radius})) {
    if (step.clearance >= 0.0) nearest = std::min(nearest, distance_upper(c, step.point));
  }
  if (const auto near = solid_point_in_groove(clearance, c, 0x1p-30 * nearest, nearest)) {
    nearest = std::min(nearest, distance_upper(c, *near));
  }
  return nearest;
}

struct Cell {
  BoxCell box;
  double upper;  // no point of the spheres in the cell is further from |M|
  bool outside;  // known to be free of M and in no shell
};

bool below(const Cell& a, const Cell& b) {
  return a.upper < b.upper;
}

struct SpheresBound {
  double upper;      // no sphere protrudes further over |M|
  Vector3d witness;  // a point of the sphere that may protrude as far
};

// The open sphere about a centre in |M| that just touches M lies in |M|, so that no point of the
// sphere itself protrudes by more than r - d. The witness is the point of the sphere that is
// furthest along the direction to the nearest point of M or, where the centre is outside, against
// it. It falls short of the sphere by 32 u of the radius and the largest coordinate: certainly_
// contains() charges 8 u, the direction and its product take 6 u, the coordinates of the sum 2 u.
SpheresBound bound_of_spheres(const MeshDistance& distance, const ClosedShells& shells,
                              std::span<const Sphere> spheres) {
  // Nearer to M, rounding may take the shells for either side.
  const double mesh_error = mesh_point_error(distance);
  const auto is_inside = [&](const Vector3d& center, const SurfaceDistance& d) {
    return d.lower > mesh_error && shells.contain(center);
  };
  std::vector<double> each(spheres.size());
  parallel_for(0, spheres.size(), [&](std::size_t i) {
    const auto& [center, radius] = spheres[i];
    const SurfaceDistance d = distance(center);
    each[i] = is_inside(center, d) ? sub_up(radius, d.lower) : add_up(radius, d.upper);
  });
  const auto furthest = std::ranges::max_element(each);
  const Sphere& sphere = spheres[static_cast<std::size_t>(furthest - each.begin())];
  SpheresBound result{std::max(*furthest, 0.0), sphere.center};
  const SurfaceDistance d = distance(sphere.center);
  const Vector3d way = d.closest - sphere.center;
  if (way.norm() < kLeastNorm) return result;
  const Vector3d direction = (is_inside(sphere.center, d) ? 1.0 : -1.0) * way.normalized();
  const double short_by = 32.0 * kUnitRoundoff * (sphere.radius + sphere.center.norm());
  const Vector3d tip = sphere.center + (sphere.radius - short_by) * direction;
  if (certainly_contains(sphere, tip)) result.witness = tip;
  return result;
}

}  // namespace

// G2. About a centre in S the sphere whose radius is the clearance d lies in S, and no point of the
// sphere is further from it than r - d; elsewhere none is further than r from the centre, which is
// at some distance from S.
std::vector<double> protrusions_over_solid(const Clearance& clearance, const MeshDistance& distance,
                                           std::span<const Sphere> spheres) {
  std::vector<double> each(spheres.size());
  parallel_for(0, spheres.size(), [&](std::size_t i) {
    const Sphere& sphere = spheres[i];
    const double d = clearance(sphere.center).lower;
    each[i] = d >= 0.0 ? sub_up(sphere.radius, d)
                       : add_up(sphere.radius, distance_to_solid(clearance, distance, sphere.center,
                                                                 sphere.radius));
  });
  return each;
}

double greatest(std::span<const double> protrusions) {
  return std::accumulate(protrusions.begin(), protrusions.end(), 0.0,
                         [](double a, double b) { return std::max(a, b); });
}

double greatest_in(const Zone& zone, std::span<const Sphere> spheres,
                   std::span<const double> protrusions) {
  double result = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (spheres[i].radius < distance_lower(zone.shape, spheres[i].center)) continue;
    result = std::max(result, protrusions[i]);
  }
  return result;
}

Bounds protrusion_over_mesh(const MeshDistance& distance, const ClosedShells& shells,
                            const Clearance& clearance, const SpheresToProve& spheres,
                            double tolerance) {
  Bounds result;
  if (spheres.spheres.empty()) return result;
  const SpheresBound bound = bound_of_spheres(distance, shells, spheres.spheres);
  const Eigen::AlignedBox3d box = box_of(spheres.spheres);
  const double least = least_reach(box);
  std::vector<Cell> heap{{BoxCell::around(box), bound.upper, false}};
  // The greatest distance met in the spheres at a point that is not known to be inside: where the
  // search for the upper bound may stop. It goes on for the lower one, whose witnesses are outside
  // of S, while the inside of an open mesh has been examined by then.
  double met = 0.0;
  bool is_bounded = false;
  const auto is_near = [tolerance](double upper, double lower) {
    return upper <= lower + std::max(tolerance, kRelativeTolerance * lower);
  };
  const auto note = [&](const Vector3d& point, double away, bool is_outside) {
    if (away > met && (is_outside || !shells.contain(point))) met = away;
    if (away > result.lower && clearance(point).upper < 0.0) result.lower = away;
  };
  note(bound.witness, distance(bound.witness).lower, false);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), below);
    Cell cell = heap.back();
    heap.pop_back();
    const Vector3d& q = cell.box.center;
    const double reach = cell.box.reach();
    // Before its bound is made tighter: no cell that is left has a greater one.
    if (!is_bounded && (is_near(cell.upper, met) || reach <= least)) {
      result.upper = std::max(cell.upper, 0.0);
      is_bounded = true;
    }
    if (is_bounded && is_near(cell.upper, result.lower)) break;
    const NearestSphere gap = spheres.hierarchy.nearest(q);
    if (gap.lower > reach) continue;
    const SurfaceDistance d = distance(q);
    if (!cell.outside && d.lower > reach) {
      if (shells.contain(q)) continue;
      cell.outside = true;
    }
    cell.upper = std::min(cell.upper, add_up(d.upper, reach));
    if (gap.upper <= 0.0) note(q, d.lower, cell.outside);
    // Small cells are left as they are: S may come to a point that no centre gets beyond.
    if (is_bounded && (reach <= std::max(tolerance / 2.0, least) || clearance(q).lower >= reach)) {
      continue;
    }
    for (const BoxCell& half : cell.box.halves()) {
      heap.push_back({half, cell.upper, cell.outside});
      std::push_heap(heap.begin(), heap.end(), below);
    }
  }
  return result;
}

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxLines = 4096.0;
constexpr double kMinLines = 256.0;
constexpr double kMaxTests = 1e8;  // of a line with a triangle or sphere

// Lines along one axis, and the coordinates across it.
struct Axes {
  explicit Axes(int axis) : along(axis), first((axis + 1) % 3), second((axis + 2) % 3) {}

  Vector2d across(const Vector3d& p) const { return {p[first], p[second]}; }

  int along;
  int first;
  int second;
};

struct Interval {
  double low;
  double high;
};

// A set of intervals of a line as disjoint ones. Of external spheres, which overlap by the
// thousand, nearly each adds nothing, so that sorting all places where they are crossed would take
// much longer.
class IntervalUnion {
 public:
  void add(const Interval& added) {
    const auto first =
        std::lower_bound(parts_.begin(), parts_.end(), added.low,
                         [](const Interval& part, double at) { return part.high < at; });
    if (first == parts_.end() || first->low > added.high) {
      parts_.insert(first, added);
      return;
    }
    first->low = std::min(first->low, added.low);
    if (first->high >= added.high) return;
    first->high = added.high;
    auto next = first + 1;
    for (; next != parts_.end() && next->low <= first->high; ++next) {
      first->high = std::max(first->high, next->high);
    }
    parts_.erase(first + 1, next);
  }

  double length() const {
    double sum = 0.0;
    for (const Interval& part : parts_) sum += part.high - part.low;
    return sum;
  }

 private:
  std::vector<Interval> parts_;  // in their order along the line
};

// Where a line crosses a closed surface, and by how much its winding number changes there.
struct Crossing {
  std::int32_t surface;
  double at;
  int turn;
};

// Length of the line on which the winding number of any surface is not 0.
double length_inside(std::vector<Crossing> crossings) {
  std::ranges::sort(crossings, {}, [](const Crossing& c) { return std::pair(c.surface, c.at); });
  IntervalUnion inside;
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    if (i > 0 && crossings[i].surface != crossings[i - 1].surface) winding = 0;
    winding += crossings[i].turn;
    if (winding != 0 && crossings[i].surface == crossings[i + 1].surface) {
      inside.add({crossings[i].at, crossings[i + 1].at});
    }
  }
  return inside.length();
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

void cross_triangle(const std::array<Vector3d, 3>& corners, const TriangleRole& role,
                    const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
  std::array<Vector2d, 3> to;
  for (std::size_t k = 0; k < 3; ++k) to[k] = axes.across(corners[k]) - line;
  std::array<double, 3> weights;
  for (std::size_t k = 0; k < 3; ++k) weights[k] = cross(to[(k + 1) % 3], to[(k + 2) % 3]);
  const bool is_front = weights[0] > 0.0 && weights[1] > 0.0 && weights[2] > 0.0;
  const bool is_back = weights[0] < 0.0 && weights[1] < 0.0 && weights[2] < 0.0;
  if (!is_front && !is_back) return;
  double at = 0.0;
  for (std::size_t k = 0; k < 3; ++k) at += weights[k] * corners[k][axes.along];
  at /= weights[0] + weights[1] + weights[2];
  role.for_each_surface(is_front ? 1 : -1, [&](std::int32_t surface, int turn) {
    crossings.push_back({surface, at, turn});
  });
}

// What of the line lies in the sphere, as far as it is within the limits.
void add_sphere(const Sphere& sphere, const Axes& axes, const Vector2d& line,
                const Interval& limits, IntervalUnion& inside) {
  const double squared =
      sphere.radius * sphere.radius - (axes.across(sphere.center) - line).squaredNorm();
  if (!(squared > 0.0)) return;
  const double half = std::sqrt(squared);
  const double middle = sphere.center[axes.along];
  const Interval part{std::max(limits.low, middle - half), std::min(limits.high, middle + half)};
  if (part.low < part.high) inside.add(part);
}

double sum_of(const std::vector<double>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

// One line through each cell of a grid across the shortest side of a box, so that none of them
// misses a thin plate. The cells go pairwise, along the first axis across.
struct Lines {
  Lines(const Eigen::AlignedBox3d& box, double wanted)
      : axes(shortest_of(box)),
        count(static_cast<std::size_t>(std::sqrt(wanted))),
        low(axes.across(box.min())),
        cell(axes.across(box.sizes()) / static_cast<double>(count)),
        area(cell.prod()) {
    Random random(1);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        const double x = static_cast<double>(i) + random.unit();
        const double y = static_cast<double>(j) + random.unit();
        places.push_back(low + cell.cwiseProduct(Vector2d(x, y)));
      }
    }
  }

  static int shortest_of(const Eigen::AlignedBox3d& box) {
    int shortest = 0;
    box.sizes().minCoeff(&shortest);
    return shortest;
  }

  // The sum over all lines of length_on(axes, line).
  template <typename Length>
  double sum_of_lengths(Length length_on) const {
    std::vector<double> lengths(places.size());
    parallel_for(0, places.size(), [&](std::size_t i) { lengths[i] = length_on(axes, places[i]); });
    return sum_of(lengths);
  }

  // Calls cross(place) for the places of a row that lie in a box across.
  template <typename Cross>
  void for_each_in(std::size_t row, const Vector2d& least, const Vector2d& greatest,
                   Cross cross) const {
    const Vector2d from = (least - low).cwiseQuotient(cell);
    const Vector2d to = (greatest - low).cwiseQuotient(cell);
    const auto at = static_cast<double>(row);
    const auto last = static_cast<double>(count) - 1.0;
    if (to.x() < at || from.x() > at + 1.0 || to.y() < 0.0 || from.y() > last + 1.0) return;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(from.y())));
    const auto end = static_cast<std::size_t>(std::min(last, std::floor(to.y()))) + 1;
    for (std::size_t j = begin; j < end; ++j) cross(row * count + j);
  }

  Axes axes;
  std::size_t count;  // rows, and lines in each
  Vector2d low;
  Vector2d cell;
  double area;  // of a cell
  std::vector<Vector2d> places;
};

double number_of_lines(std::size_t things) {
  return std::clamp(kMaxTests / static_cast<double>(things), kMinLines, kMaxLines);
}

}  // namespace

std::optional<double> estimate_volume_ratio(const TriangleMesh& mesh,
                                            const std::vector<TriangleRole>& roles,
                                            std::span<const Sphere> spheres) {
  const Lines through_mesh(box_of(mesh), number_of_lines(mesh.triangles.size()));
  const double solid = through_mesh.sum_of_lengths([&](const Axes& axes, const Vector2d& line) {
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < roles.size(); ++i) {
      cross_triangle(corners_of(mesh, mesh.triangles[i]), roles[i], axes, line, crossings);
    }
    return length_inside(std::move(crossings));
  });
  const Eigen::AlignedBox3d box = box_of(spheres);
  const Lines through_spheres(box, number_of_lines(spheres.size()));
  const double covered =
      through_spheres.sum_of_lengths([&](const Axes& axes, const Vector2d& line) {
        const Interval limits{box.min()[axes.along], box.max()[axes.along]};
        IntervalUnion inside;
        for (const Sphere& sphere : spheres) add_sphere(sphere, axes, line, limits, inside);
        return inside.length();
      });
  const double ratio = covered * through_spheres.area / (solid * through_mesh.area);
  return std::isfinite(ratio) && ratio > 0.0 ? std::optional(ratio) : std::nullopt;
}

EstimatedVolume estimate_filled_volume(const TriangleMesh& mesh,
                                       const std::vector<TriangleRole>& roles,
                                       const ExternalSpheres& external) {
  const Eigen::AlignedBox3d& box = external.box;
  const Lines lines(box, kMaxLines);
  const Axes& axes = lines.axes;
  const Interval limits{box.min()[axes.along], box.max()[axes.along]};
  std::vector<double> filled(lines.places.size());
  parallel_for(0, lines.count, [&](std::size_t row) {
    struct Line {
      std::vector<Crossing> crossings;  // of M
      IntervalUnion outside;            // of the external spheres
    };
    std::vector<Line> inside(lines.count);
    const std::size_t first = row * lines.count;
    for (std::size_t i = 0; i < roles.size(); ++i) {
      const std::array<Vector3d, 3> corners = corners_of(mesh, mesh.triangles[i]);
      const Vector3d least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      const Vector3d greatest = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
      lines.for_each_in(row, axes.across(least), axes.across(greatest), [&](std::size_t place) {
        cross_triangle(corners, roles[i], axes, lines.places[place],
                       inside[place - first].crossings);
      });
    }
    for (const Sphere& sphere : external.spheres) {
      const Vector3d reach = Vector3d::Constant(sphere.radius);
      lines.for_each_in(row, axes.across(sphere.center - reach), axes.across(sphere.center + reach),
                        [&](std::size_t place) {
                          add_sphere(sphere, axes, lines.places[place], limits,
                                     inside[place - first].outside);
                        });
    }
    for (std::size_t j = 0; j < lines.count; ++j) {
      // External spheres and |M| are disjoint.
      filled[first + j] = std::max(0.0, limits.high - limits.low - inside[j].outside.length() -
                                            length_inside(std::move(inside[j].crossings)));
    }
  });
  // Two cells side by side: the square of their difference is, on average, at least the variance of
  // their sum.
  double variance = 0.0;
  for (std::size_t i = 0; i + 1 < filled.size(); i += 2) {
    const double difference = filled[i] - filled[i + 1];
    variance += difference * difference;
  }
  return {lines.area * sum_of(filled), lines.area * std::sqrt(variance)};
}

}  // namespace spherule::internal
