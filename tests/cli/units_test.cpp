// SPDX-License-Identifier: BSD-3-Clause
// Units of meshes and of lengths on the command line.
#include "tests/cli/command_test_support.h"
#include "tests/mesh/mesh_files.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

namespace spherule {
namespace {

using nlohmann::json;

class UnitsTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("part.stl", {40, 20, 20});
    const TriangleMesh metres =
        test::box_mesh(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.04, 0.02, 0.02));
    write("part.glb", test::glb_bytes(metres, Eigen::Vector3d::Zero()));
  }

  Outcome fit(const std::string& mesh, const std::vector<std::string>& more) {
    std::vector<std::string> line = {"fit", mesh, "-o", "out.json", "--effort", "0"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
  json options() const { return read_json("out.json").at("options"); }
};

TEST_F(UnitsTest, LengthsWithAUnitNeedThatOfTheMesh) {
  const std::string known =
      "--max-error: is in millimetres, but part.stl states no unit: say --units mm";
  expect_refusal({"fit", "part.stl", "-o", "out.json", "--max-error", "4mm"}, known);
  Outcome outcome =
      fit("part.stl", {"--units", "mm", "--max-error", "0.4cm", "--min-external", "1.5 cm"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("unit: millimetre (as --units says)\n"), std::string::npos);
  EXPECT_EQ(options().at("max-error"), 4.0);
  EXPECT_EQ(options().at("min-external"), 15.0);
  EXPECT_EQ(options().at("units"), "mm");
  EXPECT_EQ(options().at("scale"), 1.0);
  // A plain number stays in output units, and without --units nothing is stored or said.
  outcome = fit("part.stl", {"--max-error", "4"});
  EXPECT_EQ(outcome.out.find("unit"), std::string::npos);
  EXPECT_FALSE(options().contains("units"));
}

TEST_F(UnitsTest, AFormatThatStatesItsUnitIsConverted) {
  Outcome outcome = fit("part.glb", {"--max-error", "4mm"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("unit: metre (stated by the format)\n"), std::string::npos);
  EXPECT_EQ(options().at("max-error"), 0.004);
  EXPECT_EQ(options().at("units"), "m");
  outcome = fit("part.glb", {"--units", "mm", "--max-error", "4", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("size 40 x 20 x 20"), std::string::npos) << outcome.out;
  EXPECT_EQ(options().at("scale"), 1000.0);
  EXPECT_EQ(read_json("report.json").at("unit").at("name"), "millimetre");
  EXPECT_EQ(read_json("report.json").at("unit").at("metres"), 0.001);
  EXPECT_NE(outcome.out.find("next: spherule view part.glb out.json --units mm -o out.html"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(run({"view", "part.glb", "out.json", "--units", "mm", "-o", "out.html"}).exit_code, 0);
  // The audit reads it alike, and takes lengths with a unit.
  outcome = run({"audit", "part.glb", "out.json", "--min-external", "1.6cm"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("(D 16)"), std::string::npos) << outcome.out;
  expect_refusal({"audit", "part.glb", "out.json", "--units", "m"}, "out.json is in millimetres");
}

TEST_F(UnitsTest, ScaleAndUnitsMustAgree) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  expect_refusal({"fit", "part.glb", "-o", "out.json", "--units", "mm", "--scale", "10"},
                 "--scale: 10 contradicts --units mm: part.glb is read in units of metre, which "
                 "makes it 1000");
  EXPECT_EQ(fit("part.glb", {"--units", "mm", "--scale", "1000", "--max-error", "4"}).exit_code, 0);
  // The numbers of an STL file times the scale are in the unit.
  EXPECT_EQ(fit("part.stl", {"--units", "m", "--scale", "0.001", "--max-error", "4mm"}).exit_code,
            0);
  EXPECT_EQ(options().at("max-error"), 0.004);
  // Without --units the unit of the output follows from the scale.
  EXPECT_EQ(fit("part.glb", {"--scale", "100", "--max-error", "4mm"}).exit_code, 0);
  EXPECT_EQ(options().at("max-error"), 0.4);
}

TEST_F(UnitsTest, EveryOptionThatIsALengthTakesAUnit) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome outcome =
      fit("part.stl", {"--units", "mm", "--max-error", "2mm", "--levels", "0.4cm,2", "--padding",
                       "100um", "--min-radius", "0.1mm", "--min-internal", "1mm", "--weld", "1um"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(options().at("padding"), 0.1);
  EXPECT_EQ(options().at("min-radius"), 0.1);
  EXPECT_EQ(options().at("min-internal"), 1.0);
  EXPECT_EQ(options().at("weld"), 0.001);
  EXPECT_EQ(options().at("levels"), "4,2");
}

TEST_F(UnitsTest, WhatIsNoLengthIsRefused) {
  const auto refuse = [this](const std::string& length, const std::string& reason) {
    expect_refusal({"fit", "part.stl", "-o", "out.json", "--units", "mm", "--max-error", length},
                   "--max-error: " + reason);
  };
  refuse("2parsec", "'2parsec' is not a number or a length with a unit (um, mm, cm, m, inch, ft)");
  refuse("-2mm", "must be finite and not negative");
  refuse("infmm", "must be finite and not negative");
  expect_refusal({"fit", "part.stl", "-o", "out.json", "--units", "furlong"}, "--units: furlong");
}

// A tool in millimetres, and a part in metres.
TEST_F(UnitsTest, TheUnitOfAToolIsHeeded) {
  ASSERT_EQ(fit("part.stl", {"--units", "mm", "--max-error", "4"}).exit_code, 0);
  const json tool = read_json("out.json");
  double least = 1e9;
  for (const json& sphere : tool.at("spheres"))
    least = std::min(least, sphere.at("radius").get<double>());
  write("tool.json", read("out.json"));
  ASSERT_EQ(fit("part.glb", {"--max-error", "4mm", "--tool", "tool.json"}).exit_code, 0);
  EXPECT_NEAR(options().at("min-external").get<double>(), 2e-3 * least, 1e-12);
  expect_refusal({"fit", "part.stl", "-o", "other.json", "--tool", "tool.json"},
                 "--tool tool.json: is in millimetres, but part.stl states no unit");
}

TEST_F(UnitsTest, WarningsKnowTheUnit) {
  const Outcome outcome = fit("part.glb", {"--max-error", "2"});
  EXPECT_NE(outcome.err.find("both are in metres (stated by the format); if the error was meant in "
                             "millimetres, use --max-error 2mm"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace spherule
