// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_files.h"
#include "tests/support/zoo.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace spherule {
namespace {

using nlohmann::json;

// As short a search as the test bears.
constexpr const char* kEffort = test::kSanitized ? "0" : "1";

class FitTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {40, 20, 10});
  }
};

TEST_F(FitTest, ChainFromMeshToCollision) {
  const Outcome fit =
      expect_exit(0, {"fit", "box.stl", "-o", "box.json", "--max-error", "2", "--effort", kEffort,
                      "--report", "report.json", "--tree", "fit.tree", "--view", "fit.html"});
  EXPECT_EQ(fit.err.find('\x1b'), std::string::npos);  // no progress bar: not a terminal
  EXPECT_EQ(files(), (Words{"box.json", "box.stl", "fit.html", "fit.tree", "report.json"}));

  const json spheres = read_json("box.json");
  EXPECT_EQ(spheres.at("format"), "spherule-spheres");
  EXPECT_EQ(spheres.at("version"), 1);
  EXPECT_EQ(spheres.at("certificate").at("covered"), true);
  EXPECT_LE(spheres.at("certificate").at("protrusion_over_simplified_max"), 2.0 * (1 + 1e-9));
  EXPECT_EQ(spheres.at("certificate").at("sphere_count"), spheres.at("spheres").size());
  EXPECT_EQ(spheres.at("options").at("max-error"), 2.0);
  EXPECT_EQ(spheres.at("options").at("min-external"), 8.0);

  const json certificate = expect_json(0, "audit box.stl box.json");
  EXPECT_EQ(certificate.at("covered"), true);
  EXPECT_EQ(certificate.at("min_external_diameter"), 8.0);
  EXPECT_EQ(certificate.at("against"), "simplified solid");

  expect_exit(0, "tree box.json -o box.tree");
  EXPECT_EQ(read("box.tree"), read("fit.tree"));

  EXPECT_TRUE(has(run("info box.stl").out, "triangles"));
  EXPECT_TRUE(has(run("info box.json").out, "option max-error: 2"));
  EXPECT_TRUE(has(run("info box.tree").out, "invariants: all hold"));

  expect_exit(1, "collide box.tree box.tree");
  expect_exit(1, {"collide", "box.tree", "box.tree", "--pose-b", "39 0 0 0 0 0 1"});
  expect_exit(0, {"collide", "box.tree", "box.tree", "--pose-b", "45 0 0 0 0 0 1"});
}

// A corner that one triangle has elsewhere opens the mesh, and takes its volume away.
TEST_F(FitTest, WeldingShutsACrack) {
  std::string text = read("box.stl");
  const std::string corner = "vertex 40 20 10";
  text.replace(text.find(corner), corner.size(), "vertex 40.00001 20 10");
  write("box.stl", text);
  const Words fit{"fit", "box.stl", "-o", "box.json", "--max-error", "4", "--effort", "0"};
  const Outcome open = run(fit);
  EXPECT_TRUE(has(open.out, "not closed"));
  EXPECT_TRUE(has(open.err, "--weld 4.58258e-05 shuts"));

  const Outcome shut = expect_exit(0, joined(fit, "--weld 5e-05"));
  EXPECT_EQ(shut.err, "");
  EXPECT_TRUE(has(shut.out, "\nclosed"));
  EXPECT_EQ(read_json("box.json").at("options").at("weld"), 5e-05);
  const Outcome audit = expect_exit(0, "audit box.stl box.json --json");
  EXPECT_TRUE(json::parse(audit.out).at("volume_ratio").is_number()) << audit.out;

  expect_refusal(joined(fit, "--weld -1"), "--weld");
}

// Lengths that look like those of another unit, and spheres that lose to the mesh: a warning of one
// line, and a result as good as any.
TEST_F(FitTest, Warnings) {
  write_box("metres.stl", {0.4, 0.2, 0.1});
  write_box("block.stl", {2, 1, 1});
  write_box("cube.stl", {4, 4, 4});
  write_box("plate.stl", {40, 20, 0.5});
  // Two grains, so that the small error takes few spheres.
  write("grains.off",
        "OFF\n8 8 0\n0 0 0\n.1 0 0\n0 .1 0\n0 0 .1\n300 0 0\n300.1 0 0\n300 .1 0\n300 0 .1\n"
        "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"metres.stl --max-error 0.02", ""},
      {"metres.stl --max-error 20", "use --max-error 0.02, or the same with --scale 1000"},
      {"grains.off --max-error 0.25", "is less than a thousandth of the part"},
      {"grains.off --max-error 0.025", "use --max-error 25, or the same with --scale 0.001"},
      {"grains.off --max-error 0.025 --units mm", "use --max-error 0.025m"},
      {"block.stl --max-error 2 --min-external 0.19", "0.19 is less than a tenth of the max error"},
      {"plate.stl --max-error 4", "times the volume of the mesh: the max error 4 is coarse"},
      {"cube.stl --max-error 1 --padding 4", "the max error 1 or the padding 4 is coarse"}};
  for (const auto& [line, warning] : cases) {
    const Outcome outcome = expect_exit(0, "fit " + line + " -o out.json --effort 0");
    EXPECT_EQ(outcome.err.starts_with("spherule: warning: "), !warning.empty()) << line;
    EXPECT_TRUE(has(outcome.err, warning));
  }
}

TEST_F(FitTest, ReportLeavesOutWhatWasNotAskedFor) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome plain =
      expect_exit(0, "fit box.stl -o box.json --max-error 4 --effort 0 --report report.json");
  EXPECT_FALSE(has(plain.out, "lower bound"));
  const json report = read_json("report.json");
  EXPECT_TRUE(report.at("cover").at("lower_bound").is_null());
  EXPECT_FALSE(report.at("simplified_solid").contains("external_spheres"));
  EXPECT_EQ(report.at("simplified_solid").at("external_sphere_count"), 0) << "S is the box";

  write_box("bar.stl", {40, 1, 1});  // whose bound is quick
  expect_said(0,
              "fit bar.stl -o bar.json --max-error 4 --effort 0 --report report.json --lower-bound",
              "lower bound: no cover at this error has fewer than ");
  EXPECT_GT(read_json("report.json").at("cover").at("lower_bound"), 0);
}

// Whoever has the report can judge G2: the external spheres are free of the mesh.
TEST_F(FitTest, ReportHoldsTheSimplifiedSolid) {
  expect_exit(0,
              "fit box.stl -o box.json --max-error 2 --padding 0.25 --method paper --report "
              "report.json --external-spheres");
  const json report = read_json("report.json");
  EXPECT_EQ(report.at("mesh").at("triangles"), 12);
  EXPECT_EQ(report.at("mesh").at("closed"), true);
  EXPECT_NEAR(report.at("mesh").at("volume"), 8000.0, 1e-6);
  for (const char* part : {"external", "cover", "certify"}) {
    EXPECT_GE(report.at("seconds").at(part), 0.0);
  }
  EXPECT_FALSE(report.at("cover").at("history").empty());
  const json& roles = report.at("analysis").at("spheres_by_role");
  EXPECT_GT(roles.at("edges"), 0);
  EXPECT_EQ(roles.at("edges").get<std::size_t>() + roles.at("thin").get<std::size_t>() +
                roles.at("faces").get<std::size_t>() + roles.at("inside").get<std::size_t>(),
            report.at("certificate").at("sphere_count"));
  EXPECT_FALSE(report.at("cover").at("spheres_before_inflation").empty());
  const json& solid = report.at("simplified_solid");
  EXPECT_EQ(solid.at("min_external_diameter"), 8.0);
  EXPECT_GE(solid.at("padding"), 0.25);
  EXPECT_LE(solid.at("box").at("min").at(0), -0.25);
  const std::array<double, 3> size = {40, 20, 10};
  EXPECT_EQ(solid.at("external_sphere_count"), solid.at("external_spheres").size());
  ASSERT_FALSE(solid.at("external_spheres").empty());
  for (const json& sphere : solid.at("external_spheres")) {
    double squares = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = sphere.at("center").at(axis);
      const double outside = std::max({-x, x - size[axis], 0.0});
      squares += outside * outside;
    }
    const double radius = sphere.at("radius");
    EXPECT_GE(radius, 4.0);
    EXPECT_GE(std::sqrt(squares), radius + 0.25 - 1e-9);
  }
}

// What is not filled is proved of the flood alone.
TEST_F(FitTest, TellsWhatStaysOpenWhereThatIsProved) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  for (const std::string external : {"reachable", "random", "none"}) {
    const Outcome result = run({"fit", "box.stl", "-o", "box.json", "--max-error", "2", "--effort",
                                "0", "--external", external, "--external-limit", "300"});
    const bool is_told = result.out.find("stay open (proved)") != std::string::npos;
    EXPECT_EQ(is_told, external == "reachable") << result.out << result.err;
  }
}

// G7: equal bytes on any number of threads, and in a second run.
TEST_F(FitTest, ThreadsDoNotChangeTheOutput) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  for (const char* method : {"cover", "paper"}) {
    for (const char* external : {"reachable", "random"}) {
      const auto fit = [&](const char* threads, const std::string& name) {
        expect_exit(0, {"fit", "box.stl", "-o", name + ".json", "--max-error", "2", "--effort", "4",
                        "--method", method, "--external", external, "--external-limit", "300",
                        "--threads", threads, "--tree", name + ".tree"});
      };
      fit("1", "one");
      fit("2", "two");
      fit("2", "again");
      EXPECT_EQ(read("one.json"), read("two.json")) << method << " " << external;
      EXPECT_EQ(read("one.tree"), read("two.tree")) << method << " " << external;
      EXPECT_EQ(read("two.json"), read("again.json")) << method << " " << external;
    }
  }
}

TEST_F(FitTest, EffortOrSecondsSayHowLongToLook) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const auto fit = [&](const std::string& option, const std::string& value) {
    expect_exit(0, {"fit", "box.stl", "-o", "box.json", "--max-error", "2", option, value});
    return read_json("box.json");
  };
  const json first = fit("--effort", "0");
  const json later = fit("--effort", "6");
  EXPECT_EQ(first.at("options").at("effort"), 0);
  EXPECT_LT(later.at("spheres").size(), first.at("spheres").size());
  EXPECT_EQ(fit("--seconds", "0.5").at("options").at("seconds"), 0.5);
  expect_exit(0, "audit box.stl box.json");
  expect_refusal("fit box.stl -o box.json --effort 1 --seconds 1", "--effort excludes --seconds");
  for (const char* option : {"--effort", "--seconds"}) {
    expect_refusal({"fit", "box.stl", "-o", "box.json", option, "-1"}, option);
  }
}

// The levels stand in the tree and in the report, and no verdict depends on them.
TEST_F(FitTest, LevelsAreJoinedInTheTree) {
  expect_exit(0, {"fit", "box.stl", "-o", "box.json", "--levels", "8,2,4", "--effort", kEffort,
                  "--report", "report.json", "--tree", "levels.tree"});
  EXPECT_EQ(read_json("box.json").at("options").at("levels"), "8,4,2");
  EXPECT_EQ(read_json("box.json").at("options").at("max-error"), 2.0);
  const json levels = read_json("report.json").at("levels");
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_LE(levels[0].at("protrusion_over_simplified_max"), 4.0);
  EXPECT_LE(levels[1].at("protrusion_over_simplified_max"), 8.0);
  expect_exit(0, "audit box.stl box.json");
  expect_exit(0, "tree box.json -o plain.tree");
  EXPECT_NE(read("plain.tree"), read("levels.tree"));
  int hits = 0;
  for (int i = 0; i < 12; i += test::effort(1, 4)) {
    const std::string pose = std::to_string(20 + 6 * i) + " " + std::to_string(i) + " 3 0 0 " +
                             std::to_string(0.1 * i) + " 1";
    const Outcome plain = run({"collide", "plain.tree", "plain.tree", "--pose-b", pose, "--json"});
    const Outcome joined =
        run({"collide", "levels.tree", "levels.tree", "--pose-b", pose, "--json"});
    EXPECT_EQ(plain.exit_code, joined.exit_code) << pose;
    EXPECT_EQ(json::parse(plain.out).at("verdict"), json::parse(joined.out).at("verdict"));
    hits += joined.exit_code;
  }
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 12);
  expect_refusal("fit box.stl -o bad.json --levels 8,x", "'x' is not a number");
  expect_said(2, "fit box.stl -o bad.json --levels 8,1 --max-error 2", "finer than the max error");
}

TEST_F(FitTest, OptionsArriveInTheFile) {
  expect_exit(0,
              "fit box.stl -o scaled.json --scale 10 --min-external 100 --max-error 20 "
              "--min-radius 15 --external none --seed 7 --effort 0");
  const json file = read_json("scaled.json");
  EXPECT_EQ(file.at("options").at("scale"), 10.0);
  EXPECT_EQ(file.at("options").at("min-external"), 100.0);
  EXPECT_EQ(file.at("options").at("min-radius"), 15.0);
  EXPECT_EQ(file.at("options").at("external"), "none");
  EXPECT_EQ(file.at("options").at("seed"), 7);
  for (const json& sphere : file.at("spheres")) EXPECT_GE(sphere.at("radius"), 15.0);
  // The audit takes the scale from the file.
  expect_exit(0, "audit box.stl scaled.json");
}

TEST_F(FitTest, TheToolMakesD) {
  write_spheres("tool.json", {{0, 0, 0, 3}, {1, 0, 0, 2.5}, {5, 0, 0, 4}});
  const Outcome fit = expect_exit(0, {"fit", "box.stl", "-o", "box.json", "--max-error", "2",
                                      "--effort", kEffort, "--tool", "tool.json"});
  EXPECT_EQ(read_json("box.json").at("options").at("min-external"), 5.0);

  const auto refuse = [&](const std::string& tool, const std::string& reason) {
    expect_refusal({"fit", "box.stl", "-o", "no.json", "--tool", tool}, reason);
  };
  write_spheres("none.json", {});
  refuse("none.json", "none.json: tool: holds no sphere");
  write_spheres("point.json", {{0, 0, 0, 1}, {0, 0, 0, 0}});
  refuse("point.json", "point.json: tool: has a sphere of radius 0");
  refuse("absent.json", "absent.json");
  refuse("box.stl", "box.stl");
  expect_refusal("fit box.stl -o no.json --tool tool.json --min-external 3", "--tool");
  expect_refusal("fit box.stl -o tool.json --tool tool.json", "named twice");
  EXPECT_FALSE(exists("no.json"));
}

TEST_F(FitTest, ZonesAreKeptProvedAndAudited) {
  write("zones.json", R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[40,20,10],"radius":4,"max_error":0.5},
    {"shape":"box","min":[-5,-5,-5],"max":[10,25,15],"min_external":4}]})");
  const Words arguments = {
      "fit",      "box.stl", "-o",      "box.json",   "--max-error",         "2",
      "--effort", kEffort,   "--zones", "zones.json", "--keep-concave-edges"};
  const Outcome fit = expect_exit(0, arguments);
  EXPECT_TRUE(has(fit.out, "zones along sharp concave edges: 0"));
  EXPECT_TRUE(has(fit.out, "in zone 0: at most"));
  const json file = read_json("box.json");
  const json& zones = file.at("certificate").at("zones");
  ASSERT_EQ(zones.size(), 2U);
  EXPECT_LE(zones.at(0).at("protrusion_over_simplified_max"), 0.5);
  EXPECT_GT(zones.at(0).at("protrusion_over_simplified_max"), 0.0);
  EXPECT_EQ(json::parse(file.at("options").at("zones").get<std::string>()),
            read_json("zones.json"));
  EXPECT_EQ(file.at("options").at("keep-concave-edges"), true);

  const Outcome audit = expect_exit(0, "audit box.stl box.json --json");
  EXPECT_EQ(json::parse(audit.out).at("zones"), zones);
  expect_exit(0, "info box.json");
}

TEST_F(FitTest, RefusalsOfThePlacementNameTheirCause) {
  const auto refuse = [&](const Words& more, const std::string& reason) {
    Words line = joined("fit box.stl -o no.json", more);
    expect_said(2, line, "spherule: " + reason);
    EXPECT_FALSE(exists("no.json"));
  };
  refuse("--min-external 1e-9", "box.stl: grid step: too fine for a model");
  refuse("--max-error 1e9", "max error: is more than 16 million times as far");
  refuse("--keep-concave-edges --external random", "keep concave edges: needs");
}

TEST_F(FitTest, FaultsOfZonesAreNamedWithTheirFile) {
  const auto refuse = [&](const std::string& zones, const std::string& reason) {
    write("zones.json", R"({"format":"spherule-zones","version":1,"zones":[)" + zones + "]}");
    expect_refusal("fit box.stl -o no.json --max-error 2 --zones zones.json",
                   "zones.json: " + reason);
  };
  refuse(R"({"shape":"ball"})", "zone 0: \"center\" is missing");
  refuse(R"({"shape":"ball","center":[0,0,0],"radius":1})", "zone 0: has neither");
  // What depends on E and D is known once the mesh is read and described.
  for (const auto& [value, reason] : {std::pair{R"("max_error":2.5)", "the max error is above"},
                                      std::pair{R"("min_external":8.5)", "the min external"}}) {
    write("zones.json", std::string(R"({"format":"spherule-zones","version":1,"zones":[)") +
                            R"({"shape":"ball","center":[0,0,0],"radius":1,)" + value + "}]}");
    const Outcome fit = expect_exit(2, "fit box.stl -o no.json --max-error 2 --zones zones.json");
    EXPECT_TRUE(has(fit.err, std::string("zones.json: zone 0: ") + reason));
    EXPECT_FALSE(exists("no.json"));
  }
  expect_refusal("fit box.stl -o no.json --zones absent.json", "absent.json");
}

// Several meshes in one file: `fit A.stl B.stl -o all.json`, and what reads it.

class FitBodiesTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("a.stl", {8, 4, 4});
    write_box("b.stl", {4, 4, 4});
  }

  Outcome fit(const Words& more = {}) {
    return run(joined("fit a.stl b.stl -o all.json --max-error 1 --effort 0", more));
  }
};

TEST_F(FitBodiesTest, EachIsAsIfItWereFittedAlone) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome outcome = fit("--tree all.tree --view all.html --report report.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "2 bodies  24"));
  EXPECT_TRUE(has(outcome.out, "next: spherule audit a.stl b.stl all.json"));
  const json all = read_json("all.json");
  json spheres = json::array();
  for (const char* name : {"a", "b"}) {
    const std::string mesh = std::string(name) + ".stl";
    expect_exit(0, {"fit", mesh, "-o", "one.json", "--max-error", "1", "--effort", "0"});
    const json one = read_json("one.json");
    spheres.insert(spheres.end(), one.at("spheres").begin(), one.at("spheres").end());
    const json& body = all.at("bodies").at(mesh == "a.stl" ? 0 : 1);
    EXPECT_EQ(body.at("name"), name);
    EXPECT_EQ(body.at("certificate"), one.at("certificate"));
    EXPECT_EQ(body.at("options"), one.at("options"));
  }
  EXPECT_EQ(all.at("spheres"), spheres);
  EXPECT_TRUE(all.at("certificate").at("covered").get<bool>());
  EXPECT_EQ(read_json("report.json").at("bodies").size(), 2U);
  EXPECT_TRUE(exists("all.tree"));
  EXPECT_TRUE(exists("all.html"));
  const std::string bytes = read("all.json");
  EXPECT_EQ(fit("--threads 1").exit_code, 0);
  EXPECT_EQ(read("all.json"), bytes);
}

TEST_F(FitBodiesTest, OtherCommandsReadTheFile) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  ASSERT_EQ(fit().exit_code, 0);
  Outcome outcome = expect_exit(0, "audit a.stl b.stl all.json");
  EXPECT_TRUE(has(outcome.out, "2 of 2 bodies are covered (proved)"));
  expect_exit(0, "tree all.json -o all.tree");
  outcome = run("info all.json");
  EXPECT_TRUE(has(outcome.out, "bodies: 2\n  a: "));
  expect_exit(0, "view a.stl b.stl all.json -o all.html");
  // One sphere of the second body is gone from its place.
  json all = read_json("all.json");
  json& last = all.at("spheres").back();
  last.at("radius") = 1e-3;
  write("leaky.json", all.dump());
  outcome = expect_exit(1, "audit a.stl b.stl leaky.json --json");
  const json verdict = json::parse(outcome.out);
  EXPECT_FALSE(verdict.at("covered").get<bool>());
  EXPECT_TRUE(verdict.at("bodies").at(0).at("covered").get<bool>());
  EXPECT_FALSE(verdict.at("bodies").at(1).at("covered").get<bool>());
  EXPECT_FALSE(verdict.at("bodies").at(0).contains("deepest_leak"));
  const json& at = verdict.at("bodies").at(1).at("deepest_leak");
  std::ostringstream place;
  place << "deepest leaks at (x, y, z), in the frame and unit of the file:\n  b  ("
        << at.at(0).get<double>() << ", " << at.at(1).get<double>() << ", "
        << at.at(2).get<double>() << ")\n1 of 2 bodies";
  outcome = run("audit a.stl b.stl leaky.json");
  EXPECT_TRUE(has(outcome.out, place.str())) << place.str();
}

TEST_F(FitBodiesTest, Refusals) {
  ASSERT_EQ(fit().exit_code, 0);
  expect_refusals(
      {{"audit a.stl all.json", "is of other bodies: body 2 is b, of the models no more"},
       {"audit b.stl a.stl all.json", "is of other bodies: body 1 is a, of the models b"},
       {"audit a.stl b.stl all.json --repair c.json", "has several bodies"},
       {"audit a.stl b.stl all.json --min-external 1e-9", "all.json: a: grid step: too fine"},
       {"fit a.stl a.stl -o x.json", "a.stl: is named twice"},
       {"fit a.stl b.stl -o b.stl", "b.stl"},
       {"fit a.stl b.stl -o x.json --levels 1,2", "are of one body"}});
  expect_exit(0, "fit a.stl -o one.json --max-error 1 --effort 0");
  expect_refusal("audit a.stl b.stl one.json", "is of one body, but several models");
}

// Units of meshes and of lengths on the command line.

class UnitsTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("part.stl", {40, 20, 20});
    const TriangleMesh metres =
        test::box_mesh(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.04, 0.02, 0.02));
    write("part.glb", test::glb_bytes(metres, Eigen::Vector3d::Zero()));
  }

  Outcome fit(const std::string& mesh, const Words& more) {
    return run(joined({"fit", mesh, "-o", "out.json", "--effort", "0"}, more));
  }
  json options() const { return read_json("out.json").at("options"); }
};

TEST_F(UnitsTest, LengthsWithAUnitNeedThatOfTheMesh) {
  const std::string known =
      "--max-error: is in millimetres, but part.stl states no unit: say --units mm";
  expect_refusal("fit part.stl -o out.json --max-error 4mm", known);
  Outcome outcome =
      fit("part.stl", {"--units", "mm", "--max-error", "0.4cm", "--min-external", "1.5 cm"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "unit: millimetre (as --units says)\n"));
  EXPECT_EQ(options().at("max-error"), 4.0);
  EXPECT_EQ(options().at("min-external"), 15.0);
  EXPECT_EQ(options().at("units"), "mm");
  EXPECT_EQ(options().at("scale"), 1.0);
  // A plain number stays in output units, and without --units nothing is stored or said.
  outcome = fit("part.stl", "--max-error 4");
  EXPECT_FALSE(has(outcome.out, "unit"));
  EXPECT_FALSE(options().contains("units"));
}

TEST_F(UnitsTest, AFormatThatStatesItsUnitIsConverted) {
  Outcome outcome = fit("part.glb", "--max-error 4mm");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "unit: metre (stated by the format)\n"));
  EXPECT_EQ(options().at("max-error"), 0.004);
  EXPECT_EQ(options().at("units"), "m");
  outcome = fit("part.glb", "--units mm --max-error 4 --report report.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "size 40 x 20 x 20"));
  EXPECT_EQ(options().at("scale"), 1000.0);
  EXPECT_EQ(read_json("report.json").at("unit").at("name"), "millimetre");
  EXPECT_EQ(read_json("report.json").at("unit").at("metres"), 0.001);
  EXPECT_TRUE(has(outcome.out, "next: spherule view part.glb out.json --units mm -o out.html"));
  expect_exit(0, "view part.glb out.json --units mm -o out.html");
  // The audit reads it alike, and takes lengths with a unit.
  outcome = expect_exit(0, "audit part.glb out.json --min-external 1.6cm");
  EXPECT_TRUE(has(outcome.out, "(D 16)"));
  expect_refusal("audit part.glb out.json --units m", "out.json is in millimetres");
}

TEST_F(UnitsTest, ScaleAndUnitsMustAgree) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  expect_refusal("fit part.glb -o out.json --units mm --scale 10",
                 "--scale: 10 contradicts --units mm: part.glb is read in units of metre, which "
                 "makes it 1000");
  EXPECT_EQ(fit("part.glb", "--units mm --scale 1000 --max-error 4").exit_code, 0);
  // The numbers of an STL file times the scale are in the unit.
  EXPECT_EQ(fit("part.stl", "--units m --scale 0.001 --max-error 4mm").exit_code, 0);
  EXPECT_EQ(options().at("max-error"), 0.004);
  // Without --units the unit of the output follows from the scale.
  EXPECT_EQ(fit("part.glb", "--scale 100 --max-error 4mm").exit_code, 0);
  EXPECT_EQ(options().at("max-error"), 0.4);
}

TEST_F(UnitsTest, EveryOptionThatIsALengthTakesAUnit) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome outcome = fit("part.stl",
                              "--units mm --max-error 2mm --levels 0.4cm,2 --padding 100um "
                              "--min-radius 0.1mm --min-internal 1mm --weld 1um");
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
  expect_refusal("fit part.stl -o out.json --units furlong", "--units: furlong");
}

// A tool in millimetres, and a part in metres.
TEST_F(UnitsTest, TheUnitOfAToolIsHeeded) {
  ASSERT_EQ(fit("part.stl", "--units mm --max-error 4").exit_code, 0);
  const json tool = read_json("out.json");
  double least = 1e9;
  for (const json& sphere : tool.at("spheres"))
    least = std::min(least, sphere.at("radius").get<double>());
  write("tool.json", read("out.json"));
  ASSERT_EQ(fit("part.glb", "--max-error 4mm --tool tool.json").exit_code, 0);
  EXPECT_NEAR(options().at("min-external").get<double>(), 2e-3 * least, 1e-12);
  expect_refusal("fit part.stl -o other.json --tool tool.json",
                 "--tool tool.json: is in millimetres, but part.stl states no unit");
}

class FitEachTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    for (const char* name : {"a.stl", "b.stl", "c.stl"}) write_box(name, {4, 4, 4});
    write_box("d.stl", {8, 4, 4});
    write("bad.stl", "no mesh");
  }
  Outcome fit(const Words& more) {
    return run(joined("fit a.stl bad.stl b.stl d.stl --each --max-error 1 --effort 0", more));
  }
};

TEST_F(FitEachTest, EveryMeshHasTheFileThatItHasAlone) {
  const Outcome outcome = fit("-o covers");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.err, "bad.stl"));
  EXPECT_FALSE(exists("covers/bad.json"));
  expect_exit(0, "fit d.stl -o one.json --max-error 1 --effort 0");
  EXPECT_EQ(read("covers/d.json"), read("one.json"));
  EXPECT_TRUE(exists("covers/a.json") && exists("covers/b.json"));
}

TEST_F(FitEachTest, ShardsDivideThemAndWhatIsThereIsLeft) {
  EXPECT_EQ(fit("-o covers --shard 1/2").exit_code, 0);
  EXPECT_TRUE(exists("covers/a.json") && exists("covers/b.json"));
  EXPECT_FALSE(exists("covers/d.json"));
  EXPECT_EQ(fit("-o covers --shard 2/2").exit_code, 2);
  EXPECT_TRUE(exists("covers/d.json"));
  const std::string whole = read("covers/a.json");
  write("covers/d.json", "half");
  const Outcome again = fit("-o covers --skip-existing");
  EXPECT_EQ(read("covers/a.json"), whole);
  EXPECT_TRUE(has(again.out, "covers/a.json: is there"));
  EXPECT_FALSE(has(again.out, "covers/d.json: is there"));
  EXPECT_EQ(read_json("covers/d.json")["certificate"]["covered"], true);
  // What an interruption left is made again.
  write("covers/a.json", whole.substr(0, whole.rfind('}')) + ",\n\"interrupted\":true}\n");
  fit("-o covers --skip-existing");
  EXPECT_EQ(read("covers/a.json"), whole);
}

TEST_F(FitEachTest, WhatIsOfOneFileIsRefused) {
  for (const char* option : {"--report", "--tree", "--view"}) {
    const Outcome outcome = fit({option, "file"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(has(outcome.err, "of one file"));
  }
  expect_exit(2, "fit a.stl --shard 1/2");
  expect_exit(2, "fit a.stl x/a.stl --each");
}

}  // namespace
}  // namespace spherule
