// SPDX-License-Identifier: BSD-3-Clause
// What `spherule_baseline` writes: meshes that are read back, and spheres whose stored certificate
// is the one that certify() comes to.
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "simplifier/simplify.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace spherule {
namespace {

class BaselineProgram : public ::testing::Test {
 protected:
  // What is inside is found by a flood whose cells are a share of the diagonal: quick in a bar.
  void SetUp() override { write_stl(make_box({4, 0.25, 0.25}), mesh_); }

  int run(const std::string& method, const std::string& options) {
    return std::system((SPHERULE_BASELINE " " + method + " '" + mesh_.string() + "' -o '" +
                        out_.string() + "' " + options + " >/dev/null 2>&1")
                           .c_str());
  }

  test::TempDir dir_;
  std::filesystem::path mesh_ = dir_.path() / "bar.stl";
  std::filesystem::path out_ = dir_.path() / "out.obj";
};

TEST_F(BaselineProgram, WritesMeshes) {
  for (const auto& [method, options] : {std::pair{"hull", ""}, std::pair{"decompose", ""},
                                        std::pair{"decimate", "--triangles 12"}}) {
    ASSERT_EQ(run(method, options), 0) << method;
    EXPECT_NEAR(mesh_report(read_mesh(out_)).volume, 0.25, 1e-6) << method;
  }
}

TEST_F(BaselineProgram, WritesSpheresWithTheirCertificate) {
  const TriangleMesh mesh = read_mesh(mesh_);
  for (const auto& [method, options] :
       {std::pair{"voxelise", "--step 0.25 --ball inscribed"}, std::pair{"voxelise", "--step 0.25"},
        std::pair{"pack", "--max-error 0.2 --inflated"}, std::pair{"fill", "--step 0.05"},
        std::pair{"medial", "--spheres 12 --reduction merge"}, std::pair{"octree", "--depth 4"},
        std::pair{"hubbard", "--counts 1,4,12"}}) {
    for (const bool conservative : {false, true}) {
      ASSERT_EQ(run(method, std::string(options) + (conservative ? " --conservative" : "")), 0)
          << method;
      const SphereFile file = load_spheres(out_);
      ASSERT_TRUE(file.certificate) << method;
      const Certificate certificate = certify(mesh, file.spheres);
      EXPECT_EQ(file.certificate->covered, certificate.covered) << method << ' ' << options;
      if (conservative) EXPECT_TRUE(certificate.covered) << method << ' ' << options;
    }
  }
}

TEST_F(BaselineProgram, CoversByAnotherStage2Method) {
  ASSERT_EQ(run("cover-medial", "--max-error 0.2 --min-external 0.8"), 0);
  EXPECT_TRUE(load_spheres(out_).certificate->covered);
}

TEST_F(BaselineProgram, RefusesBadInput) {
  EXPECT_NE(run("voxelise", "--ball round"), 0);
  EXPECT_NE(run("pack", "--max-error -1"), 0);
  EXPECT_NE(run("fill", "--step 0.05 --min-radius 1"), 0);
  EXPECT_NE(run("shrink", ""), 0);
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace spherule
