// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace spherule::internal {
namespace {

struct Thing {
  std::string name;
};

TEST(NearestName, IsOneThatDiffersInFewLetters) {
  const std::vector<std::string> links{"base", "hand", "q1"};
  EXPECT_EQ(did_you_mean("hnad", links), "; did you mean hand?") << "swapped";
  EXPECT_EQ(did_you_mean("bose", links), "; did you mean base?");
  EXPECT_EQ(did_you_mean("q2", links), "; did you mean q1?");
  EXPECT_EQ(did_you_mean("hand_of_the_robot", links), "");
  EXPECT_EQ(did_you_mean("torch", links), "");
  EXPECT_EQ(did_you_mean("base", {}), "");
}

TEST(NearestName, IsOneThatTheWordBegins) {
  const std::vector<Thing> things{{"elbow_joint_of_arm"}, {"wrist"}};
  EXPECT_EQ(did_you_mean("elbow", things, &Thing::name), "; did you mean elbow_joint_of_arm?");
}

}  // namespace
}  // namespace spherule::internal
