// SPDX-License-Identifier: BSD-3-Clause
// Broken files of every format: reading ends in an Error or in a mesh that can be used.
#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/mesh/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace spherule {
namespace {

constexpr int kFilesPerFormat = 400;

void mutate_once(std::string& bytes, test::Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = random.index(bytes.size());
  switch (random.index(5)) {
    case 0:
      bytes[at] = static_cast<char>(random.bits());
      break;
    case 1:
      bytes[at] = "0123456789-.e "[random.index(14)];
      break;
    case 2:
      bytes.erase(at, 1 + random.index(64));
      break;
    case 3:
      bytes.insert(random.index(bytes.size()), bytes.substr(at, 1 + random.index(32)));
      break;
    default:
      bytes.resize(at);
  }
}

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
  const test::TempDir dir;
  test::Random random(1);
  int refused = 0;
  for (int i = 0; i < kFilesPerFormat; ++i) {
    std::string bytes = GetParam().bytes;
    for (std::size_t n = 1 + random.index(4); n > 0; --n) mutate_once(bytes, random);
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

const TriangleMesh kSphere = test::icosphere(1);
const std::string kModel = test::threemf_model(kSphere, "1 0 0 0 1 0 0 0 1 10 20 30");

std::string stored(const std::string& model) {
  return test::threemf_bytes(model);
}

INSTANTIATE_TEST_SUITE_P(
    , MeshFuzz,
    ::testing::Values(
        Format{"stl", test::binary_stl(kSphere)}, Format{"stl", test::text_stl(kSphere)},
        Format{"obj", test::obj_text(kSphere)}, Format{"off", test::off_text(kSphere)},
        Format{"ply", test::ply_bytes(kSphere, test::PlyForm::kText, true)},
        Format{"ply", test::ply_bytes(kSphere, test::PlyForm::kBigEndian, false)},
        Format{"dae", test::dae_text(kSphere, Eigen::Matrix4d::Identity())},
        Format{"3mf", test::threemf_bytes(kModel)},
        Format{"3mf", test::threemf_bytes(kModel, test::Zip::kDeflated64)},
        Format{"3mf", kModel, &stored}, Format{"gltf", test::gltf_text(kSphere, {1, 2, 3})},
        Format{"glb", test::glb_bytes(kSphere, {1, 2, 3})}));

}  // namespace
}  // namespace spherule
