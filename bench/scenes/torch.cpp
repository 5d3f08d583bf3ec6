// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/torch.h"

#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

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

}  // namespace spherule
