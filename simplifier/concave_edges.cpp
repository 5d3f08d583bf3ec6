// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/concave_edges.h"

#include "geometry/self_intersection.h"
#include "geometry/shells.h"
#include "geometry/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::EdgeUse;

// Triangles that lie on each other leave no room between them.
constexpr double kFolded = std::numbers::pi / 180.0;
// Sharper edges are treated like this one (11 degrees), lest their zones grow without bound.
constexpr double kLeastSine = 0.1;
constexpr double kLeastDiameter = 1.0 / 4.0;  // of D: two halvings of the step
constexpr double kFilletOfError = 0.5;
constexpr double kStraight = 1.0 / 8.0;  // of the zone's diameter

// A triangle at an edge, seen from it.
struct Side {
  Vector3d inwards;  // unit vector in the triangle, perpendicular to the edge
  Vector3d normal;   // unit
  bool forward;      // runs along the edge from the lower to the higher vertex
};

struct Edge {
  std::size_t from, to;  // vertices
  double angle;          // on the outside
};

// The angle of an edge on the outside, if it is known to be sharp and concave or may be.
std::optional<double> concave_angle(const std::vector<Side>& sides) {
  const auto between = [](const Side& a, const Side& b) {
    return std::acos(std::clamp(a.inwards.dot(b.inwards), -1.0, 1.0));
  };
  double least = std::numbers::pi;
  if (sides.size() == 2 && sides[0].forward != sides[1].forward) {
    if (!(sides[0].normal.dot(sides[1].inwards) > 0.0)) return std::nullopt;
    least = between(sides[0], sides[1]);
  } else {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const double angle = between(sides[i], sides[k]);
        if (angle > kFolded) least = std::min(least, angle);
      }
    }
  }
  if (least >= internal::kSharpAngle) return std::nullopt;
  return least;
}

// All sharp concave edges of a mesh over distinct vertices, sorted.
std::vector<Edge> concave_edges(const TriangleMesh& mesh) {
  double volume = 0.0;
  const Vector3d origin = corners_of(mesh, mesh.triangles.front())[0];
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    volume += (a - origin).dot((b - origin).cross(c - origin));
  }
  const std::vector<int> turns =
      internal::outer_sides(mesh, internal::find_shells(mesh).roles).turns;
  // With an area, once each, and turned outwards: open parts like the mesh as a whole.
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Vector3d> normals;
  std::set<std::array<int, 3>> seen;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    Eigen::Vector3i t = mesh.triangles[i];
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::ranges::sort(corners);
    if (!seen.insert(corners).second) continue;
    if (turns[i] < 0 || (turns[i] == 0 && volume < 0.0)) std::swap(t[1], t[2]);
    const std::array<Vector3d, 3> corner = corners_of(mesh, t);
    const Vector3d cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (!(cross.norm() > 0.0)) continue;
    triangles.push_back(t);
    normals.emplace_back(cross.normalized());
  }
  const auto vertex = [&](int v) -> const Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(v)];
  };
  std::vector<Edge> edges;
  const std::vector<EdgeUse> uses = internal::edge_uses(triangles);
  internal::for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    std::vector<Side> sides;
    for (const EdgeUse& use : edge) {
      const auto triangle = static_cast<std::size_t>(use.triangle);
      const Vector3d& from = vertex(use.from());
      const Vector3d along = (vertex(use.to()) - from).normalized();
      const Vector3d third = vertex(internal::opposite_corner(triangles[triangle], use)) - from;
      sides.push_back(
          {(third - along * along.dot(third)).normalized(), normals[triangle], use.turn > 0});
    }
    if (const std::optional<double> angle = concave_angle(sides)) {
      edges.push_back({static_cast<std::size_t>(edge.front().low),
                       static_cast<std::size_t>(edge.front().high), *angle});
    }
  });
  return edges;
}

// Diameter that leaves a fillet of E / 2; none if D does.
std::optional<double> edge_diameter(double angle, const ConcaveEdgeOptions& options) {
  const double sine = std::sin(angle / 2.0);
  const double wanted = 2.0 * kFilletOfError * options.max_error * sine / (1.0 - sine);
  const double largest = options.min_external_diameter;
  if (wanted >= largest) return std::nullopt;
  return std::max(wanted, kLeastDiameter * largest);
}

double segment_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d way = b - a;
  const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - a - t * way).norm();
}

// Joins edges one after the other as long as they are straight.
class Chains {
 public:
  Chains(const TriangleMesh& mesh, std::vector<Edge> edges)
      : mesh_(mesh), edges_(std::move(edges)), taken_(edges_.size(), false) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      at_vertex_[edges_[i].from].push_back(i);
      at_vertex_[edges_[i].to].push_back(i);
    }
  }

  std::vector<Zone> zones(const ConcaveEdgeOptions& options) {
    std::vector<Zone> result;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const std::optional<double> diameter = edge_diameter(edges_[i].angle, options);
      if (!diameter || taken_[i]) continue;
      taken_[i] = true;
      Chain chain{{edges_[i].from, edges_[i].to}, edges_[i].angle};
      const double tolerance = kStraight * *diameter;
      while (extend(chain, tolerance)) {
      }
      std::reverse(chain.vertices.begin(), chain.vertices.end());
      while (extend(chain, tolerance)) {
      }
      const double sine = std::max(kLeastSine, std::sin(chain.angle / 2.0));
      const double touching =
          options.min_external_diameter / 2.0 + options.padding + options.margin;
      const ZoneCapsule capsule{point(chain.vertices.front()), point(chain.vertices.back()),
                                touching / sine + tolerance};
      result.push_back({.shape = capsule,
                        .max_error = std::nullopt,
                        .min_external_diameter = edge_diameter(chain.angle, options)});
    }
    return result;
  }

 private:
  struct Chain {
    std::vector<std::size_t> vertices;
    double angle;  // the least
  };

  const Vector3d& point(std::size_t vertex) const { return mesh_.vertices[vertex]; }

  // By the edge at the last vertex that goes straight on best, if one does.
  bool extend(Chain& chain, double tolerance) {
    const std::size_t last = chain.vertices.back();
    const Vector3d first = point(chain.vertices.front());
    const Vector3d direction = (point(last) - first).normalized();
    double best_cosine = 0.0;
    std::optional<std::size_t> best;
    for (const std::size_t i : at_vertex_[last]) {
      if (taken_[i]) continue;
      const double cosine = direction.dot((point(other_end(i, last)) - point(last)).normalized());
      if (cosine > best_cosine) {
        best_cosine = cosine;
        best = i;
      }
    }
    if (!best) return false;
    const std::size_t next = other_end(*best, last);
    for (const std::size_t v : chain.vertices) {
      if (segment_distance(point(v), first, point(next)) > tolerance) return false;
    }
    taken_[*best] = true;
    chain.vertices.push_back(next);
    chain.angle = std::min(chain.angle, edges_[*best].angle);
    return true;
  }

  std::size_t other_end(std::size_t edge, std::size_t vertex) const {
    return edges_[edge].from == vertex ? edges_[edge].to : edges_[edge].from;
  }

  const TriangleMesh& mesh_;
  std::vector<Edge> edges_;
  std::vector<bool> taken_;
  std::map<std::size_t, std::vector<std::size_t>> at_vertex_;
};

}  // namespace

std::vector<Zone> concave_edge_zones(const TriangleMesh& input, const ConcaveEdgeOptions& options) {
  validate(input, "mesh");
  const TriangleMesh mesh = internal::weld(input);
  return Chains(mesh, concave_edges(mesh)).zones(options);
}

}  // namespace spherule
