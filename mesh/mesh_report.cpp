// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_report.h"

#include "mesh/geometry/edge_uses.h"
#include "mesh/geometry/self_intersection.h"
#include "mesh/geometry/weld.h"
#include "mesh/shells/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

// Below this share of the square of the longest edge, twice an area is rounding.
constexpr double kZeroArea = 1e-14;
// A volume of this share of area times size is rounding.
constexpr double kZeroVolume = 1e-12;

bool is_degenerate(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const auto [a, b, c] = corners_of(mesh, t);
  const Eigen::Vector3d e = b - a;
  const Eigen::Vector3d f = c - a;
  const double longest = std::max({e.squaredNorm(), f.squaredNorm(), (f - e).squaredNorm()});
  return e.cross(f).norm() <= kZeroArea * longest;
}

std::size_t count_duplicates(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> sorted;
  sorted.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    std::array<int, 3>& key = sorted.emplace_back(std::array<int, 3>{t[0], t[1], t[2]});
    std::sort(key.begin(), key.end());
  }
  std::sort(sorted.begin(), sorted.end());
  const auto last = std::unique(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(sorted.end() - last);
}

using internal::DisjointSets;
using internal::EdgeUse;

// Of the vertices.
DisjointSets components_of(const TriangleMesh& mesh) {
  DisjointSets components(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3<std::uint32_t> corners = t.cast<std::uint32_t>();
    components.unite(corners[0], corners[1]);
    components.unite(corners[0], corners[2]);
  }
  return components;
}

struct Component {
  bool used = false;
  bool closed = true;
  double area = 0.0;
  double volume = 0.0;
};

// Counts the edges and marks the components that are not closed.
void count_edges(const TriangleMesh& mesh, DisjointSets& components, std::vector<Component>& parts,
                 MeshReport& report) {
  const std::vector<EdgeUse> uses = internal::edge_uses(mesh.triangles);
  internal::for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    int turns = 0;
    for (const EdgeUse& use : edge) turns += use.turn;
    report.boundary_edges += edge.size() == 1;
    report.non_manifold_edges += edge.size() > 2;
    report.misoriented_edges += edge.size() == 2 && turns != 0;
    if (turns != 0) {
      report.closed = false;
      parts[components.find(static_cast<std::uint32_t>(edge.front().low))].closed = false;
    }
  });
}

void add_line(std::ostringstream& out, std::size_t count, const char* one, const char* many,
              const char* remark) {
  if (count == 0) return;
  out << "\n" << count << " " << (count == 1 ? one : many) << remark;
}

}  // namespace

MeshReport mesh_report(const TriangleMesh& input, const MeshReportOptions& options) {
  validate(input, "mesh");
  const TriangleMesh mesh = internal::weld(input);
  MeshReport report;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  for (const Eigen::Vector3d& v : mesh.vertices) report.box.extend(v);

  DisjointSets components = components_of(mesh);
  std::vector<Component> parts(mesh.vertices.size());
  const Eigen::Vector3d center = report.box.center();  // keeps the terms of the volume small
  for (const Eigen::Vector3i& t : mesh.triangles) {
    auto [a, b, c] = corners_of(mesh, t);
    for (Eigen::Vector3d* corner : {&a, &b, &c}) *corner -= center;
    Component& part = parts[components.find(static_cast<std::uint32_t>(t[0]))];
    part.used = true;
    part.area += 0.5 * (b - a).cross(c - a).norm();
    part.volume += a.dot(b.cross(c)) / 6.0;
    report.degenerate_triangles += is_degenerate(mesh, t);
  }
  report.duplicate_triangles = count_duplicates(mesh);
  report.closed = true;
  count_edges(mesh, components, parts, report);
  for (const Component& part : parts) {
    if (!part.used) continue;
    ++report.components;
    report.area += part.area;
    report.volume += part.volume;
    const double rounding = kZeroVolume * part.area * report.box.diagonal().norm();
    report.inverted_components += part.closed && part.volume < -rounding;
  }
  if (options.self_intersections) {
    const internal::SelfIntersections found =
        internal::count_self_intersections(mesh, kMaxSelfIntersections);
    report.self_intersections = found.pairs;
    report.self_intersections_stopped = found.stopped;
  }
  return report;
}

std::string describe(const MeshReport& report) {
  std::ostringstream out;
  const Eigen::Vector3d size = report.box.sizes();
  out << report.triangles << (report.triangles == 1 ? " triangle, " : " triangles, ")
      << report.vertices << " vertices, "
      << (report.components == 1 ? "one piece" : std::to_string(report.components) + " pieces")
      << ", size " << size.x() << " x " << size.y() << " x " << size.z() << ", area "
      << report.area;
  if (report.closed) {
    out << ", volume " << report.volume << "\nclosed";
  } else {
    out << "\nnot closed: the mesh does not bound a volume, only its surface is certain";
  }
  add_line(out, report.degenerate_triangles, "triangle", "triangles", " without area");
  add_line(out, report.duplicate_triangles, "triangle is", "triangles are", " there before");
  add_line(out, report.boundary_edges, "edge", "edges", " with a triangle on one side only");
  add_line(out, report.non_manifold_edges, "edge", "edges", " of more than two triangles");
  add_line(out, report.misoriented_edges, "edge", "edges",
           " between triangles of opposite orientation");
  add_line(out, report.inverted_components, "closed piece is", "closed pieces are",
           " turned inside out (a cavity, or the wrong way round)");
  const bool stopped = report.self_intersections_stopped;
  add_line(out, report.self_intersections, "pair", "pairs",
           stopped ? " or more of triangles that intersect without a common corner"
                   : " of triangles that intersect without a common corner");
  if (stopped && report.self_intersections == 0) {
    out << "\nintersecting triangles not found, but too many lie side by side to examine them all";
  }
  return out.str();
}

}  // namespace spherule
