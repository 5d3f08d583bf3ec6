// SPDX-License-Identifier: BSD-3-Clause
// Links of the same shapes are covered and audited once, with the answers of each alone.
#include "robot/cover/audit_robot.h"
#include "robot/cover/link_parts.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/urdf.h"
#include "tests/support/temp_dir.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cstddef>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace spherule::test::equal_links_test {
namespace {

// A palm, and links on it with these shapes; beside it a.stl and b.stl, which nothing reads.
RobotDescription hand(const std::vector<std::string>& shapes) {
  const TempDir folder;
  for (const char* name : {"a.stl", "b.stl"}) folder.write(name, "");
  std::string text = R"(<robot name="hand"><link name="palm"/>)";
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string name = "finger" + std::to_string(i);
    text += "<link name='" + name + "'>" + shapes[i] + "</link><joint name='of " + name +
            "' type='fixed'><parent link='palm'/><child link='" + name + "'/></joint>";
  }
  return read_urdf(folder.write("hand.urdf", text + "</robot>"));
}

std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

const std::string kBar = collision("<box size='0.2 0.01 0.01'/>");
const std::string kShortBar = collision("<box size='0.1 0.01 0.01'/>");

TEST(EqualLinks, EachNumberOfAShapeCounts) {
  const std::vector<std::string> different = {
      kBar,
      kShortBar,
      kBar + kBar,
      collision("<box size='0.2 0.01 0.01'/>", "<origin xyz='0 0 0.1'/>"),
      collision("<box size='0.2 0.01 0.01'/>", "<origin rpy='0 0 0.1'/>"),
      collision("<sphere radius='0.2'/>"),
      collision("<cylinder radius='0.2' length='0.01'/>"),
      collision("<cylinder radius='0.2' length='0.02'/>"),
      collision("<mesh filename='a.stl'/>"),
      collision("<mesh filename='b.stl'/>"),
      collision("<mesh filename='a.stl' scale='1 1 2'/>"),
  };
  std::vector<std::string> twice = different;
  twice.insert(twice.end(), different.rbegin(), different.rend());
  const RobotDescription robot = hand(twice);
  const std::vector<std::size_t> first =
      internal::first_equal_links(robot, LinkGeometry::kCollision);
  ASSERT_EQ(first.size(), 1 + twice.size());
  EXPECT_EQ(first[0], 0U);
  for (std::size_t i = 0; i < different.size(); ++i) {
    EXPECT_EQ(first[1 + i], 1 + i);
    EXPECT_EQ(first[twice.size() - i], 1 + i) << different[i];
  }
  // None has any visual geometry.
  const std::vector<std::size_t> bare = internal::first_equal_links(robot, LinkGeometry::kVisual);
  for (std::size_t i = 0; i < bare.size(); ++i) EXPECT_EQ(bare[i], i);
}

TEST(EqualLinks, AreCoveredOnceAndAsAlone) {
  RobotCoverOptions options{.max_error = 0.01, .effort = 0};
  options.links["finger4"].max_error = 0.02;
  options.links["finger6"].min_external_diameter = 0.05;
  options.links["finger7"].padding = 0.001;
  options.links["finger8"].zones = {
      {.shape = Eigen::AlignedBox3d(Eigen::Vector3d(0, -1, -1), Eigen::Vector3d(1, 1, 1)),
       .max_error = 0.008}};
  std::mutex mutex;
  std::set<std::string> covered;
  options.progress = [&](double, const char* link) {
    const std::lock_guard lock(mutex);
    covered.insert(link);
  };
  const RobotCover cover =
      cover_robot(hand({kBar, kShortBar, kBar, kShortBar, kBar, kBar, kBar, kBar, kBar}), options);
  EXPECT_EQ(covered, (std::set<std::string>{"finger0", "finger1", "finger4", "finger6", "finger7",
                                            "finger8"}));
  const auto alone = [](const std::string& shape, double max_error) {
    return cover_robot(hand({shape}), {.max_error = max_error, .effort = 0}).links[1].spheres;
  };
  EXPECT_TRUE(cover.links[0].spheres.empty());
  for (const std::size_t link : {1UL, 3UL, 6UL}) {
    EXPECT_EQ(cover.links[link].spheres, alone(kBar, 0.01)) << link;
    EXPECT_EQ(cover.links[link].link, "finger" + std::to_string(link - 1));
    EXPECT_EQ(cover.links[link].fit->certificate.covered, true);
    EXPECT_EQ(cover.links[link].seconds == 0.0, link != 1) << link;
  }
  for (const std::size_t link : {2UL, 4UL}) {
    EXPECT_EQ(cover.links[link].spheres, alone(kShortBar, 0.01)) << link;
  }
  EXPECT_EQ(cover.links[5].spheres, alone(kBar, 0.02));
  EXPECT_NE(cover.links[5].spheres, cover.links[1].spheres);
}

TEST(EqualLinks, AreAuditedAndRepairedEachWithItsOwnSpheres) {
  const RobotDescription robot = hand({kBar, kBar, kBar, kShortBar});
  const std::vector<Sphere> ball = {{{0, 0, 0}, 0.11}};
  const std::vector<Sphere> small_ball = {{{0, 0, 0}, 0.06}};
  const std::vector<LinkSpheres> spheres = {
      {"finger0", ball}, {"finger1", small_ball}, {"finger2", ball}, {"finger3", small_ball}};
  const RobotAudit audit = audit_robot(robot, spheres);
  ASSERT_EQ(audit.links.size(), 5U);
  EXPECT_FALSE(audit.links_covered);
  const std::vector<bool> is_covered = {true, false, true, true};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(audit.links[1 + i].link, "finger" + std::to_string(i));
    EXPECT_EQ(audit.links[1 + i].certificate->covered, is_covered[i]) << i;
  }
  const RobotRepair repair = repair_robot(robot, spheres, {.max_error = 0.06});
  ASSERT_EQ(repair.links.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(repair.links[i].link, "finger" + std::to_string(i));
    EXPECT_TRUE(repair.links[i].certificate.covered) << i;
    EXPECT_EQ(repair.links[i].repair.spheres, repair.spheres[i].spheres);
    EXPECT_EQ(repair.spheres[i].spheres == spheres[i].spheres, is_covered[i]) << i;
  }
}

}  // namespace
}  // namespace spherule::test::equal_links_test
