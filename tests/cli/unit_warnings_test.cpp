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
                       "error was meant in millimetres, use --max-error 0.02, or the "
                       "same with --scale 1000\n"),
      std::string::npos)
      << outcome.err;
  EXPECT_EQ(fit({"--max-error", "0.02"}).err, "");
}

// Two grains, so that the small error takes few spheres.
TEST_F(UnitWarnings, NamesTheUnitOfAnErrorThatIsTooSmall) {
  write("part.off",
        "OFF\n8 8 0\n0 0 0\n.1 0 0\n0 .1 0\n0 0 .1\n300 0 0\n300.1 0 0\n300 .1 0\n300 0 .1\n"
        "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n");
  const auto expect_warning = [this](const std::vector<std::string>& more,
                                     const std::string& ending) {
    std::vector<std::string> line = {"fit", "part.off", "-o", "part.json", "--effort", "0"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find(" is less than a thousandth of the part, whose largest extent is "
                               "300.1, which may take very many spheres and hours" +
                               ending),
              std::string::npos)
        << outcome.err;
  };
  expect_warning({"--max-error", "0.25"}, "\n");
  expect_warning({"--max-error", "0.025"},
                 ": if that is in millimetres and the error was meant in metres, use --max-error "
                 "25, or the same with --scale 0.001\n");
  expect_warning({"--max-error", "0.025", "--units", "mm"},
                 ": both are in millimetres (as --units says); if the error was meant in metres, "
                 "use --max-error 0.025m\n");
}

TEST_F(UnitWarnings, OfARepair) {
  write_box("part.stl", {0.4, 0.2, 0.1});
  ASSERT_EQ(fit({"--max-error", "0.02"}).exit_code, 0);
  const Outcome outcome =
      run({"audit", "part.stl", "part.json", "--repair", "mended.json", "--max-error", "20"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("spherule: warning: part.stl: the max error 20 is more than a tenth"),
            std::string::npos)
      << outcome.err;
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

TEST_F(UnitWarnings, PaddingOfFarMoreVolumeThanTheMesh) {
  write_box("part.stl", {4, 4, 4});
  const Outcome outcome = fit({"--max-error", "1", "--padding", "4"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find(": the max error 1 or the padding 4 is coarse for it"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace spherule
