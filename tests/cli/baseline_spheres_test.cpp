// SPDX-License-Identifier: BSD-3-Clause
#include "io/sphere_file.h"
#include "spheretree/tree_file.h"
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace spherule {
namespace {

using nlohmann::json;

using Words = std::vector<std::string>;

// The methods of `spherule baseline` that make spheres.
class BaselineSpheresTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    // What is inside is found by a flood whose cells are a share of the diagonal: quick in a bar.
    write_box("bar.stl", {4, 0.25, 0.25});
  }

  // Of a method with its options, on the bar.
  static Words command(Words method, const Words& more = {}) {
    method.insert(method.begin(), "baseline");
    method.insert(method.begin() + 2, "bar.stl");
    method.insert(method.end(), {"-o", "out.json"});
    method.insert(method.end(), more.begin(), more.end());
    return method;
  }

  Outcome make(const Words& method, const Words& more = {}) { return run(command(method, more)); }

  SphereFile spheres() const { return load_spheres(folder_ / "out.json"); }

  void refuse(const Words& method, const std::string& reason) {
    expect_refusal(command(method), reason);
  }
};

struct Method {
  std::string name;
  Words words;
};

// As the tests are called.
void PrintTo(const Method& method, std::ostream* out) {
  *out << method.name;
}

// The most telling first: one that leaks and has to grow. Some cover as they are.
const std::vector<Method> kMethods = {
    {"inscribed", {"voxelise", "--max-error", "0.5", "--ball", "inscribed"}},
    {"voxels", {"voxelise", "--step", "0.25"}},
    {"inflated", {"pack", "--max-error", "0.2", "--inflated"}},
    {"octree", {"octree", "--depth", "4"}},
    {"hubbard", {"hubbard", "--counts", "1,4,12"}},
    {"medial", {"medial", "--spheres", "12", "--reduction", "merge"}},
    {"packed", {"pack", "--max-error", "0.2"}},
    {"filled", {"fill", "--step", "0.01"}},
    {"surface", {"voxelise", "--step", "0.25", "--surface"}},
    {"medial_tree", {"medial", "--tree", "--branching", "3", "--depth", "2"}},
    {"octree_of_an_error", {"octree", "--max-error", "0.4"}}};

class EachBaseline : public BaselineSpheresTest, public ::testing::WithParamInterface<Method> {
 protected:
  void SetUp() override {
    BaselineSpheresTest::SetUp();
    write_box("bar.stl", {4, 0.05, 0.05});  // the thinner, the quicker
  }
};

TEST_P(EachBaseline, ExitCodeFileAndAuditSayTheSame) {
  const Words& method = GetParam().words;
  const Outcome raw = make(method, {"--json"});
  ASSERT_TRUE(raw.exit_code == 0 || raw.exit_code == 1) << raw.err;
  EXPECT_EQ(raw.err.empty(), raw.exit_code == 0) << raw.err;
  const json figures = json::parse(raw.out);
  const SphereFile file = spheres();
  EXPECT_EQ(figures.at("method"), method.front());
  EXPECT_EQ(std::get<std::string>(file.options.at("baseline")), method.front());
  EXPECT_EQ(figures.at("sphere_count"), file.spheres.size());
  EXPECT_EQ(figures.at("certificate").at("covered"), raw.exit_code == 0);
  EXPECT_GT(figures.at("certificate").at("protrusion_over_mesh").at(1), 0.0);
  EXPECT_GE(figures.at("seconds").at("method"), 0.0);
  ASSERT_TRUE(file.certificate);
  EXPECT_EQ(file.certificate->covered, raw.exit_code == 0);
  EXPECT_EQ(run({"audit", "bar.stl", "out.json"}).exit_code, raw.exit_code);

  const Outcome inflated = make(method, {"--conservative", "--json"});
  EXPECT_EQ(inflated.exit_code, 0) << inflated.err;
  EXPECT_EQ(run({"audit", "bar.stl", "out.json"}).exit_code, 0);
  const double inflation = json::parse(inflated.out).at("growth");
  EXPECT_EQ(inflation == 0.0, raw.exit_code == 0);
  // By no more than the proved depth and the proof's smallest piece.
  const double depth = figures.at("certificate").at("uncovered_depth").at(1);
  EXPECT_LE(inflation, depth + 0.001);
  const SphereFile large = spheres();
  ASSERT_EQ(large.spheres.size(), file.spheres.size());
  for (std::size_t i = 0; i < large.spheres.size(); ++i) {
    EXPECT_EQ(large.spheres[i].center, file.spheres[i].center);
    EXPECT_NEAR(large.spheres[i].radius, file.spheres[i].radius + inflation, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(, EachBaseline, ::testing::ValuesIn(test::effort(kMethods, 1)));

TEST_F(BaselineSpheresTest, FiguresOfVoxels) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  json figures = json::parse(make({"voxelise", "--step", "0.125", "--json"}).out);
  // The bar stands in the middle of 33 x 3 x 3 voxels.
  EXPECT_EQ(figures.at("surface"), 266);
  EXPECT_EQ(figures.at("inside"), 31);
  EXPECT_EQ(figures.at("step"), 0.125);
  EXPECT_EQ(figures.at("covers_by_construction"), "solid");
  EXPECT_EQ(std::get<double>(spheres().options.at("step")), 0.125);
  figures = json::parse(make({"voxelise", "--step", "0.125", "--surface", "--json"}).out);
  EXPECT_EQ(figures.at("sphere_count"), 266);
  EXPECT_EQ(figures.at("covers_by_construction"), "surface");
  figures = json::parse(make({"voxelise", "--step", "0.25", "--ball", "inscribed", "--json"}).out);
  EXPECT_TRUE(figures.at("covers_by_construction").is_null());
  EXPECT_EQ(spheres().spheres.front().radius, 0.125);
}

TEST_F(BaselineSpheresTest, FiguresOfPackingAndOctree) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  json figures =
      json::parse(make({"pack", "--max-error", "0.2", "--closed-below", "0.3", "--json"}).out);
  EXPECT_LE(figures.at("error"), 0.2);
  EXPECT_EQ(figures.at("closed_below"), 0.3);
  EXPECT_TRUE(figures.at("covers_by_construction").is_null());
  const double raw = spheres().spheres.front().radius;
  make({"pack", "--max-error", "0.2", "--closed-below", "0.3", "--inflated"});
  EXPECT_NEAR(spheres().spheres.front().radius, raw + double{figures.at("error")}, 1e-12);

  figures = json::parse(make({"octree", "--depth", "3", "--json"}).out);
  EXPECT_EQ(figures.at("depth"), 3);
  EXPECT_NEAR(figures.at("step"), 0.5, 0.001);
}

TEST_F(BaselineSpheresTest, FiguresOfMedialSpheres) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  json figures = json::parse(make({"medial", "--max-protrusion", "0.3", "--json"}).out);
  EXPECT_LE(figures.at("protrusion"), 0.3 * (1.0 + 1e-9));
  EXPECT_GT(figures.at("medial_spheres"), figures.at("sphere_count"));
  EXPECT_GT(figures.at("sites"), 0);

  figures = json::parse(make({"hubbard", "--counts", "1,5,20", "--json"}).out);
  EXPECT_EQ(figures.at("level_counts"), json({1, 5, 20}));
  EXPECT_EQ(figures.at("sphere_count"), 20);
  const std::string text = make({"hubbard", "--counts", "1,5,20"}).out;
  EXPECT_NE(text.find("sphere_count: 20\n"), std::string::npos) << text;
  EXPECT_NE(text.find("certificate: 20 spheres"), std::string::npos) << text;
}

TEST_F(BaselineSpheresTest, TreesStandOverTheSpheresOfTheFile) {
  const std::vector<Words> methods = {
      {"hubbard", "--counts", "1,4,12"},
      {"octree", "--depth", "3"},
      {"medial", "--tree", "--branching", "3", "--depth", "2", "--reduction", "merge"}};
  for (const Words& method : test::effort(methods, 1)) {
    for (const Words& inflated : test::effort(std::vector<Words>{{"--conservative"}, {}}, 1)) {
      Words more = {"--tree-file", "out.tree"};
      more.insert(more.end(), inflated.begin(), inflated.end());
      const Outcome outcome = make(method, more);
      EXPECT_LE(outcome.exit_code, inflated.empty() ? 1 : 0) << outcome.err;
      const SphereTree tree = load_tree(folder_ / "out.tree");
      EXPECT_TRUE(std::ranges::equal(tree.spheres(), spheres().spheres));
      EXPECT_GT(tree.depth(), 1);
      std::filesystem::remove(folder_ / "out.tree");
    }
  }
}

TEST_F(BaselineSpheresTest, PaddingIsCoveredToo) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const std::vector<Words> methods = {{"voxelise", "--step", "0.25"},
                                      {"hubbard", "--counts", "1,4,12"}};
  for (const Words& method : test::effort(methods, 1)) {
    const Outcome outcome = make(method, {"--padding", "0.1", "--conservative"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const SphereFile file = spheres();
    const Eigen::Vector3d beyond = Eigen::Vector3d::Constant(-0.0999 / std::sqrt(3.0));
    EXPECT_TRUE(std::ranges::any_of(file.spheres, [&](const Sphere& sphere) {
      return (sphere.center - beyond).norm() <= sphere.radius;
    }));
    EXPECT_EQ(std::get<double>(file.options.at("padding")), 0.1);
    EXPECT_EQ(run({"audit", "bar.stl", "out.json"}).exit_code, 0);
  }
}

TEST_F(BaselineSpheresTest, ScaleComesFirst) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  EXPECT_EQ(make({"voxelise", "--step", "2.5", "--scale", "10", "--conservative"}).exit_code, 0);
  EXPECT_EQ(spheres().spheres.size(), 68U);
  EXPECT_EQ(run({"audit", "bar.stl", "out.json"}).exit_code, 0);
}

TEST_F(BaselineSpheresTest, EqualOptionsGiveEqualBytesOnAnyNumberOfThreads) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  for (const Words& method :
       std::vector<Words>{{"pack", "--max-error", "0.2", "--seed", "3"},
                          {"hubbard", "--counts", "1,4,12", "--seed", "3", "--conservative"}}) {
    make(method, {"--threads", "1"});
    const std::string one = read("out.json");
    make(method, {"--threads", "2"});
    EXPECT_EQ(read("out.json"), one);
  }
}

TEST_F(BaselineSpheresTest, BadOptionsAreRefused) {
  refuse({"voxelise"}, "--step");
  refuse({"voxelise", "--step", "1", "--max-error", "1"}, "--step");
  for (const std::string& value : test::effort(Words{"0", "long", "-1", "nan", "inf"}, 2)) {
    refuse({"voxelise", "--step", value}, "--step");
    refuse({"octree", "--max-error", value}, "--max-error");
    refuse({"pack", "--max-error", value}, "--max-error");
    refuse({"medial", "--max-protrusion", value}, "--max-protrusion");
  }
  refuse({"voxelise", "--step", "1e-9"}, "step: ");
  refuse({"voxelise", "--step", "1", "--ball", "cubic"}, "--ball");
  refuse({"voxelise", "--step", "1", "--padding", "-1"}, "--padding");
  refuse({"voxelise", "--step", "1", "--threads", "-1"}, "--threads");
  refuse({"voxelise", "--step", "1", "--tree-file", "out.tree"}, "--tree-file");
  refuse({"pack"}, "--max-error");
  refuse({"pack", "--max-error", "0.2", "--closed-below", "-1"}, "--closed-below");
  refuse({"pack", "--max-error", "0.2", "--seed", "-1"}, "--seed");
  refuse({"medial", "--spheres", "0"}, "--spheres");
  refuse({"medial", "--spheres", "5", "--max-protrusion", "1"}, "--max-protrusion");
  refuse({"medial", "--reduction", "wish"}, "--reduction");
  refuse({"medial", "--branching", "4"}, "--tree");
  refuse({"medial", "--tree-file", "out.tree"}, "--tree");
  refuse({"medial", "--tree", "--spheres", "5"}, "--tree");
  refuse({"medial", "--tree", "--branching", "1"}, "branching");
  refuse({"medial", "--tree=false", "--tree-file", "out.tree"}, "tree was given");
  refuse({"octree"}, "--depth");
  refuse({"octree", "--depth", "21"}, "depth");
  refuse({"octree", "--depth", "3", "--max-error", "1"}, "--depth");
  for (const std::string& counts :
       test::effort(Words{"8,1", "", "0,8", "1,2.5", "many", "-1", "1;8"}, 2)) {
    refuse({"hubbard", "--counts", counts}, "counts");
  }
  EXPECT_EQ(files(), Words{"bar.stl"});
}

TEST_F(BaselineSpheresTest, BadFilesAreRefused) {
  write("broken.stl", "solid nothing\nfacet");
  const auto hubbard = [](const std::string& mesh, const std::string& out,
                          const std::string& tree) -> Words {
    return {"baseline", "hubbard", mesh, "-o", out, "--tree-file", tree};
  };
  expect_refusal(hubbard("none.stl", "out.json", "out.tree"), "none.stl: ");
  expect_refusal(hubbard("broken.stl", "out.json", "out.tree"), "broken.stl: ");
  expect_refusal(hubbard("bar.stl", "bar.stl", "out.tree"), "named twice");
  expect_refusal(hubbard("bar.stl", "out.json", "out.json"), "named twice");
  expect_refusal(hubbard("bar.stl", "no/out.json", "out.tree"), "no such folder");
  expect_refusal({"baseline", "hubbard", "bar.stl"}, "--output");
  // Nothing that large fits inside, and what is not made cannot grow.
  expect_refusal({"baseline", "fill", "bar.stl", "-o", "out.json", "--step", "0.05", "--min-radius",
                  "1", "--conservative"},
                 "bar.stl: no sphere");
  EXPECT_EQ(files(), (Words{"bar.stl", "broken.stl"}));
}

TEST_F(BaselineSpheresTest, HelpShowsAnExampleAndEveryOption) {
  const std::string list = run({"baseline", "--help"}).out;
  for (const char* method : {"voxelise", "pack", "fill", "medial", "octree", "hubbard"}) {
    const Outcome help = run({"baseline", method, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    const std::string example = std::string("spherule baseline ") + method + " part.stl";
    EXPECT_NE(help.out.find(example), std::string::npos) << help.out;
    EXPECT_NE(list.find(example), std::string::npos) << list;
    for (const char* option : {"--conservative", "--padding", "--scale", "--threads", "--json"}) {
      EXPECT_NE(help.out.find(option), std::string::npos) << help.out;
    }
  }
}

}  // namespace
}  // namespace spherule
