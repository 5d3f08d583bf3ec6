// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

#include <cmath>

namespace spherule {
namespace {

using nlohmann::json;

class AuditTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {2, 2, 2});
    // What is inside is found by a flood whose cells are a share of the diagonal: quick in a bar.
    write_box("bar.stl", {2, 0.01, 0.01});
  }
};

TEST_F(AuditTest, ForeignSpheresThatCover) {
  write_spheres("ball.json", {{1, 0.005, 0.005, 1.03}});  // the corners are at 1.000025
  const json certificate = expect_json(0, "audit bar.stl ball.json");
  EXPECT_EQ(certificate.at("covered"), true);
  EXPECT_EQ(certificate.at("against"), "mesh and its inside");
  EXPECT_TRUE(certificate.at("deepest_leak").is_null());
  const std::string text = run("audit bar.stl ball.json").out;
  EXPECT_TRUE(has(text, "(proved)"));
}

TEST_F(AuditTest, ForeignSpheresThatLeak) {
  write_spheres("ball.json", {{1, 0.005, 0.005, 0.9}});
  const json certificate = expect_json(1, "audit bar.stl ball.json");
  EXPECT_EQ(certificate.at("covered"), false);
  const double depth = std::sqrt(1.00005) - 0.9;
  EXPECT_LE(certificate.at("uncovered_depth").at(0), depth * (1 + 1e-9));
  EXPECT_GE(certificate.at("uncovered_depth").at(1), depth * (1 - 1e-9));
  EXPECT_NEAR(certificate.at("uncovered_depth").at(0), depth, 0.001);
  // The witness is near one of the corners.
  std::size_t axis = 0;
  for (const double half : {1.0, 0.005, 0.005}) {
    const double x = certificate.at("deepest_leak").at(axis++);
    EXPECT_NEAR(std::abs(x - half), half, 0.003);
  }
  expect_said(1, "audit bar.stl ball.json", "deepest at (");
}

TEST_F(AuditTest, NoSpheresCoverNothing) {
  write_spheres("none.json", {});
  expect_exit(1, "audit bar.stl none.json");
}

TEST_F(AuditTest, MinExternalChoosesTheSolid) {
  write_spheres("ball.json", {{1, 1, 1, 1.75}});
  const Outcome result = run("audit box.stl ball.json --min-external 4 --json");
  const json certificate = json::parse(result.out);
  EXPECT_EQ(certificate.at("against"), "simplified solid");
  EXPECT_EQ(certificate.at("min_external_diameter"), 4.0);
  EXPECT_EQ(certificate.at("external_sphere_count"), 0) << "S is the box";
  EXPECT_TRUE(certificate.at("protrusion_over_simplified_max").is_number());
}

TEST_F(AuditTest, ScaleOverrides) {
  write_spheres("ball.json", {{0.1, 0.0005, 0.0005, 0.103}});
  expect_exit(1, "audit bar.stl ball.json");
  expect_exit(0, "audit bar.stl ball.json --scale 0.1");
}

TEST_F(AuditTest, TheAnswerDoesNotDependOnThreads) {
  write_spheres("ball.json", {{1, 1, 1, 1.5}});
  const auto audit = [&](const std::string& threads) {
    const std::string out = run({"audit", "box.stl", "ball.json", "--json", "--repair",
                                 "mended.json", "--max-error", "0.4", "--threads", threads})
                                .out;
    return out + read("mended.json");
  };
  EXPECT_EQ(audit("1"), audit("2"));
}

TEST_F(AuditTest, BadInput) {
  write_spheres("ball.json", {{1, 1, 1, 1.75}});
  write("broken.json", "{\"format\":\"spherule-spheres\"");
  write("other.json", "{\"format\":\"something-else\",\"version\":1,\"spheres\":[]}");
  expect_refusals({{"audit missing.stl ball.json", "missing.stl: "},
                   {"audit box.stl missing.json", "missing.json: "},
                   {"audit box.stl broken.json", "broken.json: "},
                   {"audit box.stl other.json --json", "other.json: "},
                   {"audit box.stl ball.json --min-external -1", "--min-external: "},
                   {"audit box.stl ball.json --min-external nan", "--min-external: "},
                   {"audit box.stl ball.json --scale 0", "scale"},
                   {"audit box.stl ball.json --threads -1", "--threads"}});
}

TEST_F(AuditTest, RefusalsNameTheFileThatIsTooLargeOrTooFine) {
  write_spheres("far.json", {{1, 1, 1, 1e12}});
  expect_refusal("audit box.stl far.json", "far.json: sphere 0: reaches more than");
  expect_refusal("audit box.stl far.json --min-external 1e-9",
                 "box.stl: grid step: too fine for a model");
}

// What is wrong with a file is said with its name, however late it shows.
TEST_F(AuditTest, BadOptionsInTheFileAreRefusedWithItsName) {
  const auto refuse = [&](const std::string& options, const std::string& reason) {
    write("bad.json",
          R"({"format":"spherule-spheres","version":1,"spheres":[],"options":{)" + options + "}}");
    expect_refusal("audit box.stl bad.json", "bad.json: " + reason);
  };
  refuse(R"("min-external":0)", "min external diameter: ");
  refuse(R"("min-external":-1)", "min-external: ");
  refuse(R"("min-external":1e-9)", "grid step: ");
  refuse(R"("min-external":1,"padding":-1)", "padding: ");
  refuse(R"("padding":1e300)", "padding: ");
  refuse(R"("max-error":-1)", "max-error: ");
  refuse(R"("min-external":1,"external":"random","external-limit":1000000000)", "external limit: ");
  refuse(R"("scale":-1)", "scale: ");
  refuse(R"("scale":0)", "scale: ");
  refuse(R"("scale":"wide")", "scale: ");
  refuse(R"("scale":true)", "scale: must be a finite number");
  refuse(R"("scale":"inf")", "scale: must be a finite number");
  refuse(R"("weld":-1)", "weld: ");
  refuse(R"("weld":"wide")", "weld: must be a finite number");
  refuse(R"("chord-error":false)", "chord-error: must be a finite number");
  refuse(R"("chord-error":-0.5)", "chord-error: ");
}

// Other programs write whole numbers without a point.
TEST_F(AuditTest, OptionsOfReadingMayBeWholeNumbers) {
  const auto exit_code_with = [&](const std::string& options) {
    write("whole.json", R"({"format":"spherule-spheres","version":1,)"
                        R"("spheres":[{"center":[1,0.005,0.005],"radius":1.03}],"options":{)" +
                            options + "}}");
    const Outcome result = run("audit bar.stl whole.json");
    EXPECT_EQ(result.err, "");
    return result.exit_code;
  };
  EXPECT_EQ(exit_code_with(R"("scale":1,"weld":0,"chord-error":1)"), 0);
  EXPECT_EQ(exit_code_with(R"("scale":2)"), 1);
}

TEST_F(AuditTest, RepairMakesALeakingSetCover) {
  write_spheres("ball.json", {{1, 1, 1, 1.5}, {0.5, 0.5, 0.5, 0.1}});
  const Outcome result =
      expect_exit(0, "audit box.stl ball.json --json --repair mended.json --max-error 0.4");
  const json out = json::parse(result.out);
  EXPECT_EQ(out.at("covered"), false);  // as it was
  const json& repair = out.at("repair");
  EXPECT_EQ(repair.at("certificate").at("covered"), true);
  EXPECT_EQ(repair.at("max_error"), 0.4);
  const json mended = read_json("mended.json");
  EXPECT_EQ(mended.at("spheres").size(), 2 + repair.at("added").get<std::size_t>());
  EXPECT_GT(repair.at("grown").get<std::size_t>() + repair.at("added").get<std::size_t>(), 0U);
  EXPECT_EQ(mended.at("options").at("min-external"), 1.6);
  expect_exit(0, "audit box.stl mended.json");
  // A set that covers stays as it is.
  expect_exit(0, "audit box.stl mended.json --repair again.json");
  EXPECT_EQ(read_json("again.json").at("spheres"), mended.at("spheres"));
  expect_refusal("audit box.stl ball.json --max-error 1", "--repair");
  expect_refusal("audit box.stl ball.json --repair ball.json", "ball.json");
}

}  // namespace
}  // namespace spherule
