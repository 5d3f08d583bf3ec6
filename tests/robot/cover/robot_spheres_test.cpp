// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/robot_spheres.h"

#include "io/mesh_io.h"
#include "tests/robot/refusals.h"
#include "tests/robot/solid_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

namespace spherule::test::robot_spheres_test {
namespace {

// How far outside of all spheres a point lies; below 0 within one.
Wide outside_of(const std::vector<Sphere>& spheres, const WidePoint& point) {
  Wide outside = std::numeric_limits<Wide>::infinity();
  for (const Sphere& sphere : spheres) {
    outside = std::min(outside, (point - sphere.center.cast<Wide>()).norm() - Wide(sphere.radius));
  }
  return outside;
}

// A point of a link, in its frame: of any of its primitives.
WidePoint point_of(const LinkDescription& link, Random& random) {
  const LinkShape& shape = link.collision[random.index(link.collision.size())];
  return move(shape.link_from_shape, point_of(std::get<Primitive>(shape.geometry), random));
}

// The farthest that a point of a sphere's surface lies from the shapes of the link, over samples.
Wide sampled_protrusion(const LinkCover& cover, const LinkDescription& link, Random& random) {
  Wide largest = 0;
  for (const Sphere& sphere : cover.spheres) {
    for (int k = 0; k < 50; ++k) {
      const WidePoint p = sphere.center.cast<Wide>() +
                          Wide(sphere.radius) * random.direction().cast<Wide>().normalized();
      Wide nearest = std::numeric_limits<Wide>::infinity();
      for (const LinkShape& shape : link.collision) {
        const Pose pose = shape.link_from_shape.inverse();
        nearest =
            std::min(nearest, distance_to(std::get<Primitive>(shape.geometry), move(pose, p)));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

// A chain of three links, of which the first and the last have one or two shapes: boxes, few
// triangles of which are certified quickly, or any.
RobotDescription random_chain(Random& random, bool of_boxes = true) {
  RobotDescription robot{.name = "chain", .model = RobotModel("link0")};
  for (int i = 0; i < 3; ++i) {
    LinkDescription link{.name = "link" + std::to_string(i)};
    if (i > 0) {
      robot.model.add_link(link.name, "link" + std::to_string(i - 1),
                           {.type = JointType::kRevolute, .lower = -1, .upper = 1});
    }
    for (std::size_t shapes = i == 1 ? 0 : 1 + random.index(2); shapes > 0; --shapes) {
      const Pose pose = random_pose(random, 0.1);
      const Primitive shape = random_primitive(random, 0.2);
      link.collision.push_back({.name = "",
                                .link_from_shape = pose,
                                .geometry = of_boxes ? Box{{0.1, 0.15, 0.2}} : shape});
    }
    robot.links.push_back(link);
  }
  return robot;
}

RobotCoverOptions quick(double max_error) {
  return {.max_error = max_error, .effort = 0};
}

TEST(RobotSpheres, CoverEveryPointOfRandomRobotsAndNotMuchMore) {
  Random random(11);
  for (int i = 0; i < effort(2, 1); ++i) {
    const RobotDescription robot = random_chain(random, kSanitized);
    RobotCoverOptions options = quick(0.06);
    options.padding = i % 2 == 0 ? 0.005 : 0.0;
    const RobotCover cover = cover_robot(robot, options);
    EXPECT_EQ(cover.robot, "chain");
    EXPECT_TRUE(links_not_proved(cover).empty());
    ASSERT_EQ(cover.links.size(), robot.links.size());
    for (std::size_t l = 0; l < robot.links.size(); ++l) {
      const LinkCover& link = cover.links[l];
      ASSERT_EQ(link.link, robot.links[l].name);
      if (robot.links[l].collision.empty()) {
        EXPECT_TRUE(link.spheres.empty());
        EXPECT_FALSE(link.fit);
        continue;
      }
      ASSERT_TRUE(link.fit);
      EXPECT_TRUE(link.fit->certificate.covered);
      EXPECT_LE(*link.fit->certificate.protrusion_over_simplified_max, 0.06);
      EXPECT_TRUE(link.warnings.empty()) << link.warnings.front();
      for (int k = 0; k < 3000; ++k) {
        WidePoint p = point_of(robot.links[l], random);
        p += Wide(options.padding) * random.direction().cast<Wide>();
        // A sphere is covered by itself, and the point has its rounding.
        ASSERT_LE(outside_of(link.spheres, p), Wide(1e-18)) << link.link;
      }
      // Over the shapes themselves: a gap between shapes may be filled, which the certificate
      // bounds.
      EXPECT_LE(sampled_protrusion(link, robot.links[l], random),
                link.fit->certificate.protrusion_over_mesh->upper + options.padding + 1e-15);
    }
  }
}

LinkShape ball(const Eigen::Vector3d& center, double radius) {
  const Pose pose(Eigen::Quaterniond(1, 2, 3, 4), center);
  return {.name = "", .link_from_shape = pose, .geometry = SolidSphere{radius}};
}

RobotCover cover_of(const std::vector<LinkShape>& shapes, const RobotCoverOptions& options) {
  RobotDescription robot{.name = "post", .model = RobotModel("base")};
  robot.links = {{.name = "base", .visual = {}, .collision = shapes}};
  return cover_robot(robot, options);
}

// However small E is.
TEST(RobotSpheres, SpheresAreTheirOwnCover) {
  const std::vector<LinkShape> shapes = {ball({0.1, -0.2, 0.3}, 0.05),
                                         ball({0.1, -0.2, 0.34}, 0.04),
                                         ball({0.11, -0.2, 0.3}, 0.02), ball({0.5, 0, 0}, 0.05)};
  const LinkCover cover = cover_of(shapes, quick(1e-3)).links[0];
  // The third one lies in the first one.
  EXPECT_EQ(cover.spheres,
            (std::vector<Sphere>{
                {{0.1, -0.2, 0.3}, 0.05}, {{0.5, 0, 0}, 0.05}, {{0.1, -0.2, 0.34}, 0.04}}));
  const Certificate& certificate = cover.fit->certificate;
  EXPECT_TRUE(certificate.covered);
  EXPECT_EQ(certificate.protrusion_over_simplified_max, 0.0);
  EXPECT_EQ(certificate.protrusion_over_mesh.value().upper, 0.0);
  EXPECT_TRUE(cover.warnings.empty());
  const LinkCover padded = cover_of(shapes, {.max_error = 1e-3, .padding = 0.002}).links[0];
  ASSERT_EQ(padded.spheres.size(), 3U);
  EXPECT_NEAR(padded.spheres[0].radius, 0.052, 1e-15);
  EXPECT_LE(*padded.fit->certificate.protrusion_over_simplified_max, 1e-15);
  EXPECT_NEAR(padded.fit->certificate.protrusion_over_mesh->upper, 0.002, 1e-15);
  EXPECT_TRUE(links_not_proved(cover_of(shapes, {.padding = 0.002})).empty());
}

// What such spheres shut in has to be covered, too.
TEST(RobotSpheres, ACavityBetweenSpheresIsCovered) {
  std::vector<LinkShape> shapes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.1, -0.1}) {
      shapes.push_back(ball(side * Eigen::Vector3d::Unit(axis), 0.09));
    }
  }
  const LinkCover cover = cover_of(shapes, quick(0.01)).links[0];
  EXPECT_TRUE(cover.fit->certificate.covered);
  EXPECT_LE(outside_of(cover.spheres, WidePoint::Zero()), 0);
}

// E holds of the shape itself, not of triangles around it.
TEST(RobotSpheres, ProtrudeFromACurvedShapeByNoMoreThanTheError) {
  Random random(7);
  for (const Primitive& shape : {Primitive(Capsule{0.05, 0.2}), Primitive(Cylinder{0.05, 0.2})}) {
    const std::vector<LinkShape> shapes = {
        {.name = "", .link_from_shape = random_pose(random, 0.3), .geometry = shape}};
    const LinkCover cover = cover_of(shapes, quick(0.01)).links[0];
    EXPECT_TRUE(cover.fit->certificate.covered);
    EXPECT_EQ(cover.fit->options.max_error, 0.01);
    const double bound = cover.fit->certificate.protrusion_over_mesh.value().upper;
    EXPECT_LE(*cover.fit->certificate.protrusion_over_simplified_max, 0.01);
    EXPECT_LE(bound, 0.0101);
    const Wide sampled =
        sampled_protrusion(cover, {.name = "base", .visual = {}, .collision = shapes}, random);
    EXPECT_LE(sampled, bound);
    EXPECT_GE(sampled, 0.7 * bound);
  }
}

TEST(RobotSpheres, AreEqualOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  Random random(12);
  const RobotDescription robot = random_chain(random);
  RobotCoverOptions options = quick(0.05);
  options.effort = 1;
  options.threads = 1;
  const RobotCover alone = cover_robot(robot, options);
  for (const int threads : {5, 2}) {
    options.threads = threads;
    const RobotCover cover = cover_robot(robot, options);
    for (std::size_t l = 0; l < robot.links.size(); ++l) {
      EXPECT_EQ(cover.links[l].spheres, alone.links[l].spheres) << threads;
    }
  }
}

TEST(RobotSpheres, OptionsOfALinkAreForThatLink) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  Random random(13);
  const RobotDescription robot = random_chain(random);
  RobotCoverOptions options = quick(0.05);
  const RobotCover plain = cover_robot(robot, options);
  EXPECT_EQ(plain.links[0].fit->options.min_external_diameter, 0.2);
  options.links["link2"] = {.max_error = 0.025, .padding = 0.004};
  const RobotCover own = cover_robot(robot, options);
  EXPECT_EQ(own.links[0].spheres, plain.links[0].spheres);
  EXPECT_GT(own.links[2].spheres.size(), plain.links[2].spheres.size());
  EXPECT_EQ(own.links[2].fit->options.max_error, 0.025);
  EXPECT_EQ(own.links[2].fit->options.min_external_diameter, 0.1);
  EXPECT_LE(*own.links[2].fit->certificate.protrusion_over_simplified_max, 0.025);
  for (int k = 0; k < 2000; ++k) {
    WidePoint p = point_of(robot.links[2], random);
    p += Wide(0.004) * random.direction().cast<Wide>();
    ASSERT_LE(outside_of(own.links[2].spheres, p), 0);
  }
}

// The robot's D counts where the link has none of its own, whatever its E.
TEST(RobotSpheres, ZonesOfALinkAreForThatLink) {
  Random random(13);
  const RobotDescription robot = random_chain(random);
  RobotCoverOptions options = quick(0.05);
  options.min_external_diameter = 0.15;
  options.links["link2"] = {.max_error = 0.025, .padding = 0.004};
  Zone zone{.shape = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)),
            .max_error = 0.04};
  options.links["link0"].min_external_diameter = 0.08;
  options.links["link0"].zones = {zone};
  const RobotCover zoned = cover_robot(robot, options);
  EXPECT_EQ(zoned.links[2].fit->options.min_external_diameter, 0.15);
  EXPECT_EQ(zoned.links[0].fit->options.min_external_diameter, 0.08);
  ASSERT_EQ(zoned.links[0].fit->certificate.protrusion_in_zones.size(), 1U);
  EXPECT_LE(zoned.links[0].fit->certificate.protrusion_in_zones[0], 0.04);
  EXPECT_TRUE(zoned.links[2].fit->certificate.protrusion_in_zones.empty());
}

TEST(RobotSpheres, WarnOfAnOpenMeshAndCoverIt) {
  const TempDir folder;
  const std::filesystem::path file = folder.write(
      "open.obj", "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3 4\nf 1 2 5\n");
  RobotDescription robot;
  robot.name = "open";
  robot.links = {{.name = "base_link",
                  .visual = {},
                  .collision = {{.name = "", .link_from_shape = {}, .geometry = MeshFile{file}}}}};
  const RobotCover cover = cover_robot(robot, quick(0.01));
  EXPECT_TRUE(cover.links[0].fit->certificate.covered);
  ASSERT_EQ(cover.links[0].warnings.size(), 1U);
  EXPECT_NE(cover.links[0].warnings[0].find("open (5 edges"), std::string::npos)
      << cover.links[0].warnings[0];
  Random random(14);
  for (int k = 0; k < 500; ++k) {
    const WidePoint p(0.1 * random.unit(), 0.1 * random.unit(), 0);
    ASSERT_LE(outside_of(cover.links[0].spheres, p), 0);
  }
}

TEST(RobotSpheres, ProgressGrowsAndNamesLinks) {
  Random random(15);
  const RobotDescription robot = random_chain(random);
  RobotCoverOptions options = quick(0.06);
  std::mutex mutex;
  std::vector<double> shares;
  std::vector<std::string> names;
  options.progress = [&](double share, const char* what) {
    const std::lock_guard lock(mutex);
    shares.push_back(share);
    names.push_back(what);
  };
  options.threads = 1;
  cover_robot(robot, options);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);
  for (const char* name : {"link0", "link2"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
  EXPECT_EQ(std::find(names.begin(), names.end(), "link1"), names.end());
}

// A needle of 15 mm, in millimetres that were taken for metres.
TEST(RobotSpheres, DoubtsALargeLinkBeforeItIsCovered) {
  const auto told_of = [](double size, double max_error) {
    RobotDescription robot{.name = "hand", .model = RobotModel("finger")};
    const Primitive needle = Box{.size = {size, 0.001 * size, 0.001 * size}};
    robot.links = {{.name = "finger", .collision = {{.name = "", .geometry = needle}}}};
    RobotCoverOptions options = quick(max_error);
    std::vector<std::string> told;
    options.on_doubt = [&](const std::string& link, const std::string& doubt) {
      told.push_back(link + ": " + doubt);
    };
    std::stop_source stop;
    options.stop = stop.get_token();
    options.progress = [&](double, const char* what) {
      told.emplace_back(what);
      stop.request_stop();
    };
    const std::vector<std::string> warnings = cover_robot(robot, options).links[0].warnings;
    EXPECT_EQ(told.front(), warnings.empty() ? "finger" : "finger: " + warnings[0]);
    return told.front();
  };
  const std::string meant =
      " m across: if its meshes are in millimetres, their scale has to be 0.001 (in a URDF: <mesh "
      "scale=\"0.001 0.001 0.001\" .../>)";
  EXPECT_EQ(told_of(101.0, 4.0), "finger: it is 101" + meant);
  if (kSanitized) return;  // each takes seconds there
  EXPECT_EQ(told_of(15.0, 0.0149),
            "finger: it is 15" + meant + "; so many times the max error takes long");
  EXPECT_EQ(told_of(15.0, 0.0151), "finger");
  EXPECT_EQ(told_of(9.9, 0.0098), "finger");
}

TEST(RobotSpheres, NamesTheLinksWhoseProofFailed) {
  Random random(16);
  const RobotDescription robot = random_chain(random);
  RobotCover cover = cover_robot(robot, quick(0.06));
  EXPECT_TRUE(links_not_proved(cover).empty());
  cover.links[2].fit->certificate.covered = false;
  EXPECT_EQ(links_not_proved(cover), std::vector<std::string>{"link2"});

  const RobotSpheres spheres = robot_spheres(robot, cover);
  EXPECT_EQ(spheres.robot, "chain");
  ASSERT_EQ(spheres.links.size(), 3U);
  EXPECT_EQ(spheres.links[1].link, "link1");
  EXPECT_TRUE(spheres.links[1].spheres.empty());
  EXPECT_EQ(spheres.links[2].spheres, cover.links[2].spheres);
}

// A hand with two fingers and a flange that carries nothing, and a camera fixed to the arm.
TEST(RobotSpheres, NeighboursAreNotCheckedAgainstEachOther) {
  RobotDescription robot;
  robot.model = RobotModel("base");
  const auto add = [&](const char* name, const char* parent, JointType type) {
    robot.model.add_link(name, parent, {.name = name, .type = type, .lower = -1, .upper = 1});
  };
  add("arm", "base", JointType::kRevolute);
  add("camera", "arm", JointType::kFixed);
  add("lens", "camera", JointType::kFixed);
  add("wrist", "arm", JointType::kRevolute);
  add("flange", "wrist", JointType::kFixed);
  add("left", "flange", JointType::kPrismatic);
  add("right", "flange", JointType::kPrismatic);
  RobotCover cover;
  for (const Link& link : robot.model.links()) {
    robot.links.push_back({.name = link.name});
    cover.links.push_back({.link = link.name});
    if (link.name != "flange") cover.links.back().spheres = {Sphere{{0, 0, 0}, 1}};
  }
  std::vector<std::string> pairs;
  for (const DisabledPair& pair : robot_spheres(robot, cover).self_collision_ignore) {
    pairs.push_back(pair.link_a + " " + pair.link_b);
    EXPECT_EQ(pair.reason, pairs.back() == "arm lens" ? kRigidReason : kAdjacentReason);
  }
  // Not "camera wrist": the arm between them has spheres of its own. Nor "left right".
  EXPECT_EQ(pairs, (std::vector<std::string>{"base arm", "arm camera", "arm lens", "arm wrist",
                                             "camera lens", "wrist left", "wrist right"}));
}

TEST(RobotSpheres, RefusesBadOptionsAndNamesThem) {
  Random random(17);
  RobotDescription robot = random_chain(random);
  const auto expect = [&](const RobotCoverOptions& options, const std::string& reason) {
    const std::string text = message_of([&] { cover_robot(robot, options); });
    EXPECT_NE(text.find(reason), std::string::npos) << text;
  };
  const double nan = std::nan("");
  expect({.max_error = 0.0}, "max error: must be positive");
  expect({.max_error = -1.0}, "max error: must be positive");
  expect({.max_error = nan}, "max error: must be positive");
  expect({.min_external_diameter = -1.0}, "min external diameter: must be");
  expect({.padding = nan}, "padding: must be");
  expect({.geometry = LinkGeometry::kVisual},
         "chain: no link has visual geometry; try the other one, collision");
  expect({.links = {{"link9", {}}}}, "link 'link9': the robot has no such link");
  expect({.links = {{"link1", {}}}}, "link 'link1': has options and no geometry to cover");
  expect({.links = {{"link0", {.max_error = 0.0}}}}, "link 'link0' max error: must be positive");
  expect({.links = {{"link0", {.padding = -0.1}}}}, "link 'link0' padding: must be");
  const Zone useless{.shape = Sphere{.center = {0, 0, 0}, .radius = 1.0}};
  expect({.links = {{"link2", {.zones = {useless}}}}}, "link 'link2', zone 0");

  robot.links[2].collision[0].geometry = Box{{300, 300, 300}};
  expect({}, " m across");
  expect({}, "millimetres");
  robot.links[2].collision[0].geometry = HalfSpace{};
  expect({}, "link 'link2': a half-space");
}

}  // namespace
}  // namespace spherule::test::robot_spheres_test
