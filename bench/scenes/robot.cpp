// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/work_cell.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <numbers>
#include <string>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

struct JointRow {
  Vector3d origin;  // in the parent link's frame
  Vector3d axis;
  double lower;
  double upper;
};

// The figures of ABB's robot, as the ROS-Industrial description of it states them.
const JointRow kRows[kJoints] = {
    {{0.0, 0.0, 0.0}, Vector3d::UnitZ(), -2.87979, 2.87979},
    {{0.2, 0.0, 0.68}, Vector3d::UnitY(), -1.2217, 1.658},
    {{0.0, 0.0, 0.89}, Vector3d::UnitY(), -1.0472, 1.1345},
    {{1.38, 0.0, 0.15}, Vector3d::UnitX(), -3.49, 3.49},
    {{0.0, 0.0, 0.0}, Vector3d::UnitY(), -2.0944, 2.0944},
    {{0.0, 0.0, 0.0}, Vector3d::UnitX(), -6.9813, 6.9813},
};

}  // namespace

RobotModel make_robot() {
  RobotModel robot("base_link");
  std::string parent = "base_link";
  for (int i = 0; i < kJoints; ++i) {
    const JointRow& row = kRows[i];
    const std::string number = std::to_string(i + 1);
    const std::string link = "link_" + number;
    robot.add_link(link, parent,
                   {.name = "joint_" + number,
                    .type = JointType::kRevolute,
                    .parent_from_joint = Pose::from_translation(row.origin),
                    .axis = row.axis,
                    .lower = row.lower,
                    .upper = row.upper});
    parent = link;
  }
  return robot;
}

Pose link6_from_flange() {
  return Pose::from_translation({0.14, 0.0, 0.0});
}

namespace {

// The links of make_robot() as solids. Each is drawn in its own frame, in metres; the boxes follow
// those of the real robot's published visual meshes to some centimetres.

using Eigen::Matrix3d;
using Eigen::Vector2d;

const Vector2d kOrigin = Vector2d::Zero();

// A shell that is turned first, then shifted, and added.
void add_turned(TriangleMesh& mesh, const TriangleMesh& shell, const Matrix3d& turn,
                const Vector3d& shift = Vector3d::Zero()) {
  append(mesh, placed(shell, turn, shift));
}

void add(TriangleMesh& mesh, const TriangleMesh& shell, const Vector3d& shift = Vector3d::Zero()) {
  append(mesh, shifted(shell, shift));
}

// A round flange with a bore and a ring of screw holes, from z = 0 to z = height.
TriangleMesh flange(double radius, double bore, double height, int screws, int sides) {
  std::vector<Loop> holes =
      screw_holes(kOrigin, 0.5 * (radius + bore), screws, 0.12 * (radius - bore), 4);
  if (bore > 0.0) holes.push_back(circle(kOrigin, bore, sides / 2));
  return extrude(circle(kOrigin, radius, sides), holes, 0.0, height);
}

// A motor with its cap, along z from 0: body, neck, cap.
TriangleMesh motor(double radius, double length, int sides) {
  const Loop profile{{0.0, 0.0},
                     {radius, 0.0},
                     {radius, 0.55 * length},
                     {0.8 * radius, 0.6 * length},
                     {0.92 * radius, 0.66 * length},
                     {0.92 * radius, 0.96 * length},
                     {0.85 * radius, length},
                     {0.0, length}};
  return revolve(profile, sides);
}

// Triangular gussets in vertical planes around the z axis, from `inner` to `outer`.
void add_ribs(TriangleMesh& mesh, int count, double inner, double outer, double bottom, double top,
              double thickness) {
  const Loop outline{{inner, bottom}, {outer, bottom}, {inner, top}};
  const TriangleMesh rib =
      placed(extrude(outline, {}, -0.5 * thickness, 0.5 * thickness), profile_xz(), {0, 0, 0});
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / count;
    add_turned(mesh, rib, Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix());
  }
}

TriangleMesh base_link() {
  TriangleMesh mesh;
  std::vector<Loop> bolts;
  for (const double x : {-0.46, -0.2, 0.06, 0.32}) {
    for (const double y : {-0.26, 0.26}) bolts.push_back(circle({x, y}, 0.016, 6));
  }
  add(mesh, extrude(rectangle({-0.07, 0.0}, {0.92, 0.64}, 0.06, 3), bolts, 0.0, 0.035));
  const Loop pedestal{{0.10, 0.02}, {0.29, 0.02}, {0.26, 0.08}, {0.25, 0.17}, {0.10, 0.17}};
  add(mesh, revolve(pedestal, 18));
  add(mesh, flange(0.28, 0.12, 0.055, 6, 20), {0.0, 0.0, 0.165});
  add_ribs(mesh, 6, 0.2, 0.31, 0.03, 0.15, 0.02);
  add(mesh, make_box({0.26, 0.34, 0.15}), {-0.39, 0.0, 0.1});
  add(mesh, make_box({0.02, 0.2, 0.08}), {-0.515, 0.0, 0.1});
  return mesh;
}

TriangleMesh link_1() {
  TriangleMesh mesh;
  add(mesh, flange(0.29, 0.13, 0.045, 6, 20), {0.0, 0.0, 0.2});
  // The column: one plate each side with pockets, a wall between them, the axis-2 bearings on top.
  const Loop side{{-0.34, 0.24}, {0.22, 0.24}, {0.33, 0.42},  {0.34, 0.70},  {0.27, 0.81},
                  {0.14, 0.81},  {0.02, 0.66}, {-0.20, 0.60}, {-0.42, 0.52}, {-0.46, 0.36}};
  std::vector<Loop> pockets = screw_holes({0.2, 0.68}, 0.095, 4, 0.008, 4);
  pockets.push_back(circle({0.2, 0.68}, 0.06, 12));
  pockets.push_back(circle({-0.30, 0.41}, 0.075, 12));
  pockets.push_back({{-0.12, 0.33}, {0.05, 0.33}, {0.12, 0.46}, {0.02, 0.52}, {-0.12, 0.47}});
  for (const double y : {-0.135, 0.21}) {
    add_turned(mesh, extrude(side, pockets, 0.0, 0.055), profile_xz(), {0.0, y, 0.0});
  }
  const Loop wall{{-0.30, 0.24}, {0.16, 0.24}, {0.20, 0.40}, {0.04, 0.52}, {-0.36, 0.46}};
  add_turned(mesh, extrude(wall, {}, -0.155, 0.155), profile_xz());
  for (int rib = 0; rib < 3; ++rib) {
    const double x = -0.36 + 0.11 * rib;
    add(mesh, make_box({0.016, 0.34, 0.14}), {x, 0.0, 0.52});
  }
  // Gear boxes and motors of axes 2 and 3, the counterweight's cylinder, the motor of axis 1.
  for (const double sign : {-1.0, 1.0}) {
    const Matrix3d outwards =
        sign > 0 ? along_y()
                 : Matrix3d(Eigen::DiagonalMatrix<double, 3>(-1.0, -1.0, 1.0) * along_y());
    add_turned(mesh, flange(0.15, 0.0, 0.06, 5, 16), outwards, {0.2, sign * 0.2, 0.68});
    add_turned(mesh, motor(0.085, 0.225, 10), outwards, {0.2, sign * 0.25, 0.68});
  }
  const Loop cylinder_profile{{0.0, 0.0},   {0.07, 0.0},  {0.07, 0.03}, {0.06, 0.05},
                              {0.06, 0.42}, {0.04, 0.44}, {0.04, 0.5},  {0.0, 0.5}};
  add_turned(mesh, revolve(cylinder_profile, 12), along_x(), {-0.56, 0.06, 0.62});
  add(mesh, motor(0.095, 0.42, 12), {-0.21, -0.05, 0.49});
  const Loop cable{{0.03, -0.012}, {0.045, -0.012}, {0.045, 0.012}, {0.03, 0.012}};
  for (const double x : {-0.1, 0.1}) {
    add_turned(mesh, revolve(cable, 8), along_x(), {x, -0.19, 0.33});
  }
  return mesh;
}

TriangleMesh link_2() {
  TriangleMesh mesh;
  // The lower arm from axis 2 to axis 3: a web with holes, rims on both sides, hubs at the ends.
  const Loop outline = belt(kOrigin, 0.125, {0.0, 0.89}, 0.1, 8);
  std::vector<Loop> web_holes;
  for (const double z : {0.24, 0.40, 0.56, 0.70}) web_holes.push_back(circle({0.0, z}, 0.05, 8));
  add_turned(mesh, extrude(outline, web_holes, -0.03, 0.03), profile_xz());
  const Loop window = belt({0.0, 0.2}, 0.075, {0.0, 0.72}, 0.065, 6);
  for (const double y : {-0.03, 0.09}) {
    add_turned(mesh, extrude(outline, {window}, 0.0, 0.06), profile_xz(), {0.0, y, 0.0});
  }
  for (const double z : {0.0, 0.89}) {
    const double radius = z == 0.0 ? 0.115 : 0.09;
    for (const double y : {-0.11, 0.085}) {
      add_turned(mesh, flange(radius, 0.04, 0.03, 4, 12), along_y(), {0.0, y, z});
    }
  }
  // The lug of the balancing cylinder below, the bracket of the cable chain in front.
  add_turned(mesh,
             extrude(belt(kOrigin, 0.05, {-0.07, -0.11}, 0.03, 4),
                     {circle({-0.07, -0.11}, 0.015, 6)}, -0.05, 0.0),
             profile_xz());
  add(mesh, make_box({0.06, 0.08, 0.5}), {0.13, 0.02, 0.45});
  for (const double z : {0.28, 0.45, 0.62})
    add(mesh, make_box({0.03, 0.1, 0.02}), {0.175, 0.02, z});
  return mesh;
}

TriangleMesh link_3() {
  TriangleMesh mesh;
  // The housing of axes 3 and 4.
  const Loop side{{-0.22, 0.05}, {-0.08, -0.07}, {0.08, -0.08}, {0.16, 0.03},
                  {0.19, 0.09},  {0.19, 0.22},   {0.10, 0.27},  {-0.18, 0.27}};
  std::vector<Loop> holes = screw_holes(kOrigin, 0.06, 4, 0.007, 4);
  holes.push_back(circle(kOrigin, 0.04, 8));
  for (const double y : {-0.10, 0.15}) {
    add_turned(mesh, extrude(side, holes, 0.0, 0.035), profile_xz(), {0.0, y, 0.0});
  }
  const Loop core{{-0.20, 0.08}, {-0.05, 0.03}, {0.15, 0.05},
                  {0.17, 0.2},   {0.09, 0.25},  {-0.16, 0.25}};
  add_turned(mesh, extrude(core, {}, -0.12, 0.12), profile_xz());
  for (const double x : {-0.12, -0.06, 0.0, 0.06}) {
    add(mesh, make_box({0.012, 0.26, 0.05}), {x, 0.0, 0.255});
  }
  // The bearing of axis 4 with its flange, and the three wrist motors at the back.
  const Loop bearing{{0.05, 0.0},  {0.125, 0.0}, {0.125, 0.06},
                     {0.11, 0.07}, {0.11, 0.09}, {0.05, 0.09}};
  add_turned(mesh, revolve(bearing, 16), along_x(), {0.15, 0.0, 0.15});
  add_turned(mesh, flange(0.125, 0.05, 0.02, 6, 16), along_x(), {0.2275, 0.0, 0.15});
  const Matrix3d backwards = Eigen::DiagonalMatrix<double, 3>(-1.0, -1.0, 1.0) * along_x();
  for (const Vector2d& place :
       {Vector2d(-0.075, 0.12), Vector2d(0.075, 0.12), Vector2d(0.0, 0.21)}) {
    add_turned(mesh, flange(0.065, 0.0, 0.02, 0, 10), backwards, {-0.17, place.x(), place.y()});
    add_turned(mesh, motor(0.055, 0.265, 10), backwards, {-0.18, place.x(), place.y()});
  }
  add_turned(mesh, flange(0.1, 0.0, 0.06, 4, 16), along_y(), {0.0, -0.2, 0.0});
  add_turned(mesh, motor(0.06, 0.05, 10), along_y(), {0.0, -0.22, 0.0});
  return mesh;
}

TriangleMesh link_4() {
  TriangleMesh mesh;
  // The forearm, a tapered hollow tube along x, and the fork of axis 5.
  const Loop tube{{0.06, -1.1325}, {0.116, -1.1325}, {0.116, -1.08}, {0.10, -1.05}, {0.085, -0.3},
                  {0.095, -0.24},  {0.10, -0.16},    {0.075, -0.14}, {0.06, -0.2}};
  add_turned(mesh, revolve(tube, 16), along_x());
  add_turned(mesh, flange(0.112, 0.065, 0.02, 4, 16), along_x(), {-1.1, 0.0, 0.0});
  for (int rib = 0; rib < 4; ++rib) {
    const double angle = 0.5 * std::numbers::pi * (rib + 0.5);
    add_turned(mesh, make_box({0.8, 0.016, 0.03}),
               Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix(),
               Eigen::AngleAxisd(angle, Vector3d::UnitX()) * Vector3d(-0.65, 0.0, 0.088));
  }
  const Loop prong = belt({-0.17, 0.0}, 0.09, {0.02, 0.0}, 0.095, 6);
  std::vector<Loop> holes = screw_holes({0.02, 0.0}, 0.07, 4, 0.006, 4);
  holes.push_back(circle({0.02, 0.0}, 0.035, 8));
  for (const double y : {-0.04, 0.095}) {
    add_turned(mesh, extrude(prong, holes, 0.0, 0.055), profile_xz(), {0.0, y, 0.0});
  }
  for (const double y : {-0.124, 0.094}) {
    add_turned(mesh, flange(0.06, 0.0, 0.03, 0, 12), along_y(), {0.02, y, 0.0});
  }
  add(mesh, make_box({0.12, 0.05, 0.06}), {-0.45, 0.0, 0.1});
  add(mesh, make_box({0.2, 0.1, 0.16}), {-0.24, 0.0, 0.0});
  return mesh;
}

TriangleMesh link_5() {
  TriangleMesh mesh;
  const Loop knuckle = belt({-0.03, 0.0}, 0.065, {0.045, 0.0}, 0.05, 6);
  std::vector<Loop> holes = screw_holes({-0.03, 0.0}, 0.045, 4, 0.005, 4);
  add_turned(mesh, extrude(knuckle, holes, -0.03, 0.03), profile_xz());
  const Loop shaft{{0.0, -0.033},  {0.032, -0.033}, {0.036, -0.028},
                   {0.036, 0.028}, {0.032, 0.033},  {0.0, 0.033}};
  add_turned(mesh, revolve(shaft, 12), along_y(), {-0.03, 0.0, 0.0});
  const Loop bearing{{0.0, 0.0}, {0.03, 0.0}, {0.033, 0.01}, {0.033, 0.04}, {0.0, 0.04}};
  add_turned(mesh, revolve(bearing, 12), along_x(), {0.0548, 0.0, 0.0});
  for (const double z : {-0.066, 0.066}) add(mesh, make_box({0.07, 0.03, 0.02}), {-0.03, 0.0, z});
  return mesh;
}

TriangleMesh link_6() {
  TriangleMesh mesh;
  const Loop neck{{0.0, 0.08},    {0.03, 0.08},   {0.03, 0.1},
                  {0.045, 0.115}, {0.045, 0.125}, {0.0, 0.125}};
  add_turned(mesh, revolve(neck, 10), along_x());
  std::vector<Loop> screws = screw_holes(kOrigin, 0.05, 6, 0.005, 4);
  screws.push_back(circle(kOrigin, 0.016, 8));
  screws.push_back(circle({0.0, 0.032}, 0.003, 4));
  add_turned(mesh, extrude(circle(kOrigin, 0.0625, 16), screws, 0.12, 0.14), along_x());
  return mesh;
}

}  // namespace

std::array<TriangleMesh, kJoints + 1> make_robot_links() {
  std::array<TriangleMesh, kJoints + 1> links{base_link(), link_1(), link_2(), link_3(),
                                              link_4(),    link_5(), link_6()};
  constexpr std::array<std::size_t, kJoints + 1> kCounts{776, 1758, 1190, 1494, 966, 324, 316};
  for (std::size_t i = 0; i < links.size(); ++i) {
    snap(links[i]);
    refine_to(links[i], kCounts[i]);
    snap(links[i]);
  }
  // A closed surface has an even number of triangles, 6,825 is odd. Exporters leave facets of zero
  // area behind, and so does this one: two of its corners are the same vertex, so that it adds no
  // point and no open edge.
  const Eigen::Vector3i first = links[1].triangles.front();
  links[1].triangles.emplace_back(first[0], first[0], first[1]);
  return links;
}

}  // namespace spherule
