// SPDX-License-Identifier: BSD-3-Clause
// Lengths in another unit than the mesh's are recognised, and never refused.
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

class UnitWarnings : public CommandTest {
 protected:
  Outcome fit(const std::vector<std::string>& more) {
    std::vector<std::string> line = {"fit", "part.stl", "-o", "part.json", "--effort", "0"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
};

// A box of 0.4 x 0.2 x 0.1 m and an error meant as 20 mm.
TEST_F(UnitWarnings, NamesTheUnitOfAnErrorThatIsTooLarge) {
  write_box("part.stl", {0.4, 0.2, 0.1});
  const Outcome outcome = fit({"--max-error", "20"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(
      outcome.err.find("spherule: warning: part.stl: the max error 20 is more than a tenth of "
                       "the part, whose largest extent is 0.4: if that is in metres and the "
                       "error was meant in millimetres, use --max-error 0.02, or for "
                       "--scale 1000\n"),
      std::string::npos)
      << outcome.err;
  EXPECT_EQ(fit({"--max-error", "0.02"}).err, "");
}

TEST_F(UnitWarnings, ADiameterFarBelowTheError) {
  write_box("part.stl", {2, 1, 1});
  const Outcome outcome = fit({"--max-error", "2", "--min-external", "0.19"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(
      outcome.err.find("the min external diameter 0.19 is less than a tenth of the max error 2"),
      std::string::npos)
      << outcome.err;
}

TEST_F(UnitWarnings, SpheresOfFarMoreVolumeThanTheMesh) {
  write_box("part.stl", {40, 20, 0.5});
  const Outcome outcome = fit({"--max-error", "4"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find(" times the volume of the mesh: the max error 4 is coarse for it"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace spherule
