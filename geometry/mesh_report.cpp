// SPDX-License-Identifier: BSD-3-Clause
#include "base/disjoint_sets.h"
#include "geometry/median_split.h"
#include "geometry/mesh_distance.h"
#include "geometry/self_intersection.h"
#include "geometry/shells.h"
#include "geometry/triangle_mesh.h"
#include "geometry/weld.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Below this share of the square of the longest edge, twice an area is rounding.
constexpr double kZeroArea = 1e-14;
// A volume of this share of area times size is rounding.
constexpr double kZeroVolume = 1e-12;
// Of the size of a triangle.
constexpr double kJustInside = 1e-6;

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
      parts[components.find(static_cast<std::uint32_t>(edge.front().low))].closed = false;
    }
  });
}

// A part within a larger one adds nothing: one around whose box it has its own, and which contains
// a point just inside of its largest triangle.
double volume_inside(const TriangleMesh& mesh, const std::vector<internal::TriangleRole>& roles) {
  const internal::OuterSides sides = internal::outer_sides(mesh, roles);
  const std::size_t count = sides.volumes.size();
  const double all = std::accumulate(sides.volumes.begin(), sides.volumes.end(), 0.0);
  if (count < 2) return all;
  struct Largest {
    double area = -1.0;
    Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  };
  std::vector<Largest> largest(count);
  std::vector<Eigen::AlignedBox3d> boxes(count);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (sides.turns[i] == 0) continue;
    std::size_t part = 0;
    roles[i].for_each_surface(1, [&](std::int32_t surface, int) {
      part = static_cast<std::size_t>(sides.parts[static_cast<std::size_t>(surface)]);
    });
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[i]);
    for (const Eigen::Vector3d& corner : {a, b, c}) boxes[part].extend(corner);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > largest[part].area)) continue;
    const double depth = kJustInside * std::sqrt(normal.norm());
    largest[part] = {normal.norm(),
                     (a + b + c) / 3.0 - sides.turns[i] * depth * normal.stableNormalized()};
  }
  const MeshDistance distance(mesh);
  const internal::ClosedShells shells(mesh, distance);
  double volume = 0.0;
  for (std::size_t part = 0; part < count; ++part) {
    const auto surrounds = [&](std::int32_t surface) {
      const auto other = static_cast<std::size_t>(sides.parts[static_cast<std::size_t>(surface)]);
      return std::pair(sides.volumes[other], part) > std::pair(sides.volumes[part], other) &&
             boxes[other].contains(boxes[part]);
    };
    if (std::ranges::none_of(shells.around(largest[part].inside), surrounds)) {
      volume += sides.volumes[part];
    }
  }
  return volume;
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
  const internal::MeshShells shells = internal::find_shells(mesh);
  report.closed = shells.are_closed;
  report.volume = volume_inside(mesh, shells.roles);
  count_edges(mesh, components, parts, report);
  for (const Component& part : parts) {
    if (!part.used) continue;
    ++report.components;
    report.area += part.area;
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

namespace spherule::internal {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kTouching = 1e-14;
constexpr std::size_t kLeafTriangles = 4;
// Pairs of nodes and of triangles that are examined: 8 to 114 for each triangle of CAD meshes and
// scans; in a fan of slivers every pair of triangles.
constexpr std::size_t kSmallestBudget = std::size_t{1} << 24;
constexpr std::size_t kPairsPerTriangle = 256;

// Whether the projections on `axis` are apart by more than rounding. Coordinates are relative to a
// corner of `a`, so that `size` bounds what they can lose.
bool separated(const Corners& a, const Corners& b, const Eigen::Vector3d& axis, double size) {
  const auto [a_low, a_high] = std::minmax({a[0].dot(axis), a[1].dot(axis), a[2].dot(axis)});
  const auto [b_low, b_high] = std::minmax({b[0].dot(axis), b[1].dot(axis), b[2].dot(axis)});
  const double slack = kTouching * size * axis.norm();
  return a_high + slack < b_low || b_high + slack < a_low;
}

// Binary hierarchy of boxes over the triangles; children of inner node i stand at i + 1 and
// nodes[i].second.
class BoxTree {
 public:
  explicit BoxTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    boxes_.reserve(order_.size());
    for (const Eigen::Vector3i& t : mesh.triangles) {
      Box& box = boxes_.emplace_back();
      for (int k = 0; k < 3; ++k) box.extend(mesh.vertices[static_cast<std::size_t>(t[k])]);
    }
    build(0, order_.size());
  }

  SelfIntersections count_pairs(std::size_t limit) {
    limit_ = limit;
    budget_ = kSmallestBudget + kPairsPerTriangle * order_.size();
    within(0);
    return {count_, count_ >= limit_ || budget_ == 0};
  }

 private:
  struct Node {
    Box box;
    std::size_t begin, end;  // its triangles in order_
    std::size_t second = 0;  // 0 for a leaf
  };

  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({Box(), begin, end});
    Box box, centers;
    for (std::size_t i = begin; i < end; ++i) {
      box.extend(boxes_[order_[i]]);
      centers.extend(boxes_[order_[i]].center());
    }
    nodes_[index].box = box;
    if (end - begin <= kLeafTriangles) return index;
    const Eigen::Index axis = longest_axis(centers);
    const std::size_t middle =
        begin + split_at_median(std::span(order_).subspan(begin, end - begin),
                                [&](std::size_t i) { return boxes_[i].center()[axis]; });
    build(begin, middle);
    const std::size_t second = build(middle, end);
    nodes_[index].second = second;
    return index;
  }

  // Pairs inside one node. Halving bounds the depth by log2 of the number of triangles.
  void within(std::size_t i) {
    if (nodes_[i].second == 0) {
      leaf_pairs(i, i);
      return;
    }
    within(i + 1);
    within(nodes_[i].second);
    between(i + 1, nodes_[i].second);
  }

  void between(std::size_t i, std::size_t j) {
    const Node& a = nodes_[i];
    const Node& b = nodes_[j];
    if (count_ >= limit_ || budget_ == 0 || !a.box.intersects(b.box)) return;
    --budget_;
    if (a.second == 0 && b.second == 0) {
      leaf_pairs(i, j);
    } else if (b.second == 0 || (a.second != 0 && a.end - a.begin >= b.end - b.begin)) {
      between(i + 1, j);
      between(a.second, j);
    } else {
      between(i, j + 1);
      between(i, b.second);
    }
  }

  void leaf_pairs(std::size_t i, std::size_t j) {
    for (std::size_t p = nodes_[i].begin; p < nodes_[i].end; ++p) {
      for (std::size_t q = i == j ? p + 1 : nodes_[j].begin; q < nodes_[j].end; ++q) {
        if (count_ >= limit_ || budget_ == 0) return;
        --budget_;
        if (is_intersection(order_[p], order_[q])) ++count_;
      }
    }
  }

  bool is_intersection(std::size_t p, std::size_t q) const {
    if (!boxes_[p].intersects(boxes_[q])) return false;
    const Eigen::Vector3i& s = mesh_.triangles[p];
    const Eigen::Vector3i& t = mesh_.triangles[q];
    for (int k = 0; k < 3; ++k) {
      if ((t.array() == s[k]).any()) return false;
    }
    return triangles_meet(corners_of(mesh_, s), corners_of(mesh_, t));
  }

  const TriangleMesh& mesh_;
  std::vector<std::size_t> order_;
  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
  std::size_t limit_ = 0;
  std::size_t budget_ = 0;  // of pairs of nodes and of triangles to examine
  std::size_t count_ = 0;
};

}  // namespace

// Separating axes: two triangles are disjoint exactly if they are separated along a normal, a cross
// product of two edges, or, where they lie in one plane, a normal of an edge in that plane.
bool triangles_meet(const Corners& a, const Corners& b) {
  Corners p, q;
  double size = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = a[k] - a[0];
    q[k] = b[k] - a[0];
    size = std::max({size, p[k].norm(), q[k].norm()});
  }
  const auto edge = [](const Corners& t, std::size_t k) -> Eigen::Vector3d {
    return t[(k + 1) % 3] - t[k];
  };
  const Eigen::Vector3d p_normal = edge(p, 0).cross(edge(p, 1));
  const Eigen::Vector3d q_normal = edge(q, 0).cross(edge(q, 1));
  if (separated(p, q, p_normal, size) || separated(p, q, q_normal, size)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (separated(p, q, edge(p, i).cross(edge(q, j)), size)) return false;
    }
    if (separated(p, q, p_normal.cross(edge(p, i)), size)) return false;
    if (separated(p, q, q_normal.cross(edge(q, i)), size)) return false;
    // Only triangles without area need these.
    if (separated(p, q, edge(p, i), size) || separated(p, q, edge(q, i), size)) return false;
  }
  return true;
}

SelfIntersections count_self_intersections(const TriangleMesh& mesh, std::size_t limit) {
  return BoxTree(mesh).count_pairs(limit);
}

}  // namespace spherule::internal
