// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

#include <algorithm>
#include <cmath>

namespace spherule {
namespace {

using nlohmann::json;

using ViewTest = CommandTest;

TEST_F(ViewTest, PageHoldsAllFiles) {
  write_box("box.stl", {4, 2, 1});
  std::vector<std::array<double, 4>> row;
  for (int i = 0; i < 30; ++i) row.push_back({0.1 * i, 1, 0.5, 0.5});
  write_spheres("row.json", row);
  expect_exit(0, "tree row.json -o row.tree");
  expect_exit(0, "view box.stl row.json row.tree -o page.html");

  const std::string page = read("page.html");
  const json items = scene_of(page).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("kind"), "mesh");
  EXPECT_EQ(items[1].at("kind"), "spheres");
  EXPECT_EQ(items[2].at("kind"), "tree");
  // Four 4-byte numbers a sphere, in base64; the last level of the tree is the spheres themselves.
  const std::size_t bytes = (30 * 16 + 2) / 3 * 4;
  const json levels = items[2].at("parts").at(0).at("levels");
  EXPECT_EQ(items[1].at("parts").at(0).at("levels").at(0).get<std::string>().size(), bytes);
  EXPECT_EQ(levels.back().get<std::string>().size(), bytes);
  EXPECT_GT(levels.size(), 2u);
  // All parts were put in, with the licence of what is not ours.
  for (const char* mark : {"/*STYLE*/", "/*THREE*/", "/*SCRIPT*/", "/*SCENE*/", "<!--TITLE-->"}) {
    EXPECT_FALSE(has(page, mark)) << mark;
  }
  EXPECT_TRUE(has(page, "Copyright (c) 2010-2019 three.js authors"));
  // Our own parts fetch nothing; of three.js only its loaders would, which are not called.
  const std::size_t three = page.find("\nthree.js, release");
  const std::size_t after = page.find("</script>", three);
  ASSERT_LT(three, after);
  const std::string own = page.substr(0, three) + page.substr(after);
  for (const char* mark : {"src=", "href=", "import", "url(", "fetch(", "XMLHttpRequest"}) {
    EXPECT_FALSE(has(own, mark)) << mark;
  }
}

TEST_F(ViewTest, LeaksOfAnAudit) {
  // Without external spheres what is inside is found by a flood: quick in a bar.
  write_box("box.stl", {4, 0.4, 0.2});
  write_spheres("two.json", {{1, 0.2, 0.1, 1.2}, {2, 0.2, 0.1, 1.2}});
  const json certificate = expect_json(1, "audit box.stl two.json");
  ASSERT_GT(certificate.at("leaks").size(), 10u);
  // The corners at x = 4 are the furthest: sqrt(2^2 + 0.2^2 + 0.1^2) from a centre.
  const double deepest = std::sqrt(4.05) - 1.2;
  EXPECT_NEAR(certificate.at("leaks").at(0).at("depth").get<double>(), deepest, 1e-12);

  write("audit.json", certificate.dump());
  expect_exit(0, "view box.stl two.json audit.json -o page.html");
  const json scene = scene_of(read("page.html"));
  const json leaks = scene.at("items").at(2);
  EXPECT_EQ(leaks.at("kind"), "leaks");
  EXPECT_TRUE(has(leaks.at("facts").get<std::string>(), "proved"));
  const auto numbers = floats_of(leaks.at("parts").at(0).at("levels").at(0));
  ASSERT_EQ(numbers.size(), 4 * (certificate.at("leaks").size() + 1));
  EXPECT_NEAR(numbers[3], deepest, 0.01);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = certificate.at("deepest_leak").at(axis);
    EXPECT_NEAR(numbers[axis] + scene.at("middle").at(axis).get<double>(), place, 1e-5);
  }
  // The surface that leaks belongs to the spheres; on it no point is covered.
  EXPECT_EQ(leaks.at("of"), "two.json");
  const auto corners = floats_of(leaks.at("parts").at(0).at("positions"));
  const auto depths = floats_of(leaks.at("parts").at(0).at("depths"));
  ASSERT_GT(depths.size(), 10u);
  ASSERT_EQ(corners.size(), 3 * depths.size());
  EXPECT_NEAR(*std::max_element(depths.begin(), depths.end()), deepest, 1e-5);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double x = corners[3 * i] + scene.at("middle").at(0).get<double>();
    EXPECT_GT(x, 2.9);
  }
  // What covers has none, and says so.
  write_spheres("ball.json", {{2, 0.2, 0.1, 2.5}});
  const Outcome covered = expect_exit(0, "audit box.stl ball.json --json");
  EXPECT_FALSE(json::parse(covered.out).contains("leaks"));
  write("covered.json", covered.out);
  expect_exit(0, "view box.stl covered.json -o page.html");
  EXPECT_EQ(scene_of(read("page.html")).at("items").at(1).at("facts"), "covered (proved)");
}

TEST_F(ViewTest, ReportHoldsExternalSpheres) {
  write_box("box.stl", {4, 2, 1});
  expect_exit(0,
              "fit box.stl --max-error 0.5 --min-external 3 --effort 0 -o box.json --report "
              "report.json --external-spheres");
  expect_exit(0, "view box.stl box.json report.json -o page.html");
  const json items = scene_of(read("page.html")).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[2].at("kind"), "external");
  EXPECT_EQ(items[2].at("shown"), false);
  const auto numbers = floats_of(items[2].at("parts").at(0).at("levels").at(0));
  const json report = read_json("report.json");
  EXPECT_EQ(numbers.size(), 4 * report.at("simplified_solid").at("external_spheres").size());
}

TEST_F(ViewTest, NamesCannotBreakThePage) {
  const std::string name = "a<b>&'\"<script>.json";
  write_spheres(name, {{0, 0, 0, 1}});
  expect_exit(0, {"view", name, "-o", "page.html"});
  const std::string page = read("page.html");
  EXPECT_EQ(scene_of(page).at("items").at(0).at("name"), name);
  EXPECT_TRUE(has(page, "<title>a&lt;b&gt;&amp;"));
}

TEST_F(ViewTest, BadInput) {
  write_spheres("none.json", {});
  write("text.txt", "hello");
  expect_refusals({{"view none.json -o page.html", "nothing to show"},
                   {"view text.txt -o page.html", "text.txt: "},
                   {"info text.txt", "text.txt: "}});
  write("audit.json", R"({"deepest_leak": "here", "covered": false, "uncovered_depth": 3})");
  expect_refusal("view audit.json -o page.html", "audit.json: ");
  write("report.json", R"({"format": "spherule-report"})");
  expect_refusal("view report.json -o page.html", "report.json: ");
  write("twice.json", R"({"format": "spherule-report", "links": [], "links": []})");
  expect_refusal("view twice.json -o page.html", "the key \"links\" appears twice");
  expect_refusal("view none.json -o none.json", "named twice");
  EXPECT_FALSE(exists("page.html"));
}

}  // namespace
}  // namespace spherule
