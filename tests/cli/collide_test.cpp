// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

using nlohmann::json;

// Two spheres of radius 1 at x = 0 and x = 10, and one sphere of radius 1 at the origin.
class CollideTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_spheres("two.json", {{0, 0, 0, 1}, {10, 0, 0, 1}});
    write_spheres("one.json", {{0, 0, 0, 1}});
    ASSERT_EQ(run({"tree", "two.json", "-o", "two.tree"}).exit_code, 0);
    ASSERT_EQ(run({"tree", "one.json", "-o", "one.tree"}).exit_code, 0);
  }
};

TEST_F(CollideTest, ExitCodeIsTheVerdict) {
  const auto verdict = [&](const char* pose_b) {
    return run({"collide", "two.tree", "one.tree", "--pose-b", pose_b}).exit_code;
  };
  EXPECT_EQ(run({"collide", "two.tree", "one.tree"}).exit_code, 1);
  EXPECT_EQ(verdict("5 0 0 0 0 0 1"), 0);
  EXPECT_EQ(verdict("2 0 0 0 0 0 1"), 1);  // touching
  EXPECT_EQ(verdict("-2.001 0 0 0 0 0 1"), 0);
  EXPECT_EQ(verdict("-1.999,0,0, 0,0,0,1"), 1);
}

TEST_F(CollideTest, PosesRotate) {
  // A quarter turn about z moves the second sphere from x = 10 to y = 10.
  const std::string turn = "0 0 0 0 0 1 1";  // not of unit length: allowed
  EXPECT_EQ(
      run({"collide", "two.tree", "one.tree", "--pose-a", turn, "--pose-b", "0 11.9 0 0 0 0 1"})
          .exit_code,
      1);
  EXPECT_EQ(run({"collide", "two.tree", "one.tree", "--pose-a", turn, "--pose-b", "10 0 0 0 0 0 1"})
                .exit_code,
            0);
}

TEST_F(CollideTest, JsonAloneOnStandardOutput) {
  const Outcome hit =
      run({"collide", "two.tree", "one.tree", "--pose-b", "11 0 0 0 0 0 1", "--json"});
  EXPECT_EQ(hit.exit_code, 1);
  const json collision = json::parse(hit.out);
  EXPECT_EQ(collision.at("verdict"), "collision");
  EXPECT_EQ(collision.at("pairs"), json::parse("[[1,0]]"));

  const Outcome miss =
      run({"collide", "two.tree", "one.tree", "--pose-b", "5 0 0 0 0 0 1", "--json", "--distance"});
  EXPECT_EQ(miss.exit_code, 0);
  const json free = json::parse(miss.out);
  EXPECT_EQ(free.at("verdict"), "free");
  EXPECT_TRUE(free.at("pairs").empty());
  EXPECT_LE(free.at("distance").at("lower"), 3.0);
  EXPECT_GE(free.at("distance").at("upper"), 3.0);
  EXPECT_NEAR(free.at("distance").at("lower"), 3.0, 1e-9);
}

TEST_F(CollideTest, BadInput) {
  const auto refuse = [&](const std::string& pose, const std::string& reason) {
    expect_refusal({"collide", "two.tree", "one.tree", "--pose-b", pose}, reason);
  };
  refuse("", "--pose-b: ");
  refuse("1 2 3", "seven numbers");
  refuse("1 2 3 0 0 0 1 1", "seven numbers");
  refuse("1 2 3 0 0 zero 1", "'zero' is not a number");
  refuse("1 2 3 0 0 0 0", "--pose-b: ");
  refuse("1 2 nan 0 0 0 1", "--pose-b: ");
  refuse("inf 0 0 0 0 0 1", "--pose-b: ");
  expect_refusal({"collide", "two.json", "one.tree"}, "two.json: ");
  expect_refusal({"collide", "two.tree", "missing.tree"}, "missing.tree: ");
  std::string damaged = read("one.tree");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  write("damaged.tree", damaged);
  expect_refusal({"collide", "two.tree", "damaged.tree"}, "damaged.tree: ");
  expect_refusal({"info", "damaged.tree"}, "damaged.tree: ");
}

}  // namespace
}  // namespace spherule
