// SPDX-License-Identifier: BSD-3-Clause
// What is made of the paper's comparisons: the search for the fewest spheres at equal protrusion,
// figure 2, and the page.

#include "base/files.h"
#include "bench/paper/equal_protrusion.h"
#include "bench/paper/figure2.h"
#include "bench/paper/page.h"
#include "bench/scenes/shapes.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

namespace spherule {
namespace {

// A bar, whose inside is found in less time than that of a cube. As many spheres about its middle
// as the reciprocal of the error, with the radius of the one around it, and the error and `more`
// beyond that. The one around it protrudes by kThroughCorners, beside the middle of a long side.
const Eigen::Vector3d kBarSize(1.0, 0.02, 0.02);
const double kHalfDiagonal = 0.5 * kBarSize.norm();
const double kThroughCorners = kHalfDiagonal - 0.01;
SphereMethod concentric(double more) {
  return {"concentric", [more](const TriangleMesh&, double error) {
            return std::vector<Sphere>(static_cast<std::size_t>(std::ceil(1.0 / error)),
                                       {Eigen::Vector3d::Zero(), kHalfDiagonal + more + error});
          }};
}

TEST(FewestSpheres, AreThoseOfAnErrorThatNearlyReachesTheLimit) {
  const double limit = kThroughCorners + 0.15;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(0.0), limit);
  EXPECT_EQ(found.method, "concentric");
  EXPECT_EQ(found.inflation, 0.0);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LE(found.setting, 0.15);
  EXPECT_GE(found.setting, 0.1);
  EXPECT_EQ(found.spheres, static_cast<std::size_t>(std::ceil(1.0 / found.setting)));
}

TEST(FewestSpheres, GrowUntilTheyCover) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const double limit = kThroughCorners + 0.1;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(-0.7), limit);
  EXPECT_GT(found.spheres, 0U);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LT(found.setting, 0.7);
  EXPECT_GE(found.inflation, 0.7 - found.setting);
}

TEST(FewestSpheres, AreNoneWhereNoSettingKeepsToTheLimit) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(1.0), 0.1);
  EXPECT_EQ(found.spheres, 0U);
  EXPECT_GT(found.protrusion, 0.9);
}

TEST(SphereMethods, MakeMoreSpheresForASmallerError) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  std::vector<std::string> names;
  const TriangleMesh cube = make_cube(1.0);
  for (const SphereMethod& method : sphere_methods()) {
    names.push_back(method.name);
    const std::size_t few = method.make(cube, 0.3).size();
    EXPECT_GT(few, 0U) << method.name;
    EXPECT_GT(method.make(cube, 0.12).size(), few) << method.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"packing", "openvdb", "voxels", "octree", "hubbard",
                                             "medial-axis", "paper", "cover-as-is", "cover"}));
}

TEST(Figure2, BoundingSpheresAreFewerThanPackedOnes) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const Figure2 figure = figure_2();
  ASSERT_EQ(figure.fits.size(), 3U);
  EXPECT_LT(figure.fits[1].spheres.size(), figure.fits[0].spheres.size());
  EXPECT_LT(figure.fits[2].spheres.size(), figure.fits[1].spheres.size());
  for (const Figure2::Fit& fit : figure.fits) {
    EXPECT_LE(fit.protrusion, figure.max_error * (1.0 + 1e-9)) << fit.method;
  }
}

class PageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("spherule-page-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(PageTest, SaysWhatWasComputed) {
  PaperResults results;
  Table1Row row{"original", "1,942 <triangles>", true, {}, {}, PaperRow{"1942 triangles", 2032, 9}};
  row.whole = {.queries = 15178, .count = {.collisions = 2058}, .seconds = 0.09, .ratio = 1.0};
  results.table1.push_back(row);
  results.counts.push_back(
      {"a & b", 12, 1.0, 0.02, {{.method = "packing", .spheres = 77}, {.method = "cover"}}});
  results.claims.push_back({"plate", 50, 2612, 0.003, 0.012, 704, 790, 36.5});
  write_page(results, folder_);
  const std::string page = read_file(folder_ / "paper.html");
  for (const char* text : {"15178 configurations", "1,942 &lt;triangles&gt; (1942 triangles)",
                           "2058 (2032)", "a &amp; b", "<td>77</td><td>none found</td>",
                           "<td>704</td><td>790</td><td>36.5</td>", "paper-figure3.svg"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
}

TEST_F(PageTest, HoldsItsImagesAfterwards) {
  write_file_atomically(folder_ / "a.svg", "<svg/>");
  write_file_atomically(folder_ / "b.png", "PNG");
  write_file_atomically(
      folder_ / "page.html",
      "<p>1</p><img src=\"a.svg\"> and <img src=\"b.png\" alt=\"x\">\n<p>2</p>\n");
  const std::string embed = "'" SPHERULE_SOURCE_DIR "/bench/plots/embed-images' ";
  ASSERT_EQ(std::system((embed + (folder_ / "page.html").string()).c_str()), 0);
  EXPECT_EQ(read_file(folder_ / "page.html"),
            "<p>1</p><img src=\"data:image/svg+xml;base64,PHN2Zy8+\"> and "
            "<img src=\"data:image/png;base64,UE5H\" alt=\"x\">\n<p>2</p>\n");
  // An image that is lacking is an error, and the page stays as it is.
  write_file_atomically(folder_ / "page.html", "<img src=\"c.png\">\n");
  EXPECT_NE(std::system((embed + (folder_ / "page.html").string() + " 2>/dev/null").c_str()), 0);
  EXPECT_EQ(read_file(folder_ / "page.html"), "<img src=\"c.png\">\n");
}

}  // namespace
}  // namespace spherule
