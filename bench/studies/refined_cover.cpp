// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/refined_cover.h"

#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/studies/measure.h"
#include "geometry/median_split.h"
#include "tests/support/fcl_models.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <queue>
#include <span>
#include <string>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

// Far above what the corners of halved triangles and the radii lose to rounding.
constexpr double kUp = 1.0 + 1e-9;
constexpr int kMostHalvings = 40;
// Pieces for each new sphere: enough for groups that are well shaped.
constexpr double kPiecesPerSphere = 3.0;

struct Piece {
  std::array<Vector3d, 3> corners;

  Vector3d center() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
  double longest_edge() const {
    return std::max({(corners[0] - corners[1]).norm(), (corners[1] - corners[2]).norm(),
                     (corners[2] - corners[0]).norm()});
  }
  // A sphere is convex: it holds the piece if it holds its corners.
  double reach_from(const Vector3d& point) const {
    return std::max(
        {(corners[0] - point).norm(), (corners[1] - point).norm(), (corners[2] - point).norm()});
  }
};

// Cuts the triangles at the middle of their longest edges into pieces that a sphere holds and whose
// edges are not longer than `longest`, and gives each to the sphere in which it lies deepest.
class Cutter {
 public:
  Cutter(std::span<const Sphere> cover, double longest)
      : cover_(cover), longest_(longest), pieces_(cover.size()) {}

  void cut(const Piece& triangle, const std::string& name) {
    std::vector<std::size_t> all(cover_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    cut(triangle, all, 0, name);
  }

  std::vector<std::vector<Piece>> take() { return std::move(pieces_); }

 private:
  void cut(const Piece& piece, const std::vector<std::size_t>& among, int halvings,
           const std::string& name) {
    const Vector3d center = piece.center();
    const double around = piece.reach_from(center) * kUp;
    std::vector<std::size_t> near;
    std::size_t deepest = cover_.size();
    double depth = 0.0;
    for (const std::size_t i : among) {
      const Sphere& sphere = cover_[i];
      if ((sphere.center - center).norm() > sphere.radius + around) continue;
      near.push_back(i);
      const double here = sphere.radius - piece.reach_from(sphere.center) * kUp;
      if (here < 0.0 || (deepest < cover_.size() && here <= depth)) continue;
      deepest = i;
      depth = here;
    }
    if (deepest < cover_.size() && piece.longest_edge() <= longest_) {
      pieces_[deepest].push_back(piece);
      return;
    }
    if (halvings == kMostHalvings) throw Error(name, "a triangle is not covered");
    std::array<Piece, 2> halves{piece, piece};
    halve(piece, halves);
    for (const Piece& half : halves) cut(half, near, halvings + 1, name);
  }

  static void halve(const Piece& piece, std::array<Piece, 2>& halves) {
    const auto& c = piece.corners;
    std::size_t from = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if ((c[(i + 1) % 3] - c[i]).norm() > (c[(from + 1) % 3] - c[from]).norm()) from = i;
    }
    const Vector3d middle = 0.5 * (c[from] + c[(from + 1) % 3]);
    halves[0].corners[(from + 1) % 3] = middle;
    halves[1].corners[from] = middle;
  }

  std::span<const Sphere> cover_;
  double longest_;
  std::vector<std::vector<Piece>> pieces_;  // of each sphere
};

double reach_from(std::span<const Piece> pieces, const Vector3d& point) {
  double reach = 0.0;
  for (const Piece& piece : pieces) reach = std::max(reach, piece.reach_from(point));
  return reach * kUp;
}

// A sphere around the pieces within `outer`: its centre is moved from the middle of their box
// towards the centre of `outer`, as little as that takes. Distance and radius are convex along that
// way, and at its end, where the sphere is concentric, it is inside, so that halving finds the
// least.
Sphere sphere_around(std::span<const Piece> pieces, const Sphere& outer) {
  Eigen::AlignedBox3d box;
  for (const Piece& piece : pieces) {
    for (const Vector3d& corner : piece.corners) box.extend(corner);
  }
  const Vector3d middle = box.center();
  const auto at = [&](double t) {
    Sphere sphere;
    sphere.center = middle + t * (outer.center - middle);
    sphere.radius = reach_from(pieces, sphere.center);
    return sphere;
  };
  Sphere best = at(0.0);
  if (certainly_encloses(outer, best)) return best;
  best = {outer.center, reach_from(pieces, outer.center)};
  double outside = 0.0;
  double inside = 1.0;
  for (int i = 0; i < 12; ++i) {
    const double t = 0.5 * (outside + inside);
    const Sphere sphere = at(t);
    const bool is_inside = certainly_encloses(outer, sphere);
    (is_inside ? inside : outside) = t;
    if (is_inside) best = sphere;
  }
  return best;
}

struct Group {
  Sphere sphere;
  Sphere outer;
  std::span<Piece> pieces;

  // The largest first; equal ones by where they are, so that the order is the same everywhere.
  bool operator<(const Group& other) const {
    if (sphere.radius != other.sphere.radius) return sphere.radius < other.sphere.radius;
    return std::lexicographical_compare(sphere.center.begin(), sphere.center.end(),
                                        other.sphere.center.begin(), other.sphere.center.end());
  }
};

// At the median of the piece's centres along their longest extent.
std::array<Group, 2> split(const Group& group) {
  Eigen::AlignedBox3d box;
  for (const Piece& piece : group.pieces) box.extend(piece.center());
  const Eigen::Index axis = internal::longest_axis(box);
  const std::size_t half = internal::split_at_median(
      group.pieces, [axis](const Piece& piece) { return piece.center()[axis]; });
  const auto first = group.pieces.first(half);
  const auto rest = group.pieces.subspan(half);
  return {Group{sphere_around(first, group.outer), group.outer, first},
          Group{sphere_around(rest, group.outer), group.outer, rest}};
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

}  // namespace

std::vector<Sphere> refine_cover(const TriangleMesh& mesh, std::span<const Sphere> cover,
                                 std::size_t count, double slack) {
  // Of right-angled pieces with two edges of length e, 2 / e^2 fill a unit of area.
  const double pieces = kPiecesPerSphere * static_cast<double>(count);
  Cutter cutter(cover, std::sqrt(2.0) * std::sqrt(2.0 * area(mesh) / pieces));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    cutter.cut({corners_of(mesh, mesh.triangles[i])}, "triangle " + std::to_string(i));
  }
  std::vector<std::vector<Piece>> held = cutter.take();
  std::priority_queue<Group> groups;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    if (held[i].empty()) continue;
    const Sphere outer{cover[i].center, cover[i].radius + slack};
    groups.push({sphere_around(held[i], outer), outer, held[i]});
  }
  std::vector<Sphere> spheres;
  while (!groups.empty()) {
    const Group largest = groups.top();
    groups.pop();
    if (largest.pieces.size() < 2 || spheres.size() + groups.size() + 1 >= count) {
      spheres.push_back(largest.sphere);
      continue;
    }
    for (const Group& half : split(largest)) groups.push(half);
  }
  return spheres;
}

std::vector<Sphere> coarse_cover(const SphereTree& tree, std::size_t count) {
  std::priority_queue<std::pair<double, std::size_t>> nodes;
  nodes.push({tree.sphere(0).radius, 0});
  std::vector<Sphere> spheres;
  while (!nodes.empty()) {
    const std::size_t node = nodes.top().second;
    nodes.pop();
    const auto children = static_cast<std::size_t>(tree.child_count(node));
    if (tree.is_leaf(node) || spheres.size() + nodes.size() + children > count) {
      spheres.push_back(tree.sphere(node));
      continue;
    }
    for (std::size_t i = 0; i < children; ++i) {
      const std::size_t child = static_cast<std::size_t>(tree.first_child(node)) + i;
      nodes.push({tree.sphere(child).radius, child});
    }
  }
  return spheres;
}

namespace {

template <class Volume>
class FclPair : public PairEngine {
 public:
  FclPair(const TriangleMesh& a, const TriangleMesh& b, bool boxes_in_front)
      : a_(a), b_(b), box_(b_.world_box(world_from_b_)), boxes_in_front_(boxes_in_front) {}

  void set_poses(std::span<const Pose> world_from_a) override {
    poses_.clear();
    for (const Pose& pose : world_from_a) poses_.push_back(fcl_pose<S>(pose));
  }

  bool collides(std::size_t pose) override {
    if (boxes_in_front_ && !a_.world_box(poses_[pose]).intersects(box_)) return false;
    return fcl_meshes_touch<Volume>(*a_.geometry, poses_[pose], *b_.geometry, world_from_b_);
  }

  double distance(std::size_t pose) override {
    return static_cast<double>(
        fcl_mesh_distance<Volume>(*a_.geometry, poses_[pose], *b_.geometry, world_from_b_));
  }

 private:
  using S = typename Volume::S;

  const fcl::Transform3<S> world_from_b_ = fcl::Transform3<S>::Identity();
  FclModel<Volume> a_;
  FclModel<Volume> b_;
  Eigen::AlignedBox<S, 3> box_;
  bool boxes_in_front_;
  std::vector<fcl::Transform3<S>> poses_;
};

template <class Volume>
NamedPairEngine named(const char* name, const TriangleMesh& a, const TriangleMesh& b,
                      bool boxes_in_front) {
  return {name, std::make_unique<FclPair<Volume>>(a, b, boxes_in_front)};
}

std::vector<NamedPairEngine> collide_engines(const TriangleMesh& a, const TriangleMesh& b,
                                             bool boxes_in_front) {
  std::vector<NamedPairEngine> engines;
  engines.push_back(named<fcl::OBB<double>>("OBB double", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBB<float>>("OBB float", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBBRSS<double>>("OBBRSS double", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBBRSS<float>>("OBBRSS float", a, b, boxes_in_front));
  return engines;
}

}  // namespace

std::vector<NamedPairEngine> fcl_collide_engines(const TriangleMesh& a, const TriangleMesh& b) {
  return collide_engines(a, b, false);
}

std::vector<NamedPairEngine> fcl_boxed_collide_engines(const TriangleMesh& a,
                                                       const TriangleMesh& b) {
  return collide_engines(a, b, true);
}

std::vector<NamedPairEngine> fcl_distance_engines(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<NamedPairEngine> engines;
  engines.push_back(named<fcl::OBBRSS<double>>("OBBRSS double", a, b, false));
  engines.push_back(named<fcl::OBBRSS<float>>("OBBRSS float", a, b, false));
  engines.push_back(named<fcl::RSS<double>>("RSS double", a, b, false));
  return engines;
}

namespace {

// Long against the clock and the change of caches, short against a time slice of the machine.
constexpr std::size_t kRun = 1024;

}  // namespace

std::vector<double> time_in_turns(std::span<const std::unique_ptr<Checker>> checkers,
                                  std::span<const ArmPositions> configurations, int rounds) {
  const std::size_t runs = (configurations.size() + kRun - 1) / kRun;
  // By checker and run: the least so far.
  std::vector<std::vector<double>> least(
      checkers.size(), std::vector<double>(runs, std::numeric_limits<double>::infinity()));
  std::vector<std::uint8_t> verdicts(kRun);
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t run = 0; run < runs; ++run) {
      const std::size_t first = run * kRun;
      const auto queried =
          configurations.subspan(first, std::min(kRun, configurations.size() - first));
      for (std::size_t i = 0; i < checkers.size(); ++i) {
        const auto start = Clock::now();
        checkers[i]->check(queried, {verdicts.data(), queried.size()});
        const double time = nanoseconds(Clock::now() - start);
        if (round >= 0) least[i][run] = std::min(least[i][run], time);
      }
    }
  }
  std::vector<double> result;
  for (const auto& of_checker : least) {
    const double sum = std::accumulate(of_checker.begin(), of_checker.end(), 0.0);
    result.push_back(sum / static_cast<double>(configurations.size()));
  }
  return result;
}

std::vector<std::uint8_t> verdicts_of(Checker& checker,
                                      std::span<const ArmPositions> configurations) {
  std::vector<std::uint8_t> verdicts(configurations.size());
  checker.check(configurations, verdicts);
  return verdicts;
}

}  // namespace spherule
