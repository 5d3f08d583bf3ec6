// SPDX-License-Identifier: BSD-3-Clause
#include "base/crc64.h"
#include "base/error.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/proof_scope.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/refusals.h"
#include "tests/robot/robots.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace spherule::test::link_pairs_file_test {
namespace {

BoxRobot bars(double lower, double upper, double height = 0.05, double origin = 0.0) {
  Joint joint = turning(lower, upper, "turn");
  joint.parent_from_joint = Pose::from_translation({0.0, 0.0, origin});
  return post_and_bar(joint, height);
}

class LinkPairsFile : public testing::Test {
 protected:
  void SetUp() override { save_link_pairs(pairs_, path_); }

  std::string reason(const BoxRobot& robot) const {
    return reason_of([&] { load_link_pairs(path_, robot.model, robot.bodies); });
  }

  TempDir folder_;
  std::filesystem::path path_ = folder_.path() / "robot.pairs";
  BoxRobot robot_ = bars(-2.0, 2.0);
  LinkPairs pairs_ = prove_link_pairs(robot_.model, robot_.bodies, {.boxes = 200});
};

TEST_F(LinkPairsFile, ReadsWhatWasWritten) {
  const LinkPairs read = load_link_pairs(path_, robot_.model, robot_.bodies);
  ASSERT_EQ(read.pairs().size(), 1U);
  const LinkPair& a = pairs_.pairs()[0];
  const LinkPair& b = read.pairs()[0];
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.witness, b.witness);
  EXPECT_EQ(a.boxes.nodes(), b.boxes.nodes());
  EXPECT_EQ(a.boxes.variables(), b.boxes.variables());
  EXPECT_EQ(a.searched_boxes, b.searched_boxes);
  for (double q = -2.1; q < 2.1; q += 0.001) {
    ASSERT_EQ(a.boxes.contains(std::vector{q}), b.boxes.contains(std::vector{q}));
  }
}

TEST_F(LinkPairsFile, HoldsForThisRobotAlone) {
  EXPECT_EQ(reason(bars(-2.0, 2.0)), "nothing is wrong");
  EXPECT_EQ(reason(bars(-1.0, 0.5)), "nothing is wrong");
  EXPECT_EQ(reason(bars(-2.0, 2.1)),
            "the limits of joint 'turn' are wider than those it was made with");
  const char* const other = "was made for other meshes or attached bodies of this robot";
  EXPECT_EQ(reason(bars(-2.0, 2.0, 0.06)), other);
  EXPECT_EQ(reason(bars(-2.0, 2.0, 0.05, 0.01)),
            "was made for another robot: its links and joints are not these");
  BoxRobot with_tool = bars(-2.0, 2.0);
  with_tool.bodies.push_back(with_tool.bodies[1]);
  EXPECT_EQ(reason(with_tool), other);
}

TEST_F(LinkPairsFile, DamageIsFound) {
  const std::string bytes = internal::encode_link_pairs(pairs_);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_THROW(internal::decode_link_pairs(damaged, "file"), Error) << i;
    EXPECT_THROW(internal::decode_link_pairs(bytes.substr(0, i), "file"), Error) << i;
  }
  EXPECT_THROW(internal::decode_link_pairs(bytes + "x", "file"), Error);
}

// Bytes that are wrong although their checksum is right end in an Error, or in what is consistent.
TEST_F(LinkPairsFile, NoContentEndsBadly) {
  const std::string bytes = internal::encode_link_pairs(pairs_);
  const std::string content = bytes.substr(0, bytes.size() - 8);
  for (std::size_t i = 0; i < content.size(); ++i) {
    for (const int value : {0, 1, 2, 3, 127, 255}) {
      std::string damaged = content;
      damaged[i] = static_cast<char>(value);
      std::uint64_t sum = crc64(damaged);
      for (int k = 0; k < 8; ++k) damaged.push_back(static_cast<char>(sum >> (8 * k) & 0xFFU));
      try {
        internal::decode_link_pairs(damaged, "file");
      } catch (const Error&) {
        continue;
      }
    }
  }
}

TEST_F(LinkPairsFile, VerdictsThatContradictTheirProofsAreRefused) {
  const auto made_of = [&](PairVerdict verdict, char state, const std::vector<double>& witness) {
    return LinkPairs({{.first = 0,
                       .second = 1,
                       .verdict = verdict,
                       .witness = witness,
                       .boxes = FreeBoxes({{0, false, -2.0, 2.0}}, std::string(1, state))}},
                     2, pairs_.mechanism(), pairs_.bodies());
  };
  EXPECT_NO_THROW(made_of(PairVerdict::kNever, '\1', {}));
  EXPECT_NO_THROW(made_of(PairVerdict::kTouching, '\0', {0.0}));
  EXPECT_THROW(made_of(PairVerdict::kNever, '\0', {}), Error);
  EXPECT_THROW(made_of(PairVerdict::kNever, '\1', {0.0}), Error);
  EXPECT_THROW(made_of(PairVerdict::kTouching, '\1', {0.0}), Error);
  EXPECT_THROW(made_of(PairVerdict::kTouching, '\0', {}), Error);
  EXPECT_THROW(made_of(PairVerdict::kUnknown, '\0', {0.0}), Error);
}

TEST(FreeBoxes, RefusesWhatIsNoTree) {
  const std::vector<FreeBoxes::Variable> one{{0, false, 0.0, 1.0}};
  EXPECT_THROW(FreeBoxes(one, ""), Error);
  EXPECT_THROW(FreeBoxes(one, std::string("\2\1", 2)), Error);
  EXPECT_THROW(FreeBoxes(one, std::string("\1\1", 2)), Error);
  EXPECT_THROW(FreeBoxes(one, std::string("\3\1\0", 3)), Error);
  EXPECT_THROW(FreeBoxes({{0, false, 1.0, 0.0}}, std::string("\1", 1)), Error);
  EXPECT_THROW(FreeBoxes({{0, false, 0.0, 101.0}}, std::string("\1", 1)), Error);
  EXPECT_THROW(FreeBoxes({{0, true, 0.0, 1.0}}, std::string("\1", 1)), Error);
  EXPECT_THROW(FreeBoxes({one.front(), one.front()}, std::string("\1", 1)), Error);
  std::string deep;
  for (int i = 0; i < 5000; ++i)
    deep += i % 2 == 0 ? std::string("\2\1", 2) : std::string("\2\0", 2);
  EXPECT_THROW(FreeBoxes(one, deep + std::string(1, '\0')), Error);
  EXPECT_TRUE(FreeBoxes(one, std::string("\2\1\1", 3)).is_all_free());
  EXPECT_DOUBLE_EQ(FreeBoxes(one, std::string("\2\1\0", 3)).free_share(), 0.5);
}

}  // namespace
}  // namespace spherule::test::link_pairs_file_test
