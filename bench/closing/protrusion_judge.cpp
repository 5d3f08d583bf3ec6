// SPDX-License-Identifier: BSD-3-Clause
#include "bench/closing/protrusion_judge.h"

#include "bench/closing/closed_solid.h"
#include "geometry/median_split.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace spherule::closing {
namespace {

using Eigen::Vector3d;

double squared_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).squaredNorm();
}

// The least of the squared distances to the edges and, if the foot of the perpendicular is inside,
// to the plane.
double squared_to_triangle(const Vector3d& p, const std::array<Vector3d, 3>& t) {
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.squaredNorm();
  bool is_above = area > 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& from = t[k];
    const Vector3d& to = t[(k + 1) % 3];
    best = std::min(best, squared_to_segment(p, from, to));
    is_above = is_above && normal.cross(to - from).dot(p - from) >= 0.0;
  }
  if (!is_above) return best;
  const double height = normal.dot(p - t[0]);
  return std::min(best, height * height / area);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  for (const Eigen::Vector3i& t : mesh.triangles) triangles_.push_back(corners_of(mesh, t));
  constexpr std::size_t kLeaf = 4;
  nodes_.push_back({.box = {}, .begin = 0, .end = triangles_.size()});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::size_t begin = nodes_[n].begin;
    const std::size_t end = nodes_[n].end;
    for (std::size_t i = begin; i < end; ++i) {
      for (const Vector3d& corner : triangles_[i]) nodes_[n].box.extend(corner);
    }
    if (end - begin <= kLeaf) continue;
    const Eigen::Index axis = internal::longest_axis(nodes_[n].box);
    const std::size_t middle =
        begin + internal::split_at_median(
                    std::span(triangles_).subspan(begin, end - begin),
                    [axis](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; });
    nodes_[n].children = nodes_.size();
    nodes_.push_back({.box = {}, .begin = begin, .end = middle});
    nodes_.push_back({.box = {}, .begin = middle, .end = end});
  }
}

double TriangleTree::distance(const Vector3d& p, double limit) const {
  double best = limit * limit;
  std::array<std::pair<double, std::size_t>, 128> waiting;
  std::size_t count = 0;
  waiting[count++] = {nodes_[0].box.squaredExteriorDistance(p), 0};
  while (count > 0) {
    const auto [squared, n] = waiting[--count];
    if (squared >= best) continue;
    const Node& node = nodes_[n];
    if (node.children == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i) {
        best = std::min(best, squared_to_triangle(p, triangles_[i]));
      }
      continue;
    }
    std::pair near{nodes_[node.children].box.squaredExteriorDistance(p), node.children};
    std::pair far{nodes_[node.children + 1].box.squaredExteriorDistance(p), node.children + 1};
    if (far.first < near.first) std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
  return std::sqrt(best);
}

namespace {

using Eigen::Vector3d;

// Calls visit(node, is_within) for the nodes whose cubes meet a sphere; whether the node itself is
// within it. A node may come more than once.
template <typename Visit>
void for_each_node_of(std::span<const Sphere> spheres, const Grid& grid, Visit visit) {
  const double e = grid.half_diagonal();
  for (const Sphere& sphere : spheres) {
    Index low{};
    Index high{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const double at = (sphere.center[axis] - grid.origin[axis]) / grid.step;
      const double reach = (sphere.radius + e) / grid.step;
      low[a] = static_cast<int>(std::clamp(std::floor(at - reach), 0.0, grid.count[a] - 1.0));
      high[a] = static_cast<int>(std::clamp(std::ceil(at + reach), 0.0, grid.count[a] - 1.0));
    }
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          const double way = (grid.point({x, y, z}) - sphere.center).norm();
          if (way <= sphere.radius + e) visit(grid.at({x, y, z}), way <= sphere.radius);
        }
      }
    }
  }
}

// Bounds of the protrusion of the spheres' points in the cube of each node.
struct Field {
  std::vector<float> lower;  // a point of the spheres in the cube protrudes so far; or 0
  std::vector<float> upper;
};

Field protrusions(const ClosedSolid& solid, std::span<const Sphere> spheres) {
  const Grid& grid = solid.grid();
  const double e = grid.half_diagonal();
  const std::vector<float> least = solid.least_distances();
  const std::vector<float> greatest = solid.greatest_distances();
  Field field{std::vector<float>(grid.size()), std::vector<float>(grid.size())};
  for_each_node_of(spheres, grid, [&](std::size_t node, bool is_within) {
    if (is_within) field.lower[node] = least[node];
    field.upper[node] = static_cast<float>(greatest[node] + e);
  });
  const float known = *std::max_element(field.lower.begin(), field.lower.end());
  // The mesh is a part of the solid.
  constexpr std::size_t kRun = 4096;
  in_parallel((grid.size() + kRun - 1) / kRun, [&](std::size_t run) {
    for (std::size_t n = run * kRun; n < std::min((run + 1) * kRun, grid.size()); ++n) {
      if (field.upper[n] <= known) continue;
      const double way = solid.mesh().distance(grid.point(n), field.upper[n]) + e;
      field.upper[n] = std::min(field.upper[n], static_cast<float>(way));
    }
  });
  return field;
}

std::size_t place_of_greatest(const std::vector<float>& values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

class Judge {
 public:
  Judge(const ClosedSolid& solid, std::span<const Sphere> spheres, const JudgeOptions& options)
      : solid_(solid),
        spheres_(spheres),
        options_(options),
        field_(protrusions(solid, spheres)),
        examined_(solid.grid().size()) {
    const std::size_t node = place_of_greatest(field_.lower);
    result_.lower = field_.lower[node];
    result_.lower_at = solid.grid().point(node);
    result_.step = solid.grid().step;
  }

  JudgedProtrusion operator()() {
    std::size_t worst = place_of_greatest(field_.upper);
    for (int round = 0; round < options_.rounds; ++round) {
      if (examined_[worst] != 0 || field_.upper[worst] <= result_.lower + options_.tolerance) break;
      examine(worst);
      worst = place_of_greatest(field_.upper);
    }
    result_.upper = std::max(static_cast<double>(field_.upper[worst]), result_.lower);
    result_.upper_at = solid_.grid().point(worst);
    return result_;
  }

 private:
  // Bounds for all cubes near that one, from a finer grid that reaches to all that matters there.
  void examine(std::size_t worst) {
    const Grid& grid = solid_.grid();
    const int near = std::max(4, static_cast<int>(solid_.rho() / grid.step / 4.0));
    const int half = near + static_cast<int>((solid_.rho() + field_.upper[worst]) / grid.step) + 4;
    const double most = std::cbrt(static_cast<double>(options_.most_nodes_examined));
    const int pieces = std::clamp(static_cast<int>(most / (2.0 * half)), 2, 8);
    const Index center = grid.index(worst);
    const ClosedSolid part(solid_, center, half, pieces);
    const Field finer = protrusions(part, spheres_);
    const std::size_t node = place_of_greatest(finer.lower);
    if (finer.lower[node] > result_.lower) {
      result_.lower = finer.lower[node];
      result_.lower_at = part.grid().point(node);
    }
    // The greatest of the finer cubes that meet a coarse one.
    std::vector<float> upper(grid.size());
    const auto is_near = [&](const Index& i) {
      return std::abs(i[0] - center[0]) <= near && std::abs(i[1] - center[1]) <= near &&
             std::abs(i[2] - center[2]) <= near;
    };
    for (std::size_t n = 0; n < finer.upper.size(); ++n) {
      if (finer.upper[n] <= 0.0F) continue;
      const Vector3d at = (part.grid().point(n) - grid.origin) / grid.step;
      const double reach = 0.5 / pieces + 0.5 + 1e-9;
      Index low{};
      Index high{};
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = static_cast<int>(std::ceil(at[static_cast<int>(a)] - reach));
        high[a] = static_cast<int>(std::floor(at[static_cast<int>(a)] + reach));
      }
      for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int x = low[0]; x <= high[0]; ++x) {
            if (!grid.contains({x, y, z}) || !is_near({x, y, z})) continue;
            float& greatest = upper[grid.at({x, y, z})];
            greatest = std::max(greatest, finer.upper[n]);
          }
        }
      }
    }
    for (int z = -near; z <= near; ++z) {
      for (int y = -near; y <= near; ++y) {
        for (int x = -near; x <= near; ++x) {
          const Index i{center[0] + x, center[1] + y, center[2] + z};
          if (!grid.contains(i)) continue;
          field_.upper[grid.at(i)] = std::min(field_.upper[grid.at(i)], upper[grid.at(i)]);
          examined_[grid.at(i)] = 1;
        }
      }
    }
  }

  const ClosedSolid& solid_;
  std::span<const Sphere> spheres_;
  JudgeOptions options_;
  Field field_;
  std::vector<char> examined_;
  JudgedProtrusion result_;
};

}  // namespace

JudgedProtrusion judge_protrusion_from_closing(const TriangleMesh& mesh,
                                               std::span<const Sphere> spheres, double diameter,
                                               const JudgeOptions& options) {
  const TriangleTree tree(mesh);
  const double rho = diameter / 2.0;
  Eigen::AlignedBox3d box = tree.box();
  for (const Sphere& sphere : spheres) {
    const Vector3d reach = Vector3d::Constant(sphere.radius);
    box.extend(sphere.center - reach).extend(sphere.center + reach);
  }
  const Vector3d room = box.sizes() + Vector3d::Constant(2.0 * rho);
  const double least = std::cbrt(room.prod() / static_cast<double>(options.most_nodes));
  const double step = std::max(options.step > 0.0 ? options.step : diameter / 32.0, least);
  const ClosedSolid solid(tree, box, rho, step);
  return Judge(solid, spheres, options)();
}

}  // namespace spherule::closing
