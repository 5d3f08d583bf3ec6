// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <cmath>
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
      run({"fit", "box.stl", "-o", "box.json", "--max-error", "2", "--effort", kEffort, "--report",
           "report.json", "--tree", "fit.tree", "--view", "fit.html"});
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(fit.err.find('\x1b'), std::string::npos);  // no progress bar: not a terminal
  EXPECT_EQ(files(), (std::vector<std::string>{"box.json", "box.stl", "fit.html", "fit.tree",
                                               "report.json"}));

  const json spheres = read_json("box.json");
  EXPECT_EQ(spheres.at("format"), "spherule-spheres");
  EXPECT_EQ(spheres.at("version"), 1);
  EXPECT_EQ(spheres.at("certificate").at("covered"), true);
  EXPECT_LE(spheres.at("certificate").at("protrusion_over_simplified_max"), 2.0 * (1 + 1e-9));
  EXPECT_EQ(spheres.at("certificate").at("sphere_count"), spheres.at("spheres").size());
  EXPECT_EQ(spheres.at("options").at("max-error"), 2.0);
  EXPECT_EQ(spheres.at("options").at("min-external"), 8.0);

  const Outcome audit = run({"audit", "box.stl", "box.json", "--json"});
  EXPECT_EQ(audit.exit_code, 0) << audit.err;
  const json certificate = json::parse(audit.out);
  EXPECT_EQ(certificate.at("covered"), true);
  EXPECT_EQ(certificate.at("min_external_diameter"), 8.0);
  EXPECT_EQ(certificate.at("against"), "simplified solid");

  ASSERT_EQ(run({"tree", "box.json", "-o", "box.tree"}).exit_code, 0);
  EXPECT_EQ(read("box.tree"), read("fit.tree"));

  EXPECT_NE(run({"info", "box.stl"}).out.find("triangles"), std::string::npos);
  EXPECT_NE(run({"info", "box.json"}).out.find("option max-error: 2"), std::string::npos);
  EXPECT_NE(run({"info", "box.tree"}).out.find("invariants: all hold"), std::string::npos);

  EXPECT_EQ(run({"collide", "box.tree", "box.tree"}).exit_code, 1);
  EXPECT_EQ(run({"collide", "box.tree", "box.tree", "--pose-b", "39 0 0 0 0 0 1"}).exit_code, 1);
  EXPECT_EQ(run({"collide", "box.tree", "box.tree", "--pose-b", "45 0 0 0 0 0 1"}).exit_code, 0);
}

// A corner that one triangle has elsewhere opens the mesh, and takes its volume away.
TEST_F(FitTest, WeldingShutsACrack) {
  std::string text = read("box.stl");
  const std::string corner = "vertex 40 20 10";
  text.replace(text.find(corner), corner.size(), "vertex 40.00001 20 10");
  write("box.stl", text);
  const std::vector<std::string> fit{"fit",         "box.stl", "-o",       "box.json",
                                     "--max-error", "4",       "--effort", "0"};
  const Outcome open = run(fit);
  EXPECT_NE(open.out.find("not closed"), std::string::npos) << open.out;
  EXPECT_NE(open.err.find("--weld 4.58258e-05 shuts"), std::string::npos) << open.err;

  std::vector<std::string> welding = fit;
  welding.insert(welding.end(), {"--weld", "5e-05"});
  const Outcome shut = run(welding);
  EXPECT_EQ(shut.exit_code, 0) << shut.err;
  EXPECT_EQ(shut.err, "");
  EXPECT_NE(shut.out.find("\nclosed"), std::string::npos) << shut.out;
  EXPECT_EQ(read_json("box.json").at("options").at("weld"), 5e-05);
  const Outcome audit = run({"audit", "box.stl", "box.json", "--json"});
  EXPECT_EQ(audit.exit_code, 0) << audit.err;
  EXPECT_TRUE(json::parse(audit.out).at("volume_ratio").is_number()) << audit.out;

  welding.back() = "-1";
  expect_refusal(welding, "--weld");
}

// Where spheres lose to the mesh, the user is told; the result is as good as any.
TEST_F(FitTest, WarnsOfThinPlates) {
  write_box("plate.stl", {40, 30, 0.5});
  const Outcome thin =
      run({"fit", "plate.stl", "-o", "plate.json", "--max-error", "2", "--effort", "1"});
  EXPECT_EQ(thin.exit_code, 0) << thin.err;
  EXPECT_NE(thin.err.find("spherule: warning: plate.stl: "), std::string::npos) << thin.err;
  EXPECT_NE(thin.err.find("--max-error 4"), std::string::npos) << thin.err;
}

TEST_F(FitTest, ReportLeavesOutWhatWasNotAskedFor) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome plain = run({"fit", "box.stl", "-o", "box.json", "--max-error", "4", "--effort",
                             "0", "--report", "report.json"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(plain.out.find("lower bound"), std::string::npos) << plain.out;
  const json report = read_json("report.json");
  EXPECT_TRUE(report.at("cover").at("lower_bound").is_null());
  EXPECT_FALSE(report.at("simplified_solid").contains("external_spheres"));
  EXPECT_EQ(report.at("simplified_solid").at("external_sphere_count"), 0) << "S is the box";

  write_box("bar.stl", {40, 1, 1});  // whose bound is quick
  const Outcome bounded = run({"fit", "bar.stl", "-o", "bar.json", "--max-error", "4", "--effort",
                               "0", "--report", "report.json", "--lower-bound"});
  ASSERT_EQ(bounded.exit_code, 0) << bounded.err;
  EXPECT_NE(bounded.out.find("lower bound: no cover at this error has fewer than "),
            std::string::npos)
      << bounded.out;
  EXPECT_GT(read_json("report.json").at("cover").at("lower_bound"), 0);
}

// Whoever has the report can judge G2: the external spheres are free of the mesh.
TEST_F(FitTest, ReportHoldsTheSimplifiedSolid) {
  ASSERT_EQ(run({"fit", "box.stl", "-o", "box.json", "--max-error", "2", "--padding", "0.25",
                 "--method", "paper", "--report", "report.json", "--external-spheres"})
                .exit_code,
            0);
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
        const Outcome result =
            run({"fit", "box.stl", "-o", name + ".json", "--max-error", "2", "--effort", "4",
                 "--method", method, "--external", external, "--external-limit", "300", "--threads",
                 threads, "--tree", name + ".tree"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
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
    EXPECT_EQ(
        run({"fit", "box.stl", "-o", "box.json", "--max-error", "2", option, value}).exit_code, 0);
    return read_json("box.json");
  };
  const json first = fit("--effort", "0");
  const json later = fit("--effort", "6");
  EXPECT_EQ(first.at("options").at("effort"), 0);
  EXPECT_LT(later.at("spheres").size(), first.at("spheres").size());
  EXPECT_EQ(fit("--seconds", "0.5").at("options").at("seconds"), 0.5);
  EXPECT_EQ(run({"audit", "box.stl", "box.json"}).exit_code, 0);
  expect_refusal({"fit", "box.stl", "-o", "box.json", "--effort", "1", "--seconds", "1"},
                 "--effort excludes --seconds");
  for (const char* option : {"--effort", "--seconds"}) {
    expect_refusal({"fit", "box.stl", "-o", "box.json", option, "-1"}, option);
  }
}

// The levels stand in the tree and in the report, and no verdict depends on them.
TEST_F(FitTest, LevelsAreJoinedInTheTree) {
  ASSERT_EQ(run({"fit", "box.stl", "-o", "box.json", "--levels", "8,2,4", "--effort", kEffort,
                 "--report", "report.json", "--tree", "levels.tree"})
                .exit_code,
            0);
  EXPECT_EQ(read_json("box.json").at("options").at("levels"), "8,4,2");
  EXPECT_EQ(read_json("box.json").at("options").at("max-error"), 2.0);
  const json levels = read_json("report.json").at("levels");
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_LE(levels[0].at("protrusion_over_simplified_max"), 4.0);
  EXPECT_LE(levels[1].at("protrusion_over_simplified_max"), 8.0);
  ASSERT_EQ(run({"audit", "box.stl", "box.json"}).exit_code, 0);
  ASSERT_EQ(run({"tree", "box.json", "-o", "plain.tree"}).exit_code, 0);
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
  expect_refusal({"fit", "box.stl", "-o", "bad.json", "--levels", "8,x"}, "'x' is not a number");
  const Outcome finer =
      run({"fit", "box.stl", "-o", "bad.json", "--levels", "8,1", "--max-error", "2"});
  EXPECT_EQ(finer.exit_code, 2);
  EXPECT_NE(finer.err.find("finer than the max error"), std::string::npos) << finer.err;
}

TEST_F(FitTest, OptionsArriveInTheFile) {
  ASSERT_EQ(run({"fit", "box.stl", "-o", "scaled.json", "--scale", "10", "--min-external", "100",
                 "--max-error", "20", "--min-radius", "15", "--external", "none", "--seed", "7",
                 "--effort", "0"})
                .exit_code,
            0);
  const json file = read_json("scaled.json");
  EXPECT_EQ(file.at("options").at("scale"), 10.0);
  EXPECT_EQ(file.at("options").at("min-external"), 100.0);
  EXPECT_EQ(file.at("options").at("min-radius"), 15.0);
  EXPECT_EQ(file.at("options").at("external"), "none");
  EXPECT_EQ(file.at("options").at("seed"), 7);
  for (const json& sphere : file.at("spheres")) EXPECT_GE(sphere.at("radius"), 15.0);
  // The audit takes the scale from the file.
  EXPECT_EQ(run({"audit", "box.stl", "scaled.json"}).exit_code, 0);
}

TEST_F(FitTest, TheToolMakesD) {
  write_spheres("tool.json", {{0, 0, 0, 3}, {1, 0, 0, 2.5}, {5, 0, 0, 4}});
  const Outcome fit = run({"fit", "box.stl", "-o", "box.json", "--max-error", "2", "--effort",
                           kEffort, "--tool", "tool.json"});
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
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
  expect_refusal({"fit", "box.stl", "-o", "no.json", "--tool", "tool.json", "--min-external", "3"},
                 "--tool");
  expect_refusal({"fit", "box.stl", "-o", "tool.json", "--tool", "tool.json"}, "named twice");
  EXPECT_FALSE(exists("no.json"));
}

TEST_F(FitTest, ZonesAreKeptProvedAndAudited) {
  write("zones.json", R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[40,20,10],"radius":4,"max_error":0.5},
    {"shape":"box","min":[-5,-5,-5],"max":[10,25,15],"min_external":4}]})");
  const std::vector<std::string> arguments = {
      "fit",      "box.stl", "-o",      "box.json",   "--max-error",         "2",
      "--effort", kEffort,   "--zones", "zones.json", "--keep-concave-edges"};
  const Outcome fit = run(arguments);
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_NE(fit.out.find("zones along sharp concave edges: 0"), std::string::npos);
  EXPECT_NE(fit.out.find("in zone 0: at most"), std::string::npos);
  const json file = read_json("box.json");
  const json& zones = file.at("certificate").at("zones");
  ASSERT_EQ(zones.size(), 2U);
  EXPECT_LE(zones.at(0).at("protrusion_over_simplified_max"), 0.5);
  EXPECT_GT(zones.at(0).at("protrusion_over_simplified_max"), 0.0);
  EXPECT_EQ(json::parse(file.at("options").at("zones").get<std::string>()),
            read_json("zones.json"));
  EXPECT_EQ(file.at("options").at("keep-concave-edges"), true);

  const Outcome audit = run({"audit", "box.stl", "box.json", "--json"});
  EXPECT_EQ(audit.exit_code, 0) << audit.err;
  EXPECT_EQ(json::parse(audit.out).at("zones"), zones);
  EXPECT_EQ(run({"info", "box.json"}).exit_code, 0);
}

TEST_F(FitTest, RefusalsOfThePlacementNameTheirCause) {
  const auto refuse = [&](const std::vector<std::string>& more, const std::string& reason) {
    std::vector<std::string> line = {"fit", "box.stl", "-o", "no.json"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome fit = run(line);
    EXPECT_EQ(fit.exit_code, 2);
    EXPECT_NE(fit.err.find("spherule: " + reason), std::string::npos) << fit.err;
    EXPECT_FALSE(exists("no.json"));
  };
  refuse({"--min-external", "1e-9"}, "box.stl: grid step: too fine for a model");
  refuse({"--max-error", "1e9"}, "max error: is more than 16 million times as far");
  refuse({"--keep-concave-edges", "--external", "random"}, "keep concave edges: needs");
}

TEST_F(FitTest, FaultsOfZonesAreNamedWithTheirFile) {
  const auto refuse = [&](const std::string& zones, const std::string& reason) {
    write("zones.json", R"({"format":"spherule-zones","version":1,"zones":[)" + zones + "]}");
    expect_refusal({"fit", "box.stl", "-o", "no.json", "--max-error", "2", "--zones", "zones.json"},
                   "zones.json: " + reason);
  };
  refuse(R"({"shape":"ball"})", "zone 0: \"center\" is missing");
  refuse(R"({"shape":"ball","center":[0,0,0],"radius":1})", "zone 0: has neither");
  // What depends on E and D is known once the mesh is read and described.
  for (const auto& [value, reason] : {std::pair{R"("max_error":2.5)", "the max error is above"},
                                      std::pair{R"("min_external":8.5)", "the min external"}}) {
    write("zones.json", std::string(R"({"format":"spherule-zones","version":1,"zones":[)") +
                            R"({"shape":"ball","center":[0,0,0],"radius":1,)" + value + "}]}");
    const Outcome fit =
        run({"fit", "box.stl", "-o", "no.json", "--max-error", "2", "--zones", "zones.json"});
    EXPECT_EQ(fit.exit_code, 2);
    EXPECT_NE(fit.err.find(std::string("zones.json: zone 0: ") + reason), std::string::npos)
        << fit.err;
    EXPECT_FALSE(exists("no.json"));
  }
  expect_refusal({"fit", "box.stl", "-o", "no.json", "--zones", "absent.json"}, "absent.json");
}

}  // namespace
}  // namespace spherule
