// SPDX-License-Identifier: BSD-3-Clause
// What the page of `check --view` carries.
#include "tests/cli/check_fixture.h"
#include "tests/cli/view_scene.h"

#include <cmath>
#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

// The sphere and the wall of the fixture touch where the hand is so near.
constexpr double kReach = 0.0505;

class ViewCheckTest : public CheckTest {
 protected:
  json page_of(int exit_code, std::vector<std::string> more) {
    more.insert(more.end(), {"--view", "page.html"});
    const Outcome outcome = run(command(more));
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_NE(outcome.out.find("page: page.html ("), std::string::npos) << outcome.out;
    return scene_of(read("page.html"));
  }
};

TEST_F(ViewCheckTest, MotionsWithVerdictsContactsAndClearance) {
  write("path.csv", "-1 0\n\n-0.5 0.5\n0.5 0\n1 0\n");
  const json scene = page_of(1, {"--edges"});
  const json& trajectory = scene.at("trajectory");
  EXPECT_EQ(trajectory.at("motions"), true);
  EXPECT_EQ(trajectory.at("shortest"), false);
  EXPECT_EQ(trajectory.at("verdict"), "collision");
  EXPECT_EQ(trajectory.at("configurations"), 4);
  EXPECT_EQ(trajectory.at("shown"), 4);
  EXPECT_EQ(trajectory.at("verdicts"), "fcf");
  EXPECT_EQ(floats_of(trajectory.at("positions")),
            (std::vector<float>{-1, 0, -0.5F, 0.5F, 0.5F, 0, 1, 0}));
  const std::vector<float> clearance = floats_of(trajectory.at("clearance"));
  ASSERT_EQ(clearance.size(), 4u);
  for (const std::size_t i : {0u, 1u, 2u, 3u}) {
    const double exact = (i % 3 == 0 ? 1.0 : 0.5) - kReach;
    EXPECT_LE(static_cast<double>(clearance[i]), exact);
    EXPECT_NEAR(clearance[i], exact, 1e-6);
  }
  ASSERT_EQ(trajectory.at("points").size(), 1u);
  const json& point = trajectory.at("points")[0];
  const double fraction = point.at(3);
  EXPECT_NEAR(fraction, 0.5 - kReach, 2e-4);
  EXPECT_NEAR(point.at(0).get<double>(), 1.0 + fraction, 1e-6);
  EXPECT_EQ(point.at(1), 3);
  EXPECT_EQ(point.at(2), 4);
  EXPECT_NEAR(floats_of(point.at(4)).at(0), -0.5 + fraction, 1e-6);
  const std::vector<float> contact = floats_of(point.at(5));
  ASSERT_EQ(contact.size(), 12u);
  const json& bodies = trajectory.at("bodies");
  EXPECT_EQ(bodies.at(static_cast<std::size_t>(contact[0])), "hand");
  EXPECT_EQ(bodies.at(static_cast<std::size_t>(contact[1])), "wall");
  EXPECT_NEAR(contact[2], 0.0, 2e-4);
  EXPECT_NEAR(contact[3], 0.0, 1e-3);
  // The hand is link 1 and has one sphere; the wall is a solid.
  EXPECT_EQ(std::vector<float>(contact.begin() + 6, contact.end()),
            (std::vector<float>{1, 0, 0, -1, 0, -1}));
}

TEST_F(ViewCheckTest, ConfigurationsAndHowDeepTheyAre) {
  write("path.csv", "-1 0\n0.03 0\n1 0\n");
  const json scene = page_of(1, {});
  const json& trajectory = scene.at("trajectory");
  EXPECT_EQ(trajectory.at("motions"), false);
  EXPECT_EQ(trajectory.at("verdicts"), "fcf");
  EXPECT_EQ(floats_of(trajectory.at("clearance")).at(1), 0.0F);
  ASSERT_EQ(trajectory.at("points").size(), 1u);
  const json& point = trajectory.at("points")[0];
  EXPECT_EQ(point.at(0), 1);
  EXPECT_EQ(point.at(1), 2);
  EXPECT_TRUE(point.at(4).is_null());
  EXPECT_NEAR(floats_of(point.at(5)).at(2), kReach - 0.03, 1e-6);
}

TEST_F(ViewCheckTest, VerdictsObeyTheLimitsWhereTheseAreEnforced) {
  write("path.csv", "-1 0\n-2.5 0\n-1.5 0\n-1 0\n1 0\n");
  EXPECT_EQ(page_of(0, {}).at("trajectory").at("verdicts"), "fffff");
  EXPECT_EQ(page_of(1, {"--enforce-limits"}).at("trajectory").at("verdicts"), "flfff");
  EXPECT_EQ(page_of(1, {"--edges"}).at("trajectory").at("verdicts"), "fffc");
  EXPECT_EQ(page_of(1, {"--edges", "--enforce-limits"}).at("trajectory").at("verdicts"), "llfc");
}

TEST_F(ViewCheckTest, ItsItemsAreTheRobotItsSpheresAndTheScene) {
  write("scan.xyz", "1 1 1\n1 1 2\n");
  write("cell.json", R"({"format": "spherule-scene", "version": 1,
    "robot": {"pose": {"position": [0, 0, 3]}},
    "obstacles": [
      {"name": "wall", "box": {"size": [0.5, 1, 1]}, "pose": {"position": [9, 0, 0]}},
      {"name": "ground", "half_space": {}},
      {"name": "scan", "points": {"file": "scan.xyz", "radius": 0.01}}]})");
  write("path.csv", "0 0\n");
  const json scene = page_of(0, {});
  EXPECT_EQ(scene.at("robot").at("pose"), json({0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  const json& items = scene.at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("checked"), true);
  EXPECT_EQ(floats_of(items[0].at("parts")[0].at("levels").back()),
            (std::vector<float>{0, 0, 0, 0.05F}));
  const json& solids = items[1].at("parts");
  ASSERT_EQ(solids.size(), 2u);
  EXPECT_EQ(solids[0].at("name"), "wall");
  EXPECT_EQ(floats_of(solids[0].at("positions")).size(), 24u);
  for (std::size_t i = 0; i < 24; i += 3) {
    EXPECT_NEAR(std::abs(floats_of(solids[0].at("positions"))[i] - 9.0F), 0.25F, 1e-6F);
  }
  // The square of the ground lies on its surface and reaches around the rest.
  EXPECT_EQ(solids[1].at("name"), "ground");
  EXPECT_EQ(solids[1].at("background"), true);
  const std::vector<float> ground = floats_of(solids[1].at("positions"));
  ASSERT_EQ(ground.size(), 12u);
  for (std::size_t i = 2; i < 12; i += 3) EXPECT_EQ(ground[i], 0.0F);
  EXPECT_LT(ground[0], 1.0F);
  EXPECT_GT(ground[3], 9.25F);
  EXPECT_EQ(items[2].at("parts")[0].at("name"), "scan");
  EXPECT_EQ(floats_of(items[2].at("parts")[0].at("levels")[0]).size(), 8u);
}

// Every third configuration is shown; of what lies between, the worst verdict and its contact.
TEST_F(ViewCheckTest, LongTrajectoriesAreThinnedOut) {
  std::string path;
  for (int i = 0; i <= 20000; ++i) path += i == 7 ? "0.03 0\n" : "1 0\n";
  write("path.csv", path);
  for (const bool edges : {false, true}) {
    const json trajectory =
        page_of(1, edges ? std::vector<std::string>{"--edges"} : std::vector<std::string>())
            .at("trajectory");
    EXPECT_EQ(trajectory.at("configurations"), 20001);
    EXPECT_EQ(trajectory.at("shown"), 6668);
    const std::string verdicts = trajectory.at("verdicts");
    EXPECT_EQ(verdicts.size(), edges ? 6667u : 6668u);
    EXPECT_EQ(verdicts.find('c'), 2u);
    EXPECT_EQ(verdicts.find_last_not_of('f'), 2u);
    ASSERT_EQ(trajectory.at("points").size(), 1u);
    const json& point = trajectory.at("points")[0];
    EXPECT_EQ(point.at(1), edges ? 7 : 8);
    const double at = point.at(0);
    EXPECT_NEAR(at, edges ? 2.0 + (0.95 / 0.97) / 3.0 : 2.0 + 1.0 / 3.0, edges ? 0.02 : 1e-6);
  }
  EXPECT_LT(read("page.html").size(), 2u << 20);
}

TEST_F(ViewCheckTest, TheShorterWayIsShown) {
  write("path.csv", "1 3\n1 -3\n");
  const json trajectory = page_of(0, {"--edges", "--continuous", "shortest"}).at("trajectory");
  EXPECT_EQ(trajectory.at("shortest"), true);
  EXPECT_EQ(trajectory.at("verdicts"), "f");
}

TEST_F(ViewCheckTest, GoesWithJsonAndNotOverItsInput) {
  const Outcome outcome = run(command({"--json", "--view", "page.html"}));
  EXPECT_EQ(json::parse(outcome.out).at("verdict"), "free");
  EXPECT_TRUE(exists("page.html"));
  expect_refusal(command({"--view", "path.csv"}), "path.csv");
}

}  // namespace
}  // namespace spherule
