// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/flood_grid.h"

#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/stage1/flood_refinement.h"
#include "simplifier/types/simplification.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace spherule::internal {

using Eigen::Vector3d;

LocalDiameter::LocalDiameter(double diameter, double step, std::span<const Zone> zones,
                             std::span<const double> zone_steps)
    : radius_(diameter / 2.0), least_radius_(radius_), zones_(zones) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    Part part{zones[i].min_external_diameter.value_or(diameter) / 2.0, 0};
    // So many are refused by whoever makes the grid.
    constexpr int kMostHalvings = 64;
    while (part.halvings < kMostHalvings && std::ldexp(step, -part.halvings) > zone_steps[i]) {
      ++part.halvings;
    }
    most_halvings_ = std::max(most_halvings_, part.halvings);
    least_radius_ = std::min(least_radius_, part.radius);
    parts_.push_back(part);
  }
}

LocalDiameter::Needed LocalDiameter::needed(const Vector3d& from, const Vector3d& to) const {
  Needed least{radius_, kNoZone};
  zones_.holding(from, to, [&](std::size_t i) {
    if (parts_[i].radius < least.radius && certainly_contains(zones_[i].shape, from) &&
        (from == to || certainly_contains(zones_[i].shape, to))) {
      least = {parts_[i].radius, static_cast<std::uint32_t>(i)};
    }
  });
  return least;
}

LocalDiameter::Near LocalDiameter::near(const Vector3d& center, double reach) const {
  Near result{radius_, radius_, 0};
  zones_.near(center, reach, [&](std::size_t i) {
    const ZoneShape& shape = zones_[i].shape;
    // A zone that would change nothing need not be examined.
    if (parts_[i].radius >= result.greatest && parts_[i].halvings <= result.halvings &&
        parts_[i].radius >= result.least) {
      return reach;
    }
    if (distance_lower(shape, center) > reach) return reach;
    result.least = std::min(result.least, parts_[i].radius);
    result.halvings = std::max(result.halvings, parts_[i].halvings);
    if (parts_[i].radius < result.greatest && certainly_contains(shape, center, reach)) {
      result.greatest = parts_[i].radius;
    }
    return reach;
  });
  return result;
}

namespace {

// What is advised has some room.
constexpr double kMargin = 1.2;
constexpr double kEdgeMargin = 1.1;

std::string too_many(double count, double edge, double most) {
  const double larger = kMargin * count / most;
  std::ostringstream reason;
  reason << std::setprecision(3) << "too fine for a model of this size: up to " << count
         << " cells with an edge of " << edge << " would be needed, and " << most
         << " is the most; with a min external diameter " << std::ceil(10.0 * larger) / 10.0
         << " times as large, or both it and the max error "
         << std::ceil(10.0 * std::sqrt(larger)) / 10.0
         << " times, or with the model in parts, memory suffices";
  if (most < static_cast<double>(ExternalOptions::kMostCells)) {
    reason << "; max_cells may be larger";
  }
  return reason.str();
}

}  // namespace

TooManyCells::TooManyCells(double most_foreseen, double least_foreseen, double edge,
                           std::size_t max_cells)
    : Error("grid step", too_many(most_foreseen, edge, static_cast<double>(max_cells))),
      coarsening_(kEdgeMargin * std::sqrt(least_foreseen / static_cast<double>(max_cells))) {}

namespace {

// Width of the layer of nodes that is kept at the finest step, in steps (docs/covering.md, stage
// 1).
constexpr double kLayer = 1.2;
// Cells that are examined between two reports of progress: siblings stay together.
constexpr std::size_t kPart = std::size_t{1} << 20;
// From the finest level: where the number of cells is foreseen, and by how much too large that may
// be. Large cells may turn out to be out of reach, or get a sphere of their own.
constexpr std::array<double, 4> kForeseenOver = {1.0, 1.0, 2.0, 8.0};

}  // namespace

FloodGrid::FloodGrid(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
                     const Shape& shape, const Progress& progress)
    : distance_(distance),
      padding_(padding),
      displacement_(distance, padding),
      diameter_(diameter),
      shape_(shape),
      levels_(shape.levels + diameter.most_halvings()) {
  assert(levels_ <= kMostLevels);
  for (int level = 0; level <= kMostLevels; ++level) {
    edges_[static_cast<std::size_t>(level)] = std::ldexp(shape_.step, shape_.levels - level);
  }
  rounding_ = 16.0 * kUnitRoundoff * (shape_.origin.cwiseAbs().maxCoeff() + edge(0));
  cells_.push_back({});
  DisjointSets lasting(1);
  std::size_t begin = 0;
  for (int level = 0; level <= levels_; ++level) {
    examine_level(level, begin, progress);
    const std::vector<std::size_t> mixed = cells_to_halve(begin, lasting);
    check_memory(level, mixed.size());
    begin = cells_.size();
    for (const std::size_t i : mixed) halve(i);
  }
}

void FloodGrid::examine_level(int level, std::size_t first, const Progress& progress) {
  const std::size_t count = cells_.size() - first;
  const double before = level == 0 ? 0.0 : std::ldexp(1.0, 2 * (level - 1 - levels_));
  const double after = std::ldexp(1.0, 2 * (level - levels_));
  for (std::size_t done = 0; done < count; done += std::min(kPart, count - done)) {
    const std::size_t begin = first + done;
    examine(begin, begin + std::min(kPart, count - done));
    const double part =
        static_cast<double>(std::min(done + kPart, count)) / static_cast<double>(count);
    if (progress) progress(0.9 * (before + part * (after - before)), "flooding");
  }
}

std::vector<std::size_t> FloodGrid::cells_to_halve(std::size_t begin, DisjointSets& lasting) {
  std::vector<std::size_t> mixed;
  for (std::size_t i = begin; i < cells_.size(); ++i) {
    if (cells_[i].state == State::kMixed) mixed.push_back(i);
  }
  if (mixed.empty()) return mixed;
  lasting.grow(cells_.size() + 1);
  for (std::size_t i = begin; i < cells_.size(); ++i) {
    if (cells_[i].state != State::kMixed) unite_neighbours(i, begin, lasting);
  }
  DisjointSets sets = lasting;
  for (const std::size_t i : mixed) unite_neighbours(i, cells_.size(), sets);
  std::erase_if(mixed, [&](std::size_t i) { return sets.find(element(i)) != sets.find(0); });
  find_own_spheres(mixed);
  for (const std::size_t i : mixed) {
    if (cells_[i].state == State::kOwnSphere) unite_neighbours(i, begin, lasting);
  }
  std::erase_if(mixed, [&](std::size_t i) { return cells_[i].state != State::kMixed; });
  return mixed;
}

// Those of finer cells are united from there.
void FloodGrid::unite_neighbours(std::size_t i, std::size_t mixed_from, DisjointSets& sets) const {
  const Entry& cell = cells_[i];
  if (cell.state == State::kBlocked) return;
  for_each_face_neighbour(cell.level, decode(cell.code), [&](std::size_t other, const Index&) {
    if (other == cells_.size()) {
      sets.unite(0, element(i));
      return;
    }
    const bool is_left_out = cells_[other].state == State::kBlocked ||
                             (cells_[other].state == State::kMixed && other >= mixed_from);
    if (!is_left_out && may_share_places(cell, cells_[other])) {
      sets.unite(element(i), element(other));
    }
  });
}

// Cells around a surface become four times as many with every level once they are smaller than the
// radius rho that a sphere must have there; those of zones do not.
void FloodGrid::check_memory(int level, std::size_t halved) const {
  double next = 8.0 * static_cast<double>(halved);
  double total = static_cast<double>(cells_.size()) + next;
  const auto most = static_cast<double>(shape_.grid_cells);
  const auto ahead = static_cast<std::size_t>(levels_ - level);
  double over = 1.0;
  if (diameter_.most_halvings() == 0 && ahead < kForeseenOver.size()) {
    over = kForeseenOver[ahead];
    for (int finer = level + 1; finer < levels_; ++finer) {
      next *= 4.0;
      total += next;
    }
  }
  if (total <= over * most) return;
  throw TooManyCells(total, total / over, edge(levels_), shape_.grid_cells);
}

void FloodGrid::halve(std::size_t cell) {
  const Entry parent = cells_[cell];
  cells_[cell].state = State::kRefined;
  cells_[cell].finest = false;
  cells_[cell].index = static_cast<std::uint32_t>(cells_.size());
  for (std::uint64_t k = 0; k < 8; ++k) {
    cells_.push_back(
        {.code = parent.code << 3 | k, .level = static_cast<std::uint8_t>(parent.level + 1)});
  }
}

// Half the diagonal, with room for the rounding of centres and faces.
double FloodGrid::half_diagonal(int level) const {
  return 0.8660254037844387 * edge(level) * (1.0 + 1e-9) + rounding();
}

void FloodGrid::classify(Entry& cell, const Eigen::Vector3d& middle,
                         const SurfaceDistance& d) const {
  const int level = cell.level;
  const double reach = half_diagonal(level);
  cell.clearance = std::max(0.0, sub_down(d.lower, padding_));
  // What no zone can change is known without searching for zones.
  if (level < shape_.levels) {
    if (cell.clearance - reach >= diameter_.radius() + kLayer * shape_.step) {
      cell.state = State::kFree;
      return;
    }
    if (d.upper - padding_ + reach < diameter_.least_radius()) {
      cell.state = State::kBlocked;
      return;
    }
  }
  const LocalDiameter::Near rho = diameter_.near(middle, reach);
  cell.finest = level >= shape_.levels + rho.halvings;
  if (cell.finest) {
    const LocalDiameter::Needed needed = diameter_.at(middle);
    cell.index = needed.zone;
    cell.state = cell.clearance >= needed.radius ? State::kFree : State::kBlocked;
  } else if (cell.clearance - reach >=
             rho.greatest + kLayer * std::ldexp(shape_.step, -rho.halvings)) {
    cell.state = State::kFree;
  } else if (d.upper - padding_ + reach < rho.least) {
    cell.state = State::kBlocked;
  } else {
    cell.state = State::kMixed;
  }
}

void FloodGrid::examine(std::size_t begin, std::size_t end) {
  // Children of one cell: what is near to one is not much further from the others.
  parallel_for(0, (end - begin + 7) / 8, [&](std::size_t family) {
    const std::size_t first = begin + 8 * family;
    double limit = std::numeric_limits<double>::infinity();
    double gap = 0.0;
    for (std::size_t i = first; i < std::min(first + 8, end); ++i) {
      const Eigen::Vector3d middle = center(cells_[i]);
      const SurfaceDistance d = distance_(middle, limit);
      limit = d.upper + 4.0 * half_diagonal(cells_[i].level);
      gap = std::max(gap, d.upper - d.lower);
      classify(cells_[i], middle, d);
    }
    double known = widest_bounds_;
    while (gap > known && !widest_bounds_.compare_exchange_weak(known, gap)) {
    }
  });
}

void FloodGrid::examine_and_halve(std::size_t begin) {
  while (begin < cells_.size()) {
    const std::size_t end = cells_.size();
    examine(begin, end);
    for (std::size_t i = begin; i < end; ++i) {
      if (cells_[i].state == State::kMixed) halve(i);
    }
    begin = end;
  }
}

FloodGrid::OwnSphere FloodGrid::own_sphere(const Entry& cell) const {
  const Eigen::Vector3d middle = center(cell);
  const LocalDiameter::Near rho = diameter_.near(middle, half_diagonal(cell.level));
  const double step = std::ldexp(shape_.step, -rho.halvings);
  // Larger ones are held by no two balls, and a finest one has no finer ones.
  if (edge(cell.level) > rho.least || edge(cell.level) < 1.5 * step) return {};
  const PlaceCell place{.box = {middle, Eigen::Vector3d::Constant(half_edge(cell.level))},
                        .rho = rho.least,
                        .step = step,
                        .surface_at_most = cell.clearance + padding_ + widest_bounds_};
  const std::optional<SphereOfPlaces> wanted = wanted_sphere(distance_, padding_, place);
  // A sphere that needs more room on its path to the cell than in it might not get there.
  if (!wanted || diameter_.on_segment(wanted->sphere.center, middle) > rho.least) return {};
  const std::optional<std::uint32_t> around = free_cell_around(cell.level, wanted->sphere);
  if (!around) return {};
  const std::optional<Sphere> sphere = sphere_of_places(distance_, padding_, place, *wanted);
  return sphere ? OwnSphere{*sphere, *around} : OwnSphere{};
}

std::optional<std::uint32_t> FloodGrid::free_cell_around(int level, const Sphere& wanted) const {
  const Eigen::Array3d index = (wanted.center - shape_.origin).array() / edge(level);
  if ((index < 0.0).any() || (index >= std::ldexp(1.0, level)).any()) return 0;
  const std::size_t found =
      locate(level, {static_cast<std::uint32_t>(index[0]), static_cast<std::uint32_t>(index[1]),
                     static_cast<std::uint32_t>(index[2])});
  if (found >= cells_.size()) return std::nullopt;
  const Entry& cell = cells_[found];
  const bool is_coarse_and_free = cell.state == State::kFree && !cell.finest;
  // From its centre the surface is not so far that the sphere might be free.
  const double most = cell.clearance + (wanted.center - center(cell)).norm() + shape_.step;
  if (!is_coarse_and_free || most < wanted.radius) return std::nullopt;
  return element(found);
}

// The places of a cell with a sphere of its own lie in that.
bool FloodGrid::may_share_places(const Entry& a, const Entry& b) const {
  if (a.state != State::kOwnSphere && b.state != State::kOwnSphere) return true;
  const auto box = [this](const Entry& cell) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(half_edge(cell.level));
    return Eigen::AlignedBox3d(center(cell) - half, center(cell) + half);
  };
  const Eigen::AlignedBox3d face = box(a).intersection(box(b));
  const auto meets = [&](const Entry& cell) {
    if (cell.state != State::kOwnSphere) return true;
    const Sphere& sphere = own_spheres_[cell.index].sphere;
    constexpr double kRounded = 1.0 - 1e-12;  // of the distance
    return face.exteriorDistance(sphere.center) * kRounded <= sphere.radius;
  };
  if (!meets(a) || !meets(b)) return false;
  if (a.state != b.state) return true;
  const Sphere& one = own_spheres_[a.index].sphere;
  const Sphere& other = own_spheres_[b.index].sphere;
  return distance_lower(one.center, other.center) <= add_up(one.radius, other.radius);
}

void FloodGrid::find_own_spheres(const std::vector<std::size_t>& mixed) {
  if (!shape_.own_spheres) return;
  std::vector<OwnSphere> found(mixed.size());
  parallel_for(0, mixed.size(), [&](std::size_t k) { found[k] = own_sphere(cells_[mixed[k]]); });
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    if (found[k].sphere.radius == 0.0) continue;
    cells_[mixed[k]].state = State::kOwnSphere;
    cells_[mixed[k]].index = static_cast<std::uint32_t>(own_spheres_.size());
    own_spheres_.push_back(found[k]);
  }
}

std::size_t FloodGrid::locate(int level, const Index& index) const {
  std::size_t cell = 0;
  for (int l = 0; cells_[cell].state == State::kRefined; ++l) {
    if (l == level) return cells_.size();
    const int shift = level - l - 1;
    const std::uint32_t child = ((index[0] >> shift) & 1U) | ((index[1] >> shift) & 1U) << 1 |
                                ((index[2] >> shift) & 1U) << 2;
    cell = cells_[cell].index + child;
  }
  return cell;
}

double FloodGrid::needed_between(const Entry& a, const Entry& b) const {
  if (a.index == LocalDiameter::kNoZone || b.index == LocalDiameter::kNoZone) {
    return diameter_.radius();
  }
  if (a.index == b.index) return diameter_.radius_of(a.index);
  return diameter_.on_segment(center(a), center(b));
}

bool FloodGrid::passes(const Entry& a, const Entry& b, const Eigen::Vector3d& face) const {
  if (a.state == State::kOwnSphere || b.state == State::kOwnSphere) {
    return passes_between_centers(a, b, 0);
  }
  if (!a.finest && !b.finest) return true;
  const auto suffices = [](double sum, double length, double rho) {
    return sub_down(sum, length) >= 2.0 * rho * kRelativeUp;
  };
  const Eigen::Vector3d from = center(a);
  const Eigen::Vector3d to = center(b);
  if (a.finest && b.finest) {
    const double length =
        a.level == b.level ? edge(a.level) * (1.0 + 1e-9) + rounding() : distance_upper(from, to);
    const double sum = a.clearance + b.clearance;
    return suffices(sum, length, diameter_.radius()) ||
           (suffices(sum, length, diameter_.least_radius()) &&
            suffices(sum, length, needed_between(a, b)));
  }
  const Entry& node = a.finest ? a : b;
  const Entry& coarse = a.finest ? b : a;
  const Eigen::Vector3d& start = a.finest ? from : to;
  const Eigen::Vector3d& end = a.finest ? to : from;
  const double length = add_up(distance_upper(start, face), rounding());
  const double at_face = sub_down(coarse.clearance, add_up(distance_upper(face, end), rounding()));
  const auto has_room = [&](double rho) {
    return suffices(node.clearance + at_face, length, rho) ||
           sub_down(node.clearance, length) >= rho * kRelativeUp;
  };
  return has_room(diameter_.radius()) ||
         (has_room(diameter_.least_radius()) && has_room(diameter_.on_segment(start, face)));
}

bool FloodGrid::passes_between_centers(const Entry& a, const Entry& b, int bisections) const {
  const Sphere from = sphere_of(a);
  const Sphere to = sphere_of(b);
  return displacement_.is_free(from, to, diameter_.on_segment(from.center, to.center), bisections);
}

void FloodGrid::connect(std::size_t cell) {
  const Entry& self = cells_[cell];
  if (!self.has_sphere()) return;
  if (self.state == State::kOwnSphere) {
    sets_.unite(own_spheres_[self.index].around, element(cell));
  }
  const Index at = decode(self.code);
  for_each_face_neighbour(self.level, at, [&](std::size_t other, const Index& index) {
    if (other == cells_.size()) {
      if (self.state == State::kFree) sets_.unite(0, element(cell));
    } else if (cells_[other].has_sphere()) {
      const Eigen::Vector3d face = (center(self) + center(self.level, index)) / 2.0;
      if (passes(self, cells_[other], face)) {
        sets_.unite(element(cell), element(other));
      } else {
        uncertain_.emplace_back(static_cast<std::uint32_t>(cell),
                                static_cast<std::uint32_t>(other));
      }
    }
  });
}

void FloodGrid::reach_on() {
  std::vector<Pair> tried;
  std::vector<char> passes;
  do {
    tried.clear();
    std::erase_if(uncertain_, [&](const Pair& pair) {
      const bool first = is_reached(pair.first);
      const bool second = is_reached(pair.second);
      if (first != second) tried.push_back(pair);
      return first || second;
    });
    passes.assign(tried.size(), 0);
    parallel_for(0, tried.size(), [&](std::size_t i) {
      passes[i] = passes_between_centers(cells_[tried[i].first], cells_[tried[i].second],
                                         SphereDisplacement::kMostBisections)
                      ? 1
                      : 0;
    });
    for (std::size_t i = 0; i < tried.size(); ++i) {
      if (passes[i] != 0) sets_.unite(element(tried[i].first), element(tried[i].second));
    }
  } while (!tried.empty());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].reached = cells_[i].has_sphere() && is_reached(i);
  }
}

void FloodGrid::flood() {
  sets_.grow(cells_.size() + 1);
  for (std::size_t i = 0; i < cells_.size(); ++i) connect(i);
  reach_on();
}

}  // namespace spherule::internal
