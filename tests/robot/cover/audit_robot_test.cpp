// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/audit_robot.h"

#include "base/error.h"
#include "robot/cover/link_parts.h"
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "tests/robot/refusals.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;

// A bar; a link turned about z and shifted along x from it that has a smaller one; and one that has
// nothing. (What is inside is found by a flood whose cells are a share of the diagonal: quick in a
// bar.)
constexpr const char* kRobot = R"(<robot name="two"><link name="base">
  <collision><geometry><box size="0.2 0.002 0.002"/></geometry></collision></link>
<link name="arm"><collision><geometry><box size="0.08 0.001 0.001"/></geometry></collision></link>
<link name="bare"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
  <origin xyz="0.3 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="fixed" type="fixed"><parent link="arm"/><child link="bare"/></joint></robot>)";

const Vector3d kBaseHalf(0.1, 0.001, 0.001);

class AuditRobot : public ::testing::Test {
 protected:
  AuditRobot() : robot_(read_urdf(folder_.write("two.urdf", kRobot))) {}

  test::TempDir folder_;
  RobotDescription robot_;
};

// What a sphere about the middle holds from this radius on.
struct CurvedShape {
  std::string geometry;
  double radius;
};

// The mesh around a curved shape stands out of it by up to 0.5 mm, which is no leak of the shape,
// and leaks and the protrusion are those of the shape itself.
TEST_F(AuditRobot, LeaksOfCurvedShapesAreTheirOwn) {
  const auto audited = [&](const CurvedShape& shape, double radius) {
    const RobotDescription robot = read_urdf(folder_.write(
        "curved.urdf", "<robot name='curved'><link name='it'><collision><geometry>" +
                           shape.geometry + "</geometry></collision></link></robot>"));
    const std::vector<LinkSpheres> spheres{{"it", {{Vector3d::Zero(), radius}}}};
    return *audit_robot(robot, spheres).links.front().certificate;
  };
  const CurvedShape rod{"<cylinder radius='0.0025' length='0.1'/>", std::hypot(0.05, 0.0025)};
  const CurvedShape ball{"<sphere radius='0.01'/>", 0.01};
  // The ball's flood takes seconds.
  for (const CurvedShape& shape : test::effort(std::vector{rod, ball}, 1)) {
    SCOPED_TRACE(shape.geometry);
    const Certificate less = audited(shape, shape.radius - 0.001);
    EXPECT_LE(less.uncovered_depth.lower, 0.001);
    EXPECT_GE(less.uncovered_depth.lower, 0.00098);
    EXPECT_GE(less.uncovered_depth.upper, 0.001);
    const Certificate equal = audited(shape, shape.radius * (1.0 + 1e-12));
    EXPECT_TRUE(equal.covered);
    EXPECT_EQ(equal.uncovered_depth.upper, 0.0);
  }
  EXPECT_EQ(audited(rod, rod.radius + 0.0001).uncovered_depth.lower, 0.0);
  EXPECT_NEAR(audited(rod, rod.radius - 0.0001).uncovered_depth.lower, 0.0001, 5e-6);
  const Certificate more = audited(rod, rod.radius + 0.01);
  EXPECT_TRUE(more.covered);
  EXPECT_NEAR(more.protrusion_over_mesh->upper, rod.radius + 0.01 - 0.0025, 1e-12);
}

// At once: triangles around them would leak.
TEST_F(AuditRobot, ALinkOfSpheresIsCoveredByThem) {
  const RobotDescription robot = read_urdf(folder_.write(
      "balls.urdf",
      "<robot name='balls'><link name='it'><collision><geometry><sphere radius='0.05'/></geometry>"
      "</collision><collision><origin xyz='0.03 0 0.07' rpy='1 0 0'/><geometry>"
      "<sphere radius='0.04'/></geometry></collision></link></robot>"));
  const std::vector<LinkSpheres> spheres{
      {"it", {{Vector3d(0.03, 0, 0.07), 0.04}, {Vector3d::Zero(), 0.05}}}};
  const Certificate certificate = *audit_robot(robot, spheres).links.front().certificate;
  EXPECT_TRUE(certificate.covered);
  EXPECT_EQ(certificate.uncovered_depth.upper, 0.0);
  EXPECT_EQ(certificate.protrusion_over_mesh.value().upper, 0.0);
  EXPECT_EQ(certificate.pieces, 0U);
}

std::vector<Vector3d> corners_of(const Vector3d& half) {
  std::vector<Vector3d> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    corners.push_back(sign.cwiseProduct(half));
  }
  return corners;
}

// Of a box about the origin, from one sphere: a corner is the farthest point.
double depth_of_box(const Vector3d& half, const Sphere& sphere) {
  double farthest = 0.0;
  for (const Vector3d& corner : corners_of(half)) {
    farthest = std::max(farthest, (corner - sphere.center).norm());
  }
  return farthest - sphere.radius;
}

TEST_F(AuditRobot, LinkByLink) {
  const std::vector<LinkSpheres> spheres = {
      {"base", {{{0, 0, 0}, 0.09}}}, {"arm", {{{0, 0, 0}, 0.042}}}, {"ghost", {{{0, 0, 0}, 1}}}};
  const RobotAudit audit = audit_robot(robot_, spheres);
  ASSERT_EQ(audit.links.size(), 3u);
  EXPECT_FALSE(audit.links_covered);
  EXPECT_EQ(audit.unknown_links, std::vector<std::string>{"ghost"});
  const LinkAudit& base = audit.links[0];
  EXPECT_FALSE(base.certificate->covered);
  const double depth = depth_of_box(kBaseHalf, {{0, 0, 0}, 0.09});
  EXPECT_LE(base.certificate->surface_depth.lower, depth + 1e-12);
  EXPECT_GE(base.certificate->surface_depth.upper, depth - 1e-12);
  EXPECT_NEAR(base.certificate->surface_depth.lower, depth, 1e-3);
  EXPECT_TRUE(audit.links[1].certificate->covered);
  EXPECT_EQ(audit.links[1].uncovered_share, 0.0);
  EXPECT_FALSE(audit.links[2].certificate.has_value());

  // The share of the surface outside of the sphere, by random points on the faces.
  test::Random random(5);
  const Vector3d areas(kBaseHalf.y() * kBaseHalf.z(), kBaseHalf.x() * kBaseHalf.z(),
                       kBaseHalf.x() * kBaseHalf.y());
  const int points = test::effort(200000, 50000);
  int outside = 0;
  for (int i = 0; i < points; ++i) {
    const double pick = random.between(0, areas.sum());
    const int face = pick < areas.x() ? 0 : pick < areas.x() + areas.y() ? 1 : 2;
    Vector3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = random.between(-1, 1) * kBaseHalf[axis];
    point[face] = kBaseHalf[face];
    outside += point.norm() > 0.09 ? 1 : 0;
  }
  EXPECT_GT(outside, 0);
  EXPECT_NEAR(base.uncovered_share, static_cast<double>(outside) / points, 0.01);
}

TEST_F(AuditRobot, LinksWithoutSpheresLeak) {
  const RobotAudit audit = audit_robot(robot_, {});
  EXPECT_FALSE(audit.links_covered);
  EXPECT_FALSE(audit.links[0].certificate->covered);
  EXPECT_EQ(audit.links[0].uncovered_share, 1.0);
}

TEST_F(AuditRobot, NeighboursCoverInSomeConfigurations) {
  // The arm carries a sphere that holds the base where the joint stands near pi, and one for
  // itself.
  const Vector3d center(0.3, 0.0, 0.0);
  const double radius = 0.102;
  const std::vector<LinkSpheres> spheres = {{"base", {}},
                                            {"arm", {{center, radius}, {{0, 0, 0}, 0.045}}}};
  RobotAuditOptions options;
  for (const double q : test::effort(std::vector{std::numbers::pi, 0.0, 3.15, 3.5, -99.0}, 2)) {
    options.configurations.push_back({q});
  }
  const RobotAudit audit = audit_robot(robot_, spheres, options);
  ASSERT_EQ(audit.configurations.size(), options.configurations.size());
  EXPECT_FALSE(audit.links_covered);
  EXPECT_FALSE(audit.configurations_covered);
  for (std::size_t i = 0; i < options.configurations.size(); ++i) {
    const double q = options.configurations[i][0];
    const Sphere far{{0.3 + 0.3 * std::cos(q), 0.3 * std::sin(q), 0.0}, radius};
    const Sphere near{{0.3, 0.0, 0.0}, 0.045};
    // Of the base from both: no deeper than from either, and no less deep than a corner is.
    const double most = std::min(depth_of_box(kBaseHalf, far), depth_of_box(kBaseHalf, near));
    double least = 0.0;
    for (const Vector3d& corner : corners_of(kBaseHalf)) {
      least = std::max(least, std::min((corner - far.center).norm() - far.radius,
                                       (corner - near.center).norm() - near.radius));
    }
    const ConfigurationAudit& found = audit.configurations[i];
    if (most <= 0.0) {
      EXPECT_EQ(found.uncovered_depth.upper, 0.0) << q;
      EXPECT_EQ(found.deepest_link, "") << q;
      continue;
    }
    EXPECT_EQ(found.deepest_link, "base");
    ASSERT_TRUE(found.deepest_leak.has_value()) << q;
    const double left = std::min((*found.deepest_leak - far.center).norm() - far.radius,
                                 (*found.deepest_leak - near.center).norm() - near.radius);
    EXPECT_NEAR(left, found.uncovered_depth.lower, 1e-9) << q;
    EXPECT_LE(found.uncovered_depth.lower, most + 1e-12) << q;
    EXPECT_GE(found.uncovered_depth.lower, least - 1e-3) << q;
    EXPECT_GE(found.uncovered_depth.upper, least - 1e-12) << q;
  }
  EXPECT_EQ(audit.configurations[0].uncovered_depth.upper, 0.0);  // both kinds are there
  EXPECT_GT(audit.configurations[1].uncovered_depth.lower, 0.0);
  const RobotAudit good = audit_robot(robot_, spheres, {.configurations = {{std::numbers::pi}}});
  EXPECT_TRUE(good.configurations_covered);
}

// Of the arm, turned by a right angle, the ends, which lie along y in the frame of the root.
TEST_F(AuditRobot, TheLeakOfATurnedLinkIsInTheFrameOfTheRoot) {
  const std::vector<LinkSpheres> spheres = {{"base", {{{0, 0, 0}, 0.12}}},
                                            {"arm", {{{0, 0, 0}, 0.02}}}};
  const RobotAudit audit =
      audit_robot(robot_, spheres, {.configurations = {{std::numbers::pi / 2.0}}});
  ASSERT_EQ(audit.configurations.size(), 1U);
  EXPECT_EQ(audit.configurations[0].deepest_link, "arm");
  const Vector3d leak = audit.configurations[0].deepest_leak.value();
  EXPECT_NEAR(leak.x(), 0.3, 0.002);
  EXPECT_NEAR(std::abs(leak.y()), 0.04, 0.001);
}

TEST_F(AuditRobot, RepairCovers) {
  test::Random random(6);
  for (int round = 0; round < test::effort(2, 1); ++round) {
    std::vector<LinkSpheres> spheres = {{"base", {}}, {"ghost", {{{1, 2, 3}, 4}}}};
    for (int k = 0; k < 3; ++k) {
      Vector3d center;
      for (int axis = 0; axis < 3; ++axis) center[axis] = random.between(-1, 1) * kBaseHalf[axis];
      spheres[0].spheres.push_back({center, random.between(0.01, 0.03)});
    }
    const RobotRepair mended = repair_robot(robot_, spheres, {.max_error = 0.02});
    ASSERT_EQ(mended.spheres.size(), 3u);
    EXPECT_EQ(mended.spheres[1].spheres, spheres[1].spheres);
    EXPECT_EQ(mended.spheres[2].link, "arm");
    ASSERT_EQ(mended.links.size(), 2u);
    for (const LinkRepair& link : mended.links) {
      EXPECT_TRUE(link.certificate.covered) << link.link;
      EXPECT_EQ(link.repair.max_error, 0.02);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mended.spheres[0].spheres[k].center, spheres[0].spheres[k].center);
      EXPECT_GE(mended.spheres[0].spheres[k].radius, spheres[0].spheres[k].radius);
    }
    EXPECT_TRUE(audit_robot(robot_, mended.spheres, {.max_error = 0.02}).links_covered);
  }
}

// As it is when it is to be covered: in five minutes the repair did not end.
TEST(AuditRobotSizes, NoRepairOfALinkThatIsFarTooLargeForItsError) {
  RobotDescription robot{.name = "hall", .model = RobotModel("wall")};
  const Primitive wall = Box{.size = {40, 30, 20}};
  const Primitive pin = Box{.size = {0.1, 0.001, 0.001}};
  robot.links = {{.name = "pin", .collision = {{.name = "", .geometry = pin}}},
                 {.name = "wall", .collision = {{.name = "", .geometry = wall}}}};
  const std::vector<LinkSpheres> spheres = {{"wall", {{{0, 0, 0}, 1.0}}}};
  RobotRepairOptions options{.max_error = 0.005};
  // Before any link is repaired.
  options.progress = [](double, const char* link) { ADD_FAILURE() << link; };
  const std::string reason =
      test::reason_of([&] { repair_robot(robot, spheres, options); }, "link 'wall'");
  EXPECT_EQ(reason.find("is 53.8516 m across, too much for a max error of 0.005 m"), 0U) << reason;
}

// The bar is covered with less to spare than certify() sees; for this E no solid is examined. The
// other link is judged all the same.
TEST_F(AuditRobot, ALinkThatIsFarTooLargeForItsErrorIsNotProved) {
  std::vector<LinkSpheres> spheres = {{"base", {}}, {"arm", {{{0, 0, 0}, 0.05}}}};
  // Each holds one part of the bar, up to x = 0.013.
  const auto radius = [](double half) { return std::hypot(half, 0.001, 0.001) * (1.0 + 1e-9); };
  spheres[0].spheres = {{{-0.0435, 0, 0}, radius(0.0565)}, {{0.0565, 0, 0}, radius(0.0435)}};
  const RobotAudit audit = audit_robot(robot_, spheres, {.max_error = 1e-5});
  EXPECT_FALSE(audit.links[0].certificate->covered);
  EXPECT_EQ(audit.links[0].certificate->uncovered_depth.lower, 0.0);
  ASSERT_EQ(audit.links[0].warnings.size(), 1U);
  EXPECT_NE(audit.links[0].warnings[0].find("m across, too much for a max error of 1e-05 m"),
            std::string::npos)
      << audit.links[0].warnings[0];
  EXPECT_TRUE(audit.links[1].certificate->covered);
}

// The limit of the grid's cells in the place of a link that is as large as the usual one needs: a
// quarter of it is for a diameter that is chosen.
TEST_F(AuditRobot, TheSolidOfALinkIsThatOfACoverAndItsWarningToo) {
  const auto mesh = link_mesh(robot_.links[0], {});
  const SimplifyOptions lengths{.max_error = 0.001};
  const internal::LinkSolid usual(*mesh, lengths);
  EXPECT_EQ(usual.external().min_external_diameter, 4.0 * 0.001);
  EXPECT_TRUE(usual.warnings().empty());
  const std::size_t limit = 2 * usual.external().nodes_examined;
  const internal::LinkSolid larger(*mesh, lengths, limit);
  const double diameter = simplified_solid(*mesh, lengths, limit).options.min_external_diameter;
  EXPECT_GT(diameter, 4.0 * 0.001);
  EXPECT_EQ(larger.external().min_external_diameter, diameter);
  EXPECT_EQ(larger.certify_options().external, &larger.external());
  EXPECT_EQ(larger.warnings(), std::vector{internal::link_diameter_warning(diameter)});
}

// What an independent judge measured: the deepest leak of all of VAMP's spheres for the Panda.
TEST(AuditPublishedSpheres, LeakAsMeasuredBefore) {
  const auto models = test::models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const auto robots = *models / "robots";
  RobotDescription robot = read_urdf(robots / "franka_panda_vamp/panda_collision.urdf");
  std::erase_if(robot.links,
                [](const LinkDescription& link) { return link.name != "panda_link0"; });
  const auto set =
      read_robot_spheres(robots / "franka_panda/peer_spheres/vamp_panda_spherized.urdf");
  const RobotAudit audit = audit_robot(robot, set.spheres.links);
  ASSERT_EQ(audit.links.size(), 1u);
  const LinkAudit& link = audit.links.front();
  constexpr double kMeasured = 0.0825;
  EXPECT_LE(link.certificate->surface_depth.lower, kMeasured + 0.0001);
  EXPECT_GE(link.certificate->surface_depth.upper, kMeasured - 0.0001);
  EXPECT_NEAR(link.certificate->surface_depth.lower, kMeasured, 0.002);
  EXPECT_NEAR(link.uncovered_share, 0.74, 0.01);
}

TEST_F(AuditRobot, BadInput) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<LinkSpheres> good = {{"base", {{{0, 0, 0}, 0.2}}}};
  EXPECT_THROW(audit_robot(robot_, std::vector<LinkSpheres>{good[0], good[0]}), Error);
  EXPECT_THROW(audit_robot(robot_, std::vector<LinkSpheres>{{"base", {{{0, 0, kNan}, 1}}}}), Error);
  EXPECT_THROW(audit_robot(robot_, std::vector<LinkSpheres>{{"arm", {{{0, 0, 0}, -1}}}}), Error);
  EXPECT_THROW(audit_robot(robot_, good, {.geometry = LinkGeometry::kVisual}), Error);
  EXPECT_THROW(audit_robot(robot_, good, {.configurations = {{}}}), Error);
  EXPECT_THROW(audit_robot(robot_, good, {.configurations = {{kNan}}}), Error);
  EXPECT_THROW(audit_robot(robot_, good, {.configurations = {{101.0}}}), Error);
  EXPECT_THROW(audit_robot(robot_, good, {.max_error = 0.0}), Error);
  EXPECT_THROW(repair_robot(robot_, good, {.max_error = -1.0}), Error);
}

// What a joint mimics may be near where the joint itself is far out.
TEST_F(AuditRobot, PositionsOfMimicsAreLimited) {
  robot_.model.add_link("far", "arm", {.name = "follow", .type = JointType::kContinuous});
  robot_.model.mimic("follow", "turn", 200.0);
  robot_.links.push_back({.name = "far", .visual = {}, .collision = {}});
  const std::vector<LinkSpheres> good = {{"base", {{{0, 0, 0}, 0.2}}}};
  EXPECT_NO_THROW(audit_robot(robot_, good, {.configurations = {{0.5}}}));
  EXPECT_THROW(audit_robot(robot_, good, {.configurations = {{0.6}}}), Error);
}

}  // namespace
}  // namespace spherule
