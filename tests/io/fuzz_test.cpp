// SPDX-License-Identifier: BSD-3-Clause
#include "base/crc64.h"
#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "io/sphere_text.h"
#include "spheretree/build.h"
#include "spheretree/tree_bytes.h"
#include "tests/support/effort.h"
#include "tests/support/exact/trees.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace spherule::test {
namespace {

// Broken files of every format: reading ends in an Error or in a mesh that can be used.

constexpr int kFilesPerFormat = 400;

struct Format {
  std::string extension;
  std::string bytes;
  // Makes the file of the mutated bytes; without it, they are the file.
  std::string (*wrap)(const std::string&) = nullptr;
};

void PrintTo(const Format& format, std::ostream* out) {
  *out << format.extension;
}

class MeshFuzz : public ::testing::TestWithParam<Format> {};

TEST_P(MeshFuzz, ErrorOrValidMesh) {
  const TempDir dir;
  Random random(1);
  int refused = 0;
  for (int i = 0; i < kFilesPerFormat; ++i) {
    const std::string_view alphabet = i % 2 == 0 ? "" : "0123456789-.e ";
    std::string bytes = mutated(GetParam().bytes, random, alphabet);
    if (GetParam().wrap != nullptr) bytes = GetParam().wrap(bytes);
    const auto path = dir.write("a." + GetParam().extension, bytes);
    try {
      const TriangleMesh mesh = read_mesh(path);
      validate(mesh, "read");
      describe(mesh_report(mesh));
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.subject(), path.string());
      EXPECT_FALSE(error.reason().empty());
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, kFilesPerFormat);
}

const TriangleMesh kSphere = icosphere(1);
const std::string kModel = threemf_model(kSphere, "1 0 0 0 1 0 0 0 1 10 20 30");

std::string stored(const std::string& model) {
  return threemf_bytes(model);
}

INSTANTIATE_TEST_SUITE_P(
    , MeshFuzz,
    ::testing::Values(Format{"stl", binary_stl(kSphere)}, Format{"stl", text_stl(kSphere)},
                      Format{"obj", obj_text(kSphere)}, Format{"off", off_text(kSphere)},
                      Format{"ply", ply_bytes(kSphere, PlyForm::kText, true)},
                      Format{"ply", ply_bytes(kSphere, PlyForm::kBigEndian, false)},
                      Format{"dae", dae_text(kSphere, Eigen::Matrix4d::Identity())},
                      Format{"3mf", threemf_bytes(kModel)},
                      Format{"3mf", threemf_bytes(kModel, Zip::kDeflated64)},
                      Format{"3mf", kModel, &stored}, Format{"gltf", gltf_text(kSphere, {1, 2, 3})},
                      Format{"glb", glb_bytes(kSphere, {1, 2, 3})}));

// Seeded mutations of valid files: a loader either throws Error or returns something valid. Run
// under the sanitizers, this also shows that no byte sequence leads to undefined behaviour.

constexpr int kCases = effort(40000, 8000);

TEST(LoaderFuzz, MutatedTrees) {
  Random random(31);
  const std::string good =
      internal::encode_tree(build_tree(sphere_families(12, 1).front().spheres, {.branching = 3}));
  int valid = 0;
  int refused = 0;
  for (int i = 0; i < kCases; ++i) {
    std::string bytes = mutated(good, random);
    // Half of them get a right checksum, or none would come past it.
    if (i % 2 == 0 && bytes.size() >= 8) {
      const std::uint64_t checksum = crc64(std::string_view(bytes).substr(0, bytes.size() - 8));
      std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
    }
    try {
      const SphereTree tree = internal::decode_tree(bytes, "a.tree");
      ASSERT_EQ(fault_of(tree.data()), "");
      ++valid;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(valid, kCases / 400);  // for example, a leaf that moved within its parent
  EXPECT_GT(refused, kCases / 4);
}

TEST(LoaderFuzz, MutatedSphereFiles) {
  Random random(32);
  SphereFile file;
  file.spheres = sphere_families(4, 1).front().spheres;
  file.certificate = {.covered = true, .volume_ratio = 1.5};
  file.certificate->sphere_count = file.spheres.size();
  file.options = {{"seed", std::int64_t{3}}, {"max-error", 0.5}, {"method", std::string("cover")}};
  const std::string good = internal::encode_spheres(file, "a.json");
  int valid = 0;
  int refused = 0;
  for (int i = 0; i < kCases; ++i) {
    const std::string_view alphabet = i % 2 == 0 ? "0123456789.-+eE,:[]{}\"\\ntfu" : "";
    try {
      const SphereFile loaded = internal::decode_spheres(mutated(good, random, alphabet), "a.json");
      for (const Sphere& sphere : loaded.spheres) {
        ASSERT_TRUE(std::isfinite(sphere.center.sum()) && sphere.radius >= 0.0);
      }
      // What was read can be written and read again.
      const std::string text = internal::encode_spheres(loaded, "a.json");
      ASSERT_EQ(internal::encode_spheres(internal::decode_spheres(text, "a.json"), "a.json"), text);
      ++valid;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(valid, kCases / 40);
  EXPECT_GT(refused, kCases / 4);
}

}  // namespace
}  // namespace spherule::test
