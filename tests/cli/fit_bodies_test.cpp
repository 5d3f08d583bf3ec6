// SPDX-License-Identifier: BSD-3-Clause
// Several meshes in one file: `fit A.stl B.stl -o all.json`, and what reads it.
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <sstream>

namespace spherule {
namespace {

using nlohmann::json;

class FitBodiesTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("a.stl", {8, 4, 4});
    write_box("b.stl", {4, 4, 4});
  }

  Outcome fit(const std::vector<std::string>& more = {}) {
    std::vector<std::string> line = {"fit",         "a.stl", "b.stl",    "-o", "all.json",
                                     "--max-error", "1",     "--effort", "0"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
};

TEST_F(FitBodiesTest, EachIsAsIfItWereFittedAlone) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome outcome =
      fit({"--tree", "all.tree", "--view", "all.html", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("2 bodies  24"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("next: spherule audit a.stl b.stl all.json"), std::string::npos);
  const json all = read_json("all.json");
  json spheres = json::array();
  for (const char* name : {"a", "b"}) {
    const std::string mesh = std::string(name) + ".stl";
    EXPECT_EQ(run({"fit", mesh, "-o", "one.json", "--max-error", "1", "--effort", "0"}).exit_code,
              0);
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
  EXPECT_EQ(fit({"--threads", "1"}).exit_code, 0);
  EXPECT_EQ(read("all.json"), bytes);
}

TEST_F(FitBodiesTest, OtherCommandsReadTheFile) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  ASSERT_EQ(fit().exit_code, 0);
  Outcome outcome = run({"audit", "a.stl", "b.stl", "all.json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("2 of 2 bodies are covered (proved)"), std::string::npos);
  EXPECT_EQ(run({"tree", "all.json", "-o", "all.tree"}).exit_code, 0);
  outcome = run({"info", "all.json"});
  EXPECT_NE(outcome.out.find("bodies: 2\n  a: "), std::string::npos) << outcome.out;
  EXPECT_EQ(run({"view", "a.stl", "b.stl", "all.json", "-o", "all.html"}).exit_code, 0);
  // One sphere of the second body is gone from its place.
  json all = read_json("all.json");
  json& last = all.at("spheres").back();
  last.at("radius") = 1e-3;
  write("leaky.json", all.dump());
  outcome = run({"audit", "a.stl", "b.stl", "leaky.json", "--json"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
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
  outcome = run({"audit", "a.stl", "b.stl", "leaky.json"});
  EXPECT_NE(outcome.out.find(place.str()), std::string::npos) << outcome.out << place.str();
}

TEST_F(FitBodiesTest, Refusals) {
  ASSERT_EQ(fit().exit_code, 0);
  expect_refusal({"audit", "a.stl", "all.json"},
                 "is of other bodies: body 2 is b, of the models no more");
  expect_refusal({"audit", "b.stl", "a.stl", "all.json"},
                 "is of other bodies: body 1 is a, of the models b");
  expect_refusal({"audit", "a.stl", "b.stl", "all.json", "--repair", "c.json"},
                 "has several bodies");
  expect_refusal({"audit", "a.stl", "b.stl", "all.json", "--min-external", "1e-9"},
                 "all.json: a: grid step: too fine");
  expect_refusal({"fit", "a.stl", "a.stl", "-o", "x.json"}, "a.stl: is named twice");
  expect_refusal({"fit", "a.stl", "b.stl", "-o", "b.stl"}, "b.stl");
  expect_refusal({"fit", "a.stl", "b.stl", "-o", "x.json", "--levels", "1,2"}, "are of one body");
  ASSERT_EQ(run({"fit", "a.stl", "-o", "one.json", "--max-error", "1", "--effort", "0"}).exit_code,
            0);
  expect_refusal({"audit", "a.stl", "b.stl", "one.json"}, "is of one body, but several models");
}

}  // namespace
}  // namespace spherule
