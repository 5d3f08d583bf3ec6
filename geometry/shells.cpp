// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/shells.h"

#include "base/disjoint_sets.h"
#include "geometry/ray.h"
#include "geometry/self_intersection.h"
#include "geometry/triangles.h"
#include "geometry/weld.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <utility>

namespace spherule::internal {
namespace {

// Unit vectors along no axis, edge or diagonal that a model is likely to have.
const std::array<Eigen::Vector3d, 4> kDirections{
    Eigen::Vector3d(0.4517, 0.6293, 0.6323), Eigen::Vector3d(-0.7411, 0.3079, 0.5966),
    Eigen::Vector3d(0.5381, -0.8114, 0.2281), Eigen::Vector3d(-0.2893, -0.4729, -0.8323)};

std::size_t count_surfaces(const std::vector<TriangleRole>& roles) {
  std::int32_t last = -1;
  for (const TriangleRole& role : roles) {
    last = std::max({last, role.shell, role.patch, role.front, role.back});
  }
  return static_cast<std::size_t>(last + 1);
}

}  // namespace

ClosedShells::ClosedShells(const TriangleMesh& mesh, const MeshDistance& distance)
    : distance_(distance) {
  MeshShells found = find_shells(weld(mesh));
  is_mesh_closed_ = found.are_closed;
  roles_ = std::move(found.roles);
  surface_count_ = count_surfaces(roles_);
}

std::vector<std::int32_t> ClosedShells::around(const Eigen::Vector3d& point) const {
  if (surface_count_ == 0 || !distance_.box().contains(point)) return {};
  for (const Eigen::Vector3d& direction : kDirections) {
    if (auto counted = count_along(point, direction)) return *std::move(counted);
  }
  return sum_of_angles(point);
}

std::optional<std::vector<std::int32_t>> ClosedShells::count_along(
    const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  const Ray ray(point, 0.0, direction);
  std::vector<std::pair<std::int32_t, int>> crossings;
  const bool is_certain =
      distance_.visit_ray(point, direction, [&](const MeshDistance::Corners& t) {
        const TriangleRole& role = roles_[static_cast<std::size_t>(t.triangle)];
        if (!role.counts()) return true;
        const std::optional<int> crossing = ray.crossing({t.a, t.b, t.c});
        if (crossing.value_or(0) != 0) {
          role.for_each_surface(*crossing, [&](std::int32_t surface, int turn) {
            crossings.emplace_back(surface, turn);
          });
        }
        return crossing.has_value();
      });
  if (!is_certain) return std::nullopt;
  std::sort(crossings.begin(), crossings.end());
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < crossings.size();) {
    const std::int32_t surface = crossings[i].first;
    int sum = 0;
    for (; i < crossings.size() && crossings[i].first == surface; ++i) sum += crossings[i].second;
    if (sum != 0) result.push_back(surface);
  }
  return result;
}

std::vector<std::int32_t> ClosedShells::sum_of_angles(const Eigen::Vector3d& point) const {
  std::vector<double> angles(surface_count_, 0.0);
  distance_.visit_all([&](const MeshDistance::Corners& t) {
    const TriangleRole& role = roles_[static_cast<std::size_t>(t.triangle)];
    if (!role.counts()) return;
    const double angle = solid_angle(t.a - point, t.b - point, t.c - point);
    role.for_each_surface(1, [&](std::int32_t surface, int turn) {
      angles[static_cast<std::size_t>(surface)] += turn * angle;
    });
  });
  std::vector<std::int32_t> result;
  for (std::size_t surface = 0; surface < surface_count_; ++surface) {
    if (std::lround(angles[surface] / (4.0 * std::numbers::pi)) != 0) {
      result.push_back(static_cast<std::int32_t>(surface));
    }
  }
  return result;
}

namespace {

using Corners = std::array<int, 3>;
using Eigen::Vector3d;

// Whether the corners go round in ascending order.
bool ascends(const Corners& t) {
  return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
}

// The two sides of a triangle, as elements of sets: that from which its corners go round
// anticlockwise, and the other one.
int front_of(int triangle) {
  return 2 * triangle;
}
int back_of(int triangle) {
  return 2 * triangle + 1;
}

class ShellFinder {
 public:
  ShellFinder(const std::vector<Corners>& triangles, std::span<const Vector3d> vertices)
      : triangles_(triangles),
        vertices_(vertices),
        shells_(triangles.size()),
        patches_(triangles.size()),
        sides_(2 * triangles.size()),
        is_first_(triangles.size(), 0),
        cancels_(triangles.size(), 0),
        remains_(triangles.size(), 0),
        has_junction_(triangles.size(), 0),
        is_open_shell_(triangles.size(), 0),
        is_open_patch_(triangles.size(), 0) {
    const std::vector<EdgeUse> edges = edge_uses(triangles);
    for_each_edge(edges, [&](std::span<const EdgeUse> uses) {
      for (const EdgeUse& use : uses) shells_.join(use.triangle, uses[0].triangle);
    });
    compare_alike();
    for_each_edge(edges, [&](std::span<const EdgeUse> uses) {
      weigh_shell(uses);
      take_firsts(uses);
      join_patches();
    });
    std::vector<int> balance(triangles.size(), 0);
    for_each_edge(edges, [&](std::span<const EdgeUse> uses) {
      if (is_plain(shell_of(uses[0].triangle))) return;
      take_firsts(uses);
      weigh_patches(balance);
      join_sides();
    });
  }

  MeshShells run() {
    MeshShells result;
    result.roles.resize(triangles_.size());
    std::vector<std::int32_t> of_shell(triangles_.size(), -1), of_patch = of_shell,
                                                               of_cell(2 * triangles_.size(), -1);
    std::int32_t count = 0;
    const auto number = [&](std::int32_t& of) { return of >= 0 ? of : of = count++; };
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (has_repeated_corner(triangles_[i])) continue;
      const auto triangle = static_cast<int>(i);
      const std::size_t shell = shell_of(triangle);
      TriangleRole& role = result.roles[i];
      const bool is_repeated = is_plain(shell) && !is_first_[i];
      if (!is_open_shell_[shell] && remains_[shell] && !is_repeated) {
        role.shell = number(of_shell[shell]);
      }
      if (is_plain(shell) || !is_first_[i]) continue;
      const OrientedDisjointSets::Place place = patches_.find(triangle);
      const auto patch = static_cast<std::size_t>(place.root);
      role.turn = place.turn;
      if (!is_open_patch_[patch]) role.patch = number(of_patch[patch]);
      const int front = sides_.find(front_of(triangle)).root;
      const int back = sides_.find(back_of(triangle)).root;
      if (front != back) {
        role.front = number(of_cell[static_cast<std::size_t>(front)]);
        role.back = number(of_cell[static_cast<std::size_t>(back)]);
      }
      const bool counts_as_turned = !cancels_[shell] && !is_open_shell_[shell];
      result.are_closed = result.are_closed && (counts_as_turned || role.encloses());
    }
    return result;
  }

 private:
  std::size_t shell_of(int triangle) {
    return static_cast<std::size_t>(shells_.find(triangle).root);
  }
  // Whether the shell says all there is to say.
  bool is_plain(std::size_t shell) const {
    return !cancels_[shell] && !has_junction_[shell] && !is_open_shell_[shell];
  }

  // Of triangles with the same corners: which is the first, whether they are turned both ways, and
  // whether one way is more frequent.
  void compare_alike() {
    std::vector<std::pair<Corners, int>> sorted;
    sorted.reserve(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (has_repeated_corner(triangles_[i])) continue;
      Corners corners = triangles_[i];
      std::sort(corners.begin(), corners.end());
      sorted.emplace_back(corners, static_cast<int>(i));
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
      std::size_t ascending = 0;
      for (; end < sorted.size() && sorted[end].first == sorted[i].first; ++end) {
        ascending += ascends(triangles_[static_cast<std::size_t>(sorted[end].second)]);
      }
      const std::size_t descending = end - i - ascending;
      const std::size_t shell = shell_of(sorted[i].second);
      is_first_[static_cast<std::size_t>(sorted[i].second)] = 1;
      if (ascending > 0 && descending > 0) cancels_[shell] = 1;
      if (ascending != descending) remains_[shell] = 1;
    }
  }

  void weigh_shell(std::span<const EdgeUse> uses) {
    int sum = 0;
    for (const EdgeUse& use : uses) sum += use.turn;
    if (sum != 0) is_open_shell_[shell_of(uses[0].triangle)] = 1;
  }

  // Those of an edge that do not repeat another triangle.
  void take_firsts(std::span<const EdgeUse> uses) {
    firsts_.clear();
    for (const EdgeUse& use : uses) {
      if (is_first_[static_cast<std::size_t>(use.triangle)]) firsts_.push_back(use);
    }
  }

  void join_patches() {
    if (firsts_.size() > 2) has_junction_[shell_of(firsts_[0].triangle)] = 1;
    if (firsts_.size() != 2) return;
    patches_.join(firsts_[0].triangle, firsts_[1].triangle, -firsts_[0].turn * firsts_[1].turn);
  }

  // `balance`, of every patch, is zero before and after.
  void weigh_patches(std::vector<int>& balance) {
    const auto for_each_patch = [&](const auto& function) {
      for (const EdgeUse& use : firsts_) {
        const OrientedDisjointSets::Place place = patches_.find(use.triangle);
        function(static_cast<std::size_t>(place.root), use.turn * place.turn);
      }
    };
    for_each_patch([&](std::size_t patch, int turn) { balance[patch] += turn; });
    for_each_patch([&](std::size_t patch, int) {
      if (balance[patch] != 0) is_open_patch_[patch] = 1;
      balance[patch] = 0;
    });
  }

  // Seen along the edge, the triangles in the order of their angles: what faces anticlockwise of
  // one faces the next one. A triangle that passes the edge from low to high has its front there.
  void join_sides() {
    if (firsts_.size() > 2) sort_by_angle();
    for (std::size_t i = 0; i < firsts_.size(); ++i) {
      const EdgeUse& use = firsts_[i];
      const EdgeUse& next = firsts_[(i + 1) % firsts_.size()];
      sides_.join(use.turn > 0 ? front_of(use.triangle) : back_of(use.triangle),
                  next.turn > 0 ? back_of(next.triangle) : front_of(next.triangle));
    }
  }

  void sort_by_angle() {
    const Vector3d& origin = vertex(firsts_[0].low);
    const Vector3d edge = vertex(firsts_[0].high) - origin;
    // Of a length that neither overflows nor vanishes when squared.
    const Vector3d axis = (edge / edge.lpNorm<Eigen::Infinity>()).normalized();
    const Vector3d right = axis.unitOrthogonal();
    const Vector3d up = axis.cross(right);
    angles_.clear();
    for (const EdgeUse& use : firsts_) {
      const Corners& t = triangles_[static_cast<std::size_t>(use.triangle)];
      const Vector3d beside = vertex(opposite_corner(t, use)) - origin;
      angles_.emplace_back(std::atan2(up.dot(beside), right.dot(beside)), use);
    }
    std::sort(angles_.begin(), angles_.end(), [](const auto& a, const auto& b) {
      return std::tie(a.first, a.second.triangle) < std::tie(b.first, b.second.triangle);
    });
    for (std::size_t i = 0; i < firsts_.size(); ++i) firsts_[i] = angles_[i].second;
  }
  const Vector3d& vertex(int corner) const { return vertices_[static_cast<std::size_t>(corner)]; }

  const std::vector<Corners>& triangles_;
  const std::span<const Vector3d> vertices_;
  std::vector<EdgeUse> firsts_;                     // of one edge
  std::vector<std::pair<double, EdgeUse>> angles_;  // of these
  OrientedDisjointSets shells_, patches_;           // of triangles
  OrientedDisjointSets sides_;                      // of them
  std::vector<char> is_first_;  // of a triangle: among those with the same corners
  // Of a shell, by the triangle that stands for it: whether triangles are turned both ways, and
  // whether some are left if those are taken away in pairs; whether more than two meet at an edge.
  std::vector<char> cancels_, remains_, has_junction_;
  std::vector<char> is_open_shell_, is_open_patch_;
};

}  // namespace

MeshShells find_shells(const std::vector<std::array<int, 3>>& triangles,
                       std::span<const Vector3d> vertices) {
  return ShellFinder(triangles, vertices).run();
}

MeshShells find_shells(const TriangleMesh& welded) {
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(welded.triangles.size());
  for (const Eigen::Vector3i& t : welded.triangles) triangles.push_back({t[0], t[1], t[2]});
  return find_shells(triangles, welded.vertices);
}

// Around an edge the sides that face each other are of one cell, so that surfaces of a part have
// triangles in common. Of its cells the one outside encloses most: all sides that face it, where
// the others take away their rooms.
OuterSides outer_sides(const TriangleMesh& welded, const std::vector<TriangleRole>& roles) {
  const std::size_t count = count_surfaces(roles);
  const Vector3d center = box_of(welded).center();  // keeps the terms small
  std::vector<double> volume_of(welded.triangles.size()), enclosed(count, 0.0);
  std::vector<char> is_cell(count, 0);
  DisjointSets connected(count);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const auto [a, b, c] = corners_of(welded, welded.triangles[i]);
    volume_of[i] = (a - center).dot((b - center).cross(c - center)) / 6.0;
    std::optional<std::uint32_t> first;
    roles[i].for_each_surface(1, [&](std::int32_t surface, int turn) {
      const auto s = static_cast<std::uint32_t>(surface);
      enclosed[s] += turn * volume_of[i];
      connected.unite(first ? *first : s, s);
      first = s;
    });
    for (const std::int32_t cell : {roles[i].front, roles[i].back}) {
      if (cell >= 0) is_cell[static_cast<std::size_t>(cell)] = 1;
    }
  }
  std::vector<std::int32_t> part_of_root(count, -1), outside(count, -1);
  OuterSides result;
  result.parts.resize(count);
  for (std::uint32_t s = 0; s < count; ++s) {
    const std::size_t root = connected.find(s);
    if (part_of_root[root] < 0) {
      part_of_root[root] = static_cast<std::int32_t>(result.volumes.size());
      result.volumes.push_back(0.0);
    }
    result.parts[s] = part_of_root[root];
    std::int32_t& best = outside[static_cast<std::size_t>(result.parts[s])];
    if (is_cell[s] && (best < 0 || enclosed[s] > enclosed[static_cast<std::size_t>(best)])) {
      best = static_cast<std::int32_t>(s);
    }
  }
  result.turns.assign(roles.size(), 0);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const TriangleRole& role = roles[i];
    if (!role.counts()) continue;
    const auto surface = static_cast<std::size_t>(std::max({role.shell, role.patch, role.front}));
    const auto part = static_cast<std::size_t>(result.parts[surface]);
    const std::int32_t around = outside[part];
    int& turn = result.turns[i];
    if (around >= 0) {
      turn = role.front == around ? 1 : role.back == around ? -1 : 0;
    } else if (role.patch >= 0) {
      turn = enclosed[static_cast<std::size_t>(role.patch)] < 0.0 ? -role.turn : role.turn;
    } else {
      turn = enclosed[static_cast<std::size_t>(role.shell)] < 0.0 ? -1 : 1;
    }
    result.volumes[part] += turn * volume_of[i];
  }
  return result;
}

}  // namespace spherule::internal
