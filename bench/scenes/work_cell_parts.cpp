// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/work_cell.h"
#include "tests/support/shapes.h"
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

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTopThickness = 0.04;
const Vector2d kTopSize(0.9, 1.2);

// A block with a V on top in which a pipe along y lies, its axis at the origin of z.
TriangleMesh v_stand() {
  // The V's flanks stand at 45 degrees and stay a millimetre off the pipe.
  const double groove = (kPipeRadius + 0.001) * 1.4142;
  const double half = 0.03;
  const Loop outline{{-half, -kWorkpieceHeight},
                     {half, -kWorkpieceHeight},
                     {half, half - groove},
                     {0.0, -groove},
                     {-half, half - groove}};
  return placed(extrude(outline, {}, -0.012, 0.012), profile_xz(), Vector3d::Zero());
}

}  // namespace

TriangleMesh make_table() {
  TriangleMesh mesh =
      shifted(make_plate_with_holes({kTopSize.x(), kTopSize.y(), kTopThickness}, 4, 5, 0.028, 8),
              {0.0, 0.0, kTableHeight - 0.5 * kTopThickness});
  for (const double x : {-0.38, 0.38}) {
    for (const double y : {-0.53, 0.53}) {
      append(mesh, shifted(make_box({0.08, 0.08, kTableHeight - kTopThickness}),
                           {x, y, 0.5 * (kTableHeight - kTopThickness)}));
    }
  }
  for (int pipe = 0; pipe < 3; ++pipe) {
    const Vector3d axis = pipe_axis(pipe);
    Eigen::Matrix3d turn;
    turn << axis.y(), axis.x(), 0.0, -axis.x(), axis.y(), 0.0, 0.0, 0.0, 1.0;
    append(mesh, placed(v_stand(), turn,
                        0.17 * axis + Vector3d(0.0, 0.0, kTableHeight + kWorkpieceHeight)));
  }
  append(mesh, shifted(make_box({0.06, 0.06, 0.75}), {-0.32, 0.58, kTableHeight + 0.375}));
  append(mesh, shifted(make_box({0.05, 0.16, 0.05}), {-0.32, 0.52, kTableHeight + 0.70}));
  append(mesh, shifted(make_cylinder(0.02, 0.12, 12), {-0.32, 0.47, kTableHeight + 0.66}));
  snap(mesh);
  return mesh;
}

namespace {

constexpr std::size_t kTriangles = 4318;
constexpr double kBend = 0.25 * std::numbers::pi;  // of the swan neck, towards -z
constexpr double kBendStart = 0.235;               // along x
constexpr double kBendRadius = 0.09;
constexpr double kNeckRadius = 0.0105;
constexpr double kStraight = 0.03;  // from the bend to the nozzle's rear end
constexpr double kNozzleLength = 0.07;
constexpr double kStickOut = 0.014;  // wire in front of the nozzle
constexpr double kWireRadius = 0.0006;

Vector3d wire_direction() {
  return {std::cos(kBend), 0.0, -std::sin(kBend)};
}

// Where the bend ends.
Vector3d bend_end() {
  return {kBendStart + kBendRadius * std::sin(kBend), 0.0, -kBendRadius * (1.0 - std::cos(kBend))};
}

// Turns z into the wire's direction: what is drawn along z stands behind the bend.
Eigen::Matrix3d along_wire() {
  return Eigen::AngleAxisd(0.5 * std::numbers::pi + kBend, Vector3d::UnitY()).toRotationMatrix();
}

TriangleMesh swan_neck() {
  std::vector<Vector3d> path{{0.15, 0.0, 0.0}};
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = kBend * i / kSteps;
    path.emplace_back(kBendStart + kBendRadius * std::sin(angle), 0.0,
                      -kBendRadius * (1.0 - std::cos(angle)));
  }
  path.push_back(bend_end() + (kStraight + 0.02) * wire_direction());
  return tube_along(path, std::vector<double>(path.size(), kNeckRadius), 24);
}

// Along z from the nozzle's rear end: nozzle, insulator, contact tip, wire.
TriangleMesh nozzle() {
  TriangleMesh mesh;
  const Loop outside{
      {0.009, 0.0},    {0.0125, 0.0},           {0.0135, 0.003},         {0.0135, 0.045},
      {0.0110, 0.06},  {0.0110, kNozzleLength}, {0.0085, kNozzleLength}, {0.0085, 0.058},
      {0.0105, 0.045}, {0.0105, 0.012},         {0.009, 0.010}};
  append(mesh, revolve(outside, 32));
  const Loop insulator{
      {0.0, -0.012}, {0.0145, -0.012}, {0.0145, -0.002}, {0.0095, 0.004}, {0.0, 0.004}};
  append(mesh, revolve(insulator, 28));
  const Loop tip{{0.0, 0.002},   {0.0065, 0.002}, {0.0065, 0.03}, {0.004, 0.034},
                 {0.004, 0.062}, {0.0025, 0.066}, {0.0, 0.066}};
  append(mesh, revolve(tip, 20));
  append(mesh, shifted(make_cylinder(kWireRadius, kStickOut + 0.012, 8),
                       {0.0, 0.0, kNozzleLength + 0.5 * kStickOut - 0.006}));
  return mesh;
}

// Along x from the flange: adapter plate, shock sensor, body with rings, cable entry.
TriangleMesh body() {
  TriangleMesh mesh;
  std::vector<Loop> screws = screw_holes(Vector2d::Zero(), 0.04, 6, 0.0035, 8);
  append(mesh, placed(extrude(circle(Vector2d::Zero(), 0.05, 36), screws, 0.0, 0.012), along_x(),
                      Vector3d::Zero()));
  const Loop sensor{{0.0, 0.01},    {0.032, 0.01},  {0.036, 0.016}, {0.036, 0.05},
                    {0.030, 0.056}, {0.026, 0.075}, {0.0, 0.075}};
  append(mesh, placed(revolve(sensor, 32), along_x(), Vector3d::Zero()));
  const Loop handle{{0.0, 0.07},    {0.022, 0.07},  {0.024, 0.08},  {0.024, 0.10},
                    {0.021, 0.104}, {0.021, 0.112}, {0.024, 0.116}, {0.024, 0.15},
                    {0.018, 0.17},  {0.014, 0.19},  {0.014, 0.2},   {0.0, 0.2}};
  append(mesh, placed(revolve(handle, 28), along_x(), Vector3d::Zero()));
  // The hose package leaves upwards and backwards.
  std::vector<Vector3d> hose;
  std::vector<double> radii;
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kSteps;
    hose.emplace_back(0.135 - 0.07 * (1.0 - std::cos(angle)), 0.0, 0.01 + 0.07 * std::sin(angle));
    radii.push_back(i < 4 ? 0.014 : 0.0115);
  }
  hose.emplace_back(0.03, 0.0, 0.085);
  radii.push_back(0.0115);
  append(mesh, tube_along(hose, radii, 20));
  for (const double y : {-0.027, 0.027}) {
    append(mesh,
           shifted(make_box({0.05, 0.008, 0.03}), {0.045, y + (y > 0 ? 0.009 : -0.009), 0.0}));
  }
  return mesh;
}

}  // namespace

TriangleMesh make_torch() {
  TriangleMesh mesh = body();
  append(mesh, swan_neck());
  append(mesh, placed(nozzle(), along_wire(), bend_end() + kStraight * wire_direction()));
  snap(mesh);
  refine_to(mesh, kTriangles);
  snap(mesh);
  return mesh;
}

Pose flange_from_wire() {
  const Vector3d end = bend_end() + (kStraight + kNozzleLength + kStickOut) * wire_direction();
  return Pose(
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi + kBend, Vector3d::UnitY())),
      end);
}

namespace {

constexpr std::size_t kWorkpieceTriangles = 1942;
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
  refine_to(joint.mesh, kWorkpieceTriangles);
  snap(joint.mesh);
  return std::move(joint.mesh);
}

}  // namespace spherule
