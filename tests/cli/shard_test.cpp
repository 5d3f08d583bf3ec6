// SPDX-License-Identifier: BSD-3-Clause
// --shard: the reports of all parts, put together, are that of the whole.

#include "tests/cli/check_fixture.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

class ShardTest : public CheckTest {
 protected:
  void SetUp() override {
    CheckTest::SetUp();
    // Across the wall, beyond the limits, and past a post so close that it is not proved.
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "wall", "box": {"size": [0.001, 1, 1]}},
      {"name": "post", "ball": {"radius": 0.1}, "pose": {"position": [1.47, 0.150000001, 0]}}]})");
    write("path.csv",
          "-1 0\n-0.5 1\n0.5 1\n# a line that is passed over\n0.02 1\n0.7 0\n2.5 0\n2.6 0\n1 "
          "0\n1.8 0\n1 0\n"
          "-0.0506 0\n-0.0506 1\n-0.0506 0.5\n-1 0\n0.04 0\n-0.03 0\n-2 0\n-2.1 0\n-0.0506 1\n");
  }
};

// As another process would see it: without what is told of the whole trajectory.
json without_turns(json report) {
  report.erase("continuous");
  report.erase("more_than_half_a_turn");
  return report;
}

// The first contacts of a pair are in the first part that has it, the worst ones in the deepest.
void merge_pairs(const json& part, json& all) {
  for (const json& pair : part) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const json& other) {
      return other["first"] == pair["first"] && other["second"] == pair["second"];
    });
    if (known == all.end()) {
      all.push_back(pair);
      continue;
    }
    (*known)["count"] = known->at("count").get<int>() + pair["count"].get<int>();
    if (pair["worst_contact"]["depth"] > known->at("worst_contact")["depth"]) {
      (*known)["worst_contact"] = pair["worst_contact"];
    }
  }
}

json merged(const std::vector<json>& parts) {
  json all = parts.front();
  all.erase("shard");
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (const char* count : {"configurations", "motions", "colliding"}) {
      if (all.contains(count)) all[count] = all[count].get<int>() + parts[i].at(count).get<int>();
    }
    json& limits = all["limits"];
    const json& more = parts[i].at("limits");
    limits["outside"] = limits["outside"].get<int>() + more.at("outside").get<int>();
    if (limits["first"].is_null()) limits["first"] = more.at("first");
    merge_pairs(parts[i].at("pairs"), all["pairs"]);
    for (const json& point : parts[i].at("not_proved")) all["not_proved"].push_back(point);
    for (const char* contact : {"first_contact", "worst_contact"}) {
      if (all[contact].is_null() ||
          (contact == std::string("worst_contact") && parts[i][contact].is_object() &&
           parts[i][contact]["depth"] > all[contact]["depth"])) {
        all[contact] = parts[i][contact];
      }
    }
    for (const char* verdict : {"not proved", "collision"}) {
      if (parts[i]["verdict"] == verdict) all["verdict"] = verdict;
    }
  }
  return all;
}

TEST_F(ShardTest, ReportsTogetherAreThatOfTheWhole) {
  const std::vector<std::vector<std::string>> ways = {
      {}, {"--edges", "--resolution", "0.01"}, {"--edges", "--continuous", "shortest"}};
  for (const std::vector<std::string>& way : ways) {
    const json whole = without_turns(checked(1, way));
    ASSERT_GT(whole["limits"]["outside"], 0);
    ASSERT_GT(whole["colliding"], 2);
    if (way == ways[1]) {
      ASSERT_GT(whole["not_proved"].size(), 1u);
    }
    for (const int of : test::effort(std::vector{7, 2, 3, 16, 40}, 1)) {
      std::vector<json> parts;
      for (int i = 1; i <= of; ++i) {
        std::vector<std::string> line = command(way);
        line.insert(line.end(),
                    {"--json", "--shard", std::to_string(i) + "/" + std::to_string(of)});
        const Outcome outcome = run(line);
        ASSERT_LE(outcome.exit_code, 1) << outcome.err;
        parts.push_back(without_turns(json::parse(outcome.out)));
        EXPECT_EQ(outcome.exit_code, parts.back()["verdict"] == "free" ? 0 : 1);
        EXPECT_EQ(parts.back()["shard"], (json{{"index", i}, {"of", of}}));
      }
      EXPECT_EQ(merged(parts), whole) << of;
    }
  }
}

// Each motion goes through the wall, deepest on its way.
TEST_F(ShardTest, TheDeepestContactsOfManyMotionsDoNotDependOnTheParts) {
  std::string path;
  for (int i = 0; i < 1001; ++i) path += "-0.3 0\n0.31 0\n";
  write("path.csv", path);
  const json whole = without_turns(checked(1, {"--edges"}));
  ASSERT_EQ(whole["colliding"], 2001);
  std::vector<json> parts;
  for (const char* shard : {"1/2", "2/2"}) {
    parts.push_back(without_turns(checked(1, {"--edges", "--shard", shard})));
  }
  EXPECT_EQ(merged(parts), whole);
}

TEST_F(ShardTest, WhatIsNoShardIsRefused) {
  for (const char* text :
       {"", "3", "0/4", "5/4", "1/0", "-1/4", "1/4x", "a/b", "1/", "1/9999999"}) {
    const Outcome outcome = run(command({"--shard", text}));
    EXPECT_EQ(outcome.exit_code, 2) << text;
    EXPECT_NE(outcome.err.find("--shard"), std::string::npos) << outcome.err;
  }
  const Outcome empty = run(command({"--shard", "40/40", "--view", "page.html"}));
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_NE(empty.err.find("is empty"), std::string::npos) << empty.err;
}

class FitEachTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    for (const char* name : {"a.stl", "b.stl", "c.stl"}) write_box(name, {4, 4, 4});
    write_box("d.stl", {8, 4, 4});
    write("bad.stl", "no mesh");
  }
  Outcome fit(const std::vector<std::string>& more) {
    std::vector<std::string> line = {"fit",    "a.stl",       "bad.stl", "b.stl",    "d.stl",
                                     "--each", "--max-error", "1",       "--effort", "0"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
};

TEST_F(FitEachTest, EveryMeshHasTheFileThatItHasAlone) {
  const Outcome outcome = fit({"-o", "covers"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("bad.stl"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("covers/bad.json"));
  ASSERT_EQ(run({"fit", "d.stl", "-o", "one.json", "--max-error", "1", "--effort", "0"}).exit_code,
            0);
  EXPECT_EQ(read("covers/d.json"), read("one.json"));
  EXPECT_TRUE(exists("covers/a.json") && exists("covers/b.json"));
}

TEST_F(FitEachTest, ShardsDivideThemAndWhatIsThereIsLeft) {
  EXPECT_EQ(fit({"-o", "covers", "--shard", "1/2"}).exit_code, 0);
  EXPECT_TRUE(exists("covers/a.json") && exists("covers/b.json"));
  EXPECT_FALSE(exists("covers/d.json"));
  EXPECT_EQ(fit({"-o", "covers", "--shard", "2/2"}).exit_code, 2);
  EXPECT_TRUE(exists("covers/d.json"));
  const std::string whole = read("covers/a.json");
  write("covers/d.json", "half");
  const Outcome again = fit({"-o", "covers", "--skip-existing"});
  EXPECT_EQ(read("covers/a.json"), whole);
  EXPECT_NE(again.out.find("covers/a.json: is there"), std::string::npos) << again.out;
  EXPECT_EQ(again.out.find("covers/d.json: is there"), std::string::npos) << again.out;
  EXPECT_EQ(read_json("covers/d.json")["certificate"]["covered"], true);
  // What an interruption left is made again.
  write("covers/a.json", whole.substr(0, whole.rfind('}')) + ",\n\"interrupted\":true}\n");
  fit({"-o", "covers", "--skip-existing"});
  EXPECT_EQ(read("covers/a.json"), whole);
}

TEST_F(FitEachTest, WhatIsOfOneFileIsRefused) {
  for (const char* option : {"--report", "--tree", "--view"}) {
    const Outcome outcome = fit({option, "file"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("of one file"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run({"fit", "a.stl", "--shard", "1/2"}).exit_code, 2);
  EXPECT_EQ(run({"fit", "a.stl", "x/a.stl", "--each"}).exit_code, 2);
}

}  // namespace
}  // namespace spherule
