// SPDX-License-Identifier: BSD-3-Clause
#include "bench/closing/closed_solid.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace spherule::closing {
namespace {

// The lower envelope of parabolas along one line.
class Envelope {
 public:
  explicit Envelope(std::size_t count) : apex_(count), from_(count + 1), height_(count) {}

  void operator()(float* line, std::size_t count, std::size_t stride) {
    std::size_t used = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const double height = line[q * stride];
      if (height >= kFar) continue;
      const auto at = static_cast<double>(q);
      double from = -std::numeric_limits<double>::infinity();
      while (used > 0) {
        const double other = apex_[used - 1];
        from = (height + at * at - height_[used - 1] - other * other) / (2.0 * (at - other));
        if (from > from_[used - 1]) break;
        --used;
      }
      if (used == 0) from = -std::numeric_limits<double>::infinity();
      apex_[used] = at;
      height_[used] = height;
      from_[used++] = from;
    }
    if (used == 0) return;
    std::size_t k = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const auto at = static_cast<double>(q);
      while (k + 1 < used && from_[k + 1] < at) ++k;
      const double away = at - apex_[k];
      line[q * stride] = static_cast<float>(away * away + height_[k]);
    }
  }

 private:
  std::vector<double> apex_;
  std::vector<double> from_;
  std::vector<double> height_;
};

}  // namespace

void transform_distances(const Grid& grid, std::vector<float>& heights) {
  const auto nx = static_cast<std::size_t>(grid.count[0]);
  const auto ny = static_cast<std::size_t>(grid.count[1]);
  const auto nz = static_cast<std::size_t>(grid.count[2]);
  in_parallel(nz, [&](std::size_t z) {
    Envelope along_x(nx);
    Envelope along_y(ny);
    float* const layer = heights.data() + z * nx * ny;
    for (std::size_t y = 0; y < ny; ++y) along_x(layer + y * nx, nx, 1);
    for (std::size_t x = 0; x < nx; ++x) along_y(layer + x, ny, nx);
  });
  in_parallel(ny, [&](std::size_t y) {
    Envelope along_z(nz);
    for (std::size_t x = 0; x < nx; ++x) along_z(heights.data() + y * nx + x, nz, nx * ny);
  });
}

namespace {

using Eigen::Vector3d;

// Of the mesh's distance, kept in single precision, and of sums with it.
constexpr double kRounding = 1e-6;

Grid grid_around(const Eigen::AlignedBox3d& box, double rho, double step) {
  const Vector3d room = Vector3d::Constant(rho + 4.0 * step);
  Grid grid{.origin = box.min() - room, .step = step, .count = {}};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    grid.count[a] = static_cast<int>(std::ceil((box.sizes()[axis] + 2.0 * room[axis]) / step)) + 1;
  }
  return grid;
}

// The part of `coarse` within `half` steps of the node, of finer steps.
Grid finer_grid(const Grid& coarse, const Index& center, int half, int pieces) {
  Grid grid{.origin = {}, .step = coarse.step / pieces, .count = {}};
  Index first{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = std::max(center[a] - half, 0);
    const int last = std::min(center[a] + half, coarse.count[a] - 1);
    grid.count[a] = (last - first[a]) * pieces + 1;
  }
  grid.origin = coarse.point(first);
  return grid;
}

}  // namespace

ClosedSolid::ClosedSolid(const TriangleTree& mesh, const Eigen::AlignedBox3d& box, double rho,
                         double step)
    : mesh_(mesh), rho_(rho), grid_(grid_around(box, rho, step)), is_whole_(true) {
  measure();
  std::vector<std::size_t> waiting{0};
  free_.assign(grid_.size(), 0);
  possible_.assign(grid_.size(), 0);
  free_[0] = possible_[0] = 1;
  spread_free(waiting);
  waiting = {0};
  spread_possible(waiting, nullptr);
}

ClosedSolid::ClosedSolid(const ClosedSolid& coarse, const Index& center, int half, int pieces)
    : mesh_(coarse.mesh_),
      rho_(coarse.rho_),
      grid_(finer_grid(coarse.grid_, center, half, pieces)),
      is_whole_(false) {
  measure();
  free_.assign(grid_.size(), 0);
  possible_.assign(grid_.size(), 0);
  std::vector<std::size_t> free_seeds;
  std::vector<std::size_t> possible_seeds;
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    const Index i = grid_.index(node);
    if (distance_[node] >= rho_ - grid_.half_diagonal() && grid_.depth(i) == 0) {
      possible_seeds.push_back(node);
    }
    if (i[0] % pieces != 0 || i[1] % pieces != 0 || i[2] % pieces != 0) continue;
    Index same{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int first = std::max(center[a] - half, 0);
      same[a] = first + i[a] / pieces;
    }
    // The same point, but for rounding.
    if (coarse.free_[coarse.grid_.at(same)] != 0 && distance_[node] >= rho_ * (1.0 + kRounding)) {
      free_[node] = 1;
      free_seeds.push_back(node);
    }
  }
  spread_free(free_seeds);
  std::erase_if(possible_seeds, [&](std::size_t node) {
    return !coarse.touches_possible(grid_.point(node), grid_.step);
  });
  for (const std::size_t node : possible_seeds) possible_[node] = 1;
  spread_possible(possible_seeds, &coarse);
}

void ClosedSolid::measure() {
  distance_.resize(grid_.size());
  constexpr int kBlock = 8;
  const auto blocks = [&](std::size_t a) {
    return static_cast<std::size_t>((grid_.count[a] + kBlock - 1) / kBlock);
  };
  in_parallel(blocks(0) * blocks(1) * blocks(2), [&](std::size_t n) {
    const auto at = [&](std::size_t k) { return static_cast<int>(k) * kBlock; };
    measure_cube({at(n % blocks(0)), at(n / blocks(0) % blocks(1)), at(n / blocks(0) / blocks(1))},
                 kBlock, std::numeric_limits<double>::infinity());
  });
}

void ClosedSolid::measure_cube(const Index& low, int edge, double limit) {
  if (!grid_.contains(low)) return;
  const double from_middle = 0.5 * (edge - 1) * grid_.step;
  const Vector3d middle = grid_.point(low) + Vector3d::Constant(from_middle);
  const double distance = mesh_.distance(middle, limit);
  if (edge == 1) {
    distance_[grid_.at(low)] = static_cast<float>(distance);
    return;
  }
  const double reach = std::sqrt(3.0) * from_middle;
  const double e = grid_.half_diagonal();
  const bool is_far = distance - reach > rho_ + 2.5 * e;
  if (!is_far && distance + reach >= rho_ - 1.5 * e) {
    const int half = edge / 2;
    const double child_limit = distance + 2.0 * reach + grid_.step;
    for (int k = 0; k < 8; ++k) {
      measure_cube(
          {low[0] + (k & 1) * half, low[1] + (k >> 1 & 1) * half, low[2] + (k >> 2) * half}, half,
          child_limit);
    }
    return;
  }
  for (int z = low[2]; z < std::min(low[2] + edge, grid_.count[2]); ++z) {
    for (int y = low[1]; y < std::min(low[1] + edge, grid_.count[1]); ++y) {
      for (int x = low[0]; x < std::min(low[0] + edge, grid_.count[0]); ++x) {
        const double way = (grid_.point({x, y, z}) - middle).norm();
        distance_[grid_.at({x, y, z})] =
            static_cast<float>(is_far ? distance - way : distance + way);
      }
    }
  }
}

bool ClosedSolid::touches_possible(const Vector3d& p, double edge) const {
  std::array<std::array<int, 2>, 3> ends{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const double at = (p[axis] - grid_.origin[axis]) / grid_.step + 0.5;
    const double half = (0.5 * edge / grid_.step) * (1.0 + kRounding) + kRounding;
    ends[a] = {static_cast<int>(std::floor(at - half)), static_cast<int>(std::floor(at + half))};
  }
  for (int k = 0; k < 8; ++k) {
    const auto end = [&](std::size_t a) { return ends[a][static_cast<std::size_t>(k >> a & 1)]; };
    const Index i{end(0), end(1), end(2)};
    if (!grid_.contains(i) || possible_[grid_.at(i)] != 0) return true;
  }
  return false;
}

void ClosedSolid::spread_possible(std::vector<std::size_t>& waiting, const ClosedSolid* coarse) {
  while (!waiting.empty()) {
    const std::size_t node = waiting.back();
    waiting.pop_back();
    grid_.for_each_face_neighbour(node, [&](std::size_t other) {
      if (possible_[other] != 0 || distance_[other] < rho_ - grid_.half_diagonal()) return;
      if (coarse != nullptr && !coarse->touches_possible(grid_.point(other), grid_.step)) return;
      possible_[other] = 1;
      waiting.push_back(other);
    });
  }
}

// By bisection: on a piece of the way the distance is at least the mean of its ends' less half its
// length.
bool ClosedSolid::passes(const Vector3d& a, double at_a, const Vector3d& b, double at_b,
                         int depth) const {
  constexpr int kMaxDepth = 6;
  const double least = rho_ * (1.0 + kRounding);
  const double way = (b - a).norm();
  if (at_a + at_b - way >= 2.0 * least) return true;
  if (depth == kMaxDepth) return false;
  const Vector3d middle = (a + b) / 2.0;
  const double at_middle = mesh_.distance(middle, std::min(at_a, at_b) + way);
  return at_middle >= least && passes(a, at_a, middle, at_middle, depth + 1) &&
         passes(middle, at_middle, b, at_b, depth + 1);
}

void ClosedSolid::spread_free(std::vector<std::size_t>& waiting) {
  const double least = rho_ * (1.0 + kRounding);
  std::vector<std::pair<std::size_t, std::size_t>> uncertain;
  while (!waiting.empty()) {
    while (!waiting.empty()) {
      const std::size_t node = waiting.back();
      waiting.pop_back();
      grid_.for_each_face_neighbour(node, [&](std::size_t other) {
        if (free_[other] != 0 || distance_[other] < least) return;
        if (distance_[node] + distance_[other] - grid_.step >= 2.0 * least) {
          free_[other] = 1;
          waiting.push_back(other);
        } else {
          uncertain.emplace_back(node, other);
        }
      });
    }
    // Those to what is reached by now need no test.
    for (const auto& [node, other] : uncertain) {
      if (free_[other] != 0 ||
          !passes(grid_.point(node), distance_[node], grid_.point(other), distance_[other], 0)) {
        continue;
      }
      free_[other] = 1;
      waiting.push_back(other);
    }
    uncertain.clear();
  }
}

// A cube is out of C as a whole if the sphere around one free node holds it. C lies in the others.
std::vector<float> ClosedSolid::least_distances() const {
  const double e = grid_.half_diagonal();
  // More adds nothing: such spheres overlap.
  const double most = rho_ + 4.0 * grid_.step;
  std::vector<float> field(grid_.size(), kFar);
  for (std::size_t node = 0; node < field.size(); ++node) {
    if (free_[node] == 0) continue;
    const double known = std::min(distance_[node] * (1.0 - kRounding), most);
    const double radius = (known - e) / grid_.step;
    if (radius > 0.0) field[node] = static_cast<float>(-radius * radius);
  }
  transform_distances(grid_, field);
  for (float& power : field) power = power > -0.05F ? 0.0F : kFar;
  transform_distances(grid_, field);
  for (std::size_t node = 0; node < field.size(); ++node) {
    const double known = is_whole_ ? kFar : grid_.depth(grid_.index(node)) * grid_.step;
    const double way = std::min(std::sqrt(field[node]) * grid_.step, known) - e;
    field[node] = static_cast<float>(std::max(0.0, way));
  }
  return field;
}

// Every open sphere that is out of C lies in one of radius rho + e around a possible node. Nodes
// out of all these are in C.
std::vector<float> ClosedSolid::greatest_distances() const {
  const double reach = (rho_ + grid_.half_diagonal()) / grid_.step;
  std::vector<float> field(grid_.size(), kFar);
  for (std::size_t node = 0; node < field.size(); ++node) {
    if (possible_[node] != 0) field[node] = 0.0F;
  }
  transform_distances(grid_, field);
  const auto squared_reach = static_cast<float>(reach * reach + 0.05);
  for (std::size_t node = 0; node < field.size(); ++node) {
    // Possible centres beyond the rim of a part are not known.
    const bool is_known = is_whole_ || grid_.depth(grid_.index(node)) >= reach + 1.0;
    field[node] = is_known && field[node] >= squared_reach ? 0.0F : kFar;
  }
  transform_distances(grid_, field);
  for (float& squared : field) {
    squared = squared >= kFar ? kFar : static_cast<float>(std::sqrt(squared) * grid_.step);
  }
  return field;
}

}  // namespace spherule::closing
