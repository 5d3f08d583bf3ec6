// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/workpiece.h"

#include "tests/support/solids.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kTriangles = 1942;
constexpr int kSides = 64;  // a multiple of 4: the top and the bottom of the joint are corners
constexpr int kPipes = 3;
// Rings of one pipe, as shares of the way from the seam to the end.
constexpr std::array kOuterRings{0.0, 0.4, 1.0};
constexpr std::array kBoreRings{0.0, 0.4, 1.0};

// The horizontal direction that is left of a pipe's axis.
Vector3d left_of(int pipe) {
  const Vector3d axis = pipe_axis(pipe);
  return {-axis.y(), axis.x(), 0.0};
}

Vector3d normal_at(int pipe, double angle) {
  return std::cos(angle) * left_of(pipe) + std::sin(angle) * Vector3d::UnitZ();
}

// The mitre planes stand at 60 degrees to both axes: at a sideways distance y they cut a pipe at
// y / tan 60 along its axis.
double seam_distance(double radius, double angle) {
  return radius * std::abs(std::cos(angle)) / std::numbers::sqrt3;
}

// Collects vertices of the joint; the seams' are shared by the pipes that meet there. They are
// known by their place on the drawing, not by comparing coordinates.
class JointMesh {
 public:
  // Vertex of a ring of `pipe`; ring 0 is the seam.
  int vertex(int pipe, bool bore, int ring, double share, int side) {
    Key key{pipe, bore, ring, side};
    if (ring == 0) key = seam_key(pipe, bore, side);
    const auto [place, is_new] = index_.try_emplace(key, static_cast<int>(mesh.vertices.size()));
    if (is_new) {
      const double radius = bore ? kPipeBoreRadius : kPipeRadius;
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const double start = seam_distance(radius, angle);
      const double along = start + share * (kPipeLength - start);
      mesh.vertices.push_back(along * pipe_axis(pipe) + radius * normal_at(pipe, angle));
    }
    return place->second;
  }

  void quad(int a, int b, int c, int d) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  }

  TriangleMesh mesh;

 private:
  using Key = std::tuple<int, bool, int, int>;

  // The left half of a pipe's seam is shared with the next pipe, whose right half mirrors it; the
  // top and the bottom are shared by all.
  static Key seam_key(int pipe, bool bore, int side) {
    constexpr int kTop = kSides / 4;
    constexpr int kBottom = 3 * kSides / 4;
    if (side == kTop || side == kBottom) return {0, bore, 0, side};
    const bool right = side > kTop && side < kBottom;
    if (!right) return {pipe, bore, 0, side};
    const int mirrored = (kSides / 2 - side + kSides) % kSides;
    return {(pipe + kPipes - 1) % kPipes, bore, 0, mirrored};
  }

  std::map<Key, int> index_;
};

}  // namespace

Vector3d pipe_axis(int pipe) {
  const double angle = 2.0 * std::numbers::pi * pipe / kPipes;
  return {std::cos(angle), std::sin(angle), 0.0};
}

SeamPoint seam_point(int pipe, double angle) {
  const int next = (pipe + 1) % kPipes;
  const Vector3d normal = normal_at(pipe, angle);
  return {seam_distance(kPipeRadius, angle) * pipe_axis(pipe) + kPipeRadius * normal, normal,
          normal_at(next, std::numbers::pi - angle)};
}

SeamPoint rim_point(int pipe, double angle) {
  return pipe_point(pipe, kPipeLength, angle);
}

SeamPoint pipe_point(int pipe, double distance, double angle) {
  const Vector3d normal = normal_at(pipe, angle);
  return {distance * pipe_axis(pipe) + kPipeRadius * normal, normal, normal};
}

TriangleMesh make_workpiece() {
  JointMesh joint;
  for (int pipe = 0; pipe < kPipes; ++pipe) {
    const auto wall = [&](bool bore, const auto& rings) {
      for (int ring = 0; ring + 1 < static_cast<int>(rings.size()); ++ring) {
        for (int side = 0; side < kSides; ++side) {
          const int next = (side + 1) % kSides;
          const auto corner = [&](int r, int s) {
            return joint.vertex(pipe, bore, r, rings[static_cast<std::size_t>(r)], s);
          };
          // Seen from outside, the angle grows against the clock about the axis.
          const std::array corners{corner(ring, side), corner(ring, next), corner(ring + 1, next),
                                   corner(ring + 1, side)};
          if (bore) {
            joint.quad(corners[3], corners[2], corners[1], corners[0]);
          } else {
            joint.quad(corners[0], corners[1], corners[2], corners[3]);
          }
        }
      }
    };
    wall(false, kOuterRings);
    wall(true, kBoreRings);
    constexpr int kOuterEnd = kOuterRings.size() - 1;
    constexpr int kBoreEnd = kBoreRings.size() - 1;
    for (int side = 0; side < kSides; ++side) {
      const int next = (side + 1) % kSides;
      joint.quad(joint.vertex(pipe, false, kOuterEnd, 1.0, side),
                 joint.vertex(pipe, false, kOuterEnd, 1.0, next),
                 joint.vertex(pipe, true, kBoreEnd, 1.0, next),
                 joint.vertex(pipe, true, kBoreEnd, 1.0, side));
    }
  }
  snap(joint.mesh);
  refine_to(joint.mesh, kTriangles);
  snap(joint.mesh);
  return std::move(joint.mesh);
}

}  // namespace spherule
