// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

using nlohmann::json;

using ViewTest = CommandTest;

// The scene that a page carries.
json scene_of(const std::string& page) {
  const std::string start = "<script id=\"scene\" type=\"application/json\">";
  const std::size_t begin = page.find(start);
  const std::size_t end = page.find("</script>", begin);
  EXPECT_NE(begin, std::string::npos);
  EXPECT_NE(end, std::string::npos);
  return json::parse(page.substr(begin + start.size(), end - begin - start.size()));
}

TEST_F(ViewTest, PageHoldsAllFiles) {
  write_box("box.stl", {4, 2, 1});
  std::vector<std::array<double, 4>> row;
  for (int i = 0; i < 30; ++i) row.push_back({0.1 * i, 1, 0.5, 0.5});
  write_spheres("row.json", row);
  ASSERT_EQ(run({"tree", "row.json", "-o", "row.tree"}).exit_code, 0);
  const Outcome view = run({"view", "box.stl", "row.json", "row.tree", "-o", "page.html"});
  ASSERT_EQ(view.exit_code, 0) << view.err;

  const std::string page = read("page.html");
  const json items = scene_of(page).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("kind"), "mesh");
  EXPECT_EQ(items[1].at("kind"), "spheres");
  EXPECT_EQ(items[2].at("kind"), "tree");
  // Four 4-byte numbers a sphere, in base64; the last level of the tree is the spheres themselves.
  const std::size_t bytes = (30 * 16 + 2) / 3 * 4;
  EXPECT_EQ(items[1].at("levels").at(0).get<std::string>().size(), bytes);
  EXPECT_EQ(items[2].at("levels").back().get<std::string>().size(), bytes);
  EXPECT_GT(items[2].at("levels").size(), 2u);
  // All parts were put in, and nothing is fetched from elsewhere.
  for (const char* mark :
       {"/*STYLE*/", "/*SCRIPT*/", "/*SCENE*/", "<!--TITLE-->", "://", "src=", "import", "url("}) {
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  }
}

TEST_F(ViewTest, NamesCannotBreakThePage) {
  const std::string name = "a<b>&'\"<script>.json";
  write_spheres(name, {{0, 0, 0, 1}});
  ASSERT_EQ(run({"view", name, "-o", "page.html"}).exit_code, 0);
  const std::string page = read("page.html");
  EXPECT_EQ(scene_of(page).at("items").at(0).at("name"), name);
  EXPECT_NE(page.find("<title>a&lt;b&gt;&amp;"), std::string::npos);
}

TEST_F(ViewTest, BadInput) {
  write_spheres("none.json", {});
  write("text.txt", "hello");
  expect_refusal({"view", "none.json", "-o", "page.html"}, "nothing to show");
  expect_refusal({"view", "text.txt", "-o", "page.html"}, "text.txt: ");
  expect_refusal({"info", "text.txt"}, "text.txt: ");
  expect_refusal({"view", "none.json", "-o", "none.json"}, "named twice");
  EXPECT_FALSE(exists("page.html"));
}

}  // namespace
}  // namespace spherule
