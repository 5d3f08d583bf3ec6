// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh_io.h"

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "tests/mesh/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule {
namespace {

using test::TempDir;

// The reason of the Error that reading throws; empty if it does not throw.
std::string reason_of(const std::filesystem::path& path, double scale = 1.0) {
  try {
    read_mesh(path, {.scale = scale});
  } catch (const Error& error) {
    const bool names_file = error.subject() == path.string() || error.subject() == "scale";
    return names_file ? error.reason() : "wrong subject: " + error.subject();
  }
  return "";
}

::testing::AssertionResult refused(const std::filesystem::path& path, const std::string& why) {
  const std::string reason = reason_of(path);
  if (reason.find(why) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "reason is '" << reason << "', not '" << why << "'";
}

// Largest distance of corresponding corners; the triangles must be in the same order.
double largest_shift(const TriangleMesh& a, const TriangleMesh& b) {
  double worst = a.triangles.size() == b.triangles.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.triangles.size(), b.triangles.size()); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = a.vertices[static_cast<std::size_t>(a.triangles[i][k])];
      const Eigen::Vector3d& q = b.vertices[static_cast<std::size_t>(b.triangles[i][k])];
      worst = std::max(worst, (p - q).norm());
    }
  }
  return worst;
}

TriangleMesh ugly_numbers() {
  TriangleMesh mesh = test::icosphere(2);
  test::Random random(11);
  for (Eigen::Vector3d& v : mesh.vertices) v = 123.456789 * v + random.direction();
  return mesh;
}

// Through memory, because g++ 12 at -O2 may turn double(float(x)) in a loop into x.
TriangleMesh rounded_to_float(TriangleMesh mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) {
    for (double& x : v) {
      const volatile float rounded = static_cast<float>(x);
      x = rounded;
    }
  }
  return mesh;
}

TEST(ReadMesh, RefusesWhatIsNoFile) {
  const TempDir dir;
  EXPECT_TRUE(refused(dir.path() / "absent.stl", "no such file"));
  EXPECT_TRUE(refused(dir.path(), "is a directory"));
  EXPECT_TRUE(refused(dir.write("empty.stl", ""), "empty"));
  EXPECT_TRUE(refused("/dev/null", "not a regular file"));
  EXPECT_TRUE(refused(dir.write("part.step", "ISO-10303-21;"), "a CAD file, not a mesh"));
  EXPECT_TRUE(refused(dir.write("part", "solid"), "not a mesh format"));
  EXPECT_TRUE(refused(dir.write("part.txt", "solid"), "not a mesh format"));
}

TEST(ReadMesh, RefusesWhatIsNoMesh) {
  const TempDir dir;
  for (const char* extension : {"stl", "obj", "ply", "off", "dae", "3mf", "gltf", "glb"}) {
    for (const std::string& bytes :
         {std::string("hello"), std::string("\0\1\2\3", 4), std::string(500, 'x'),
          std::string(500, '\0'), std::string("<a/>"), std::string("{}")}) {
      EXPECT_NE(reason_of(dir.write(std::string("bad.") + extension, bytes)), "") << extension;
    }
  }
}

TEST(ReadMesh, RefusesBadScale) {
  const TempDir dir;
  const auto path = dir.write("cube.stl", test::text_stl(test::cube_mesh()));
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(reason_of(path, scale).find("must be a positive"), std::string::npos) << scale;
  }
  EXPECT_NE(reason_of(path, 1e16).find("beyond 1e15"), std::string::npos);
  EXPECT_EQ(reason_of(path, 1e15), "");
}

TEST(ReadMesh, BinaryFormatsAreExact) {
  const TempDir dir;
  const TriangleMesh mesh = rounded_to_float(ugly_numbers());
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (const auto& path :
       {dir.write("a.stl", test::binary_stl(mesh)),
        dir.write("solid.STL", test::binary_stl(mesh, "solid like text")),
        dir.write("l.ply", test::ply_bytes(mesh, test::PlyForm::kLittleEndian, false)),
        dir.write("b.ply", test::ply_bytes(mesh, test::PlyForm::kBigEndian, false)),
        dir.write("a.glb", test::glb_bytes(mesh, zero)),
        dir.write("a.gltf", test::gltf_text(mesh, zero))}) {
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(read.vertex_error, 0.0) << path;
    EXPECT_EQ(largest_shift(mesh, read), 0.0) << path;
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size()) << path;
  }
  const TriangleMesh doubles = ugly_numbers();
  const auto path = dir.write("d.ply", test::ply_bytes(doubles, test::PlyForm::kBigEndian, true));
  EXPECT_EQ(largest_shift(doubles, read_mesh(path)), 0.0);
}

TEST(ReadMesh, TextFormatsReadTheNearestDouble) {
  const TempDir dir;
  const TriangleMesh mesh = ugly_numbers();  // written with 17 digits
  for (const auto& path :
       {dir.write("a.stl", test::text_stl(mesh)), dir.write("a.obj", test::obj_text(mesh)),
        dir.write("a.off", test::off_text(mesh)),
        dir.write("a.ply", test::ply_bytes(mesh, test::PlyForm::kText, true))}) {
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(largest_shift(mesh, read), 0.0) << path;
    EXPECT_GT(read.vertex_error, 0.0) << path;
    EXPECT_LT(read.vertex_error, 1e-13) << path;
  }
}

TEST(ReadMesh, ErrorBoundHoldsUnderTransformsAndScale) {
  const TempDir dir;
  const TriangleMesh mesh = ugly_numbers();
  test::Random random(5);
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d motion(random.rotation());
    motion.translation() = 1000.0 * random.direction();
    Eigen::Affine3d map(motion);
    map.scale(random.between(0.1, 10.0));
    const double scale = random.between(0.001, 1000.0);

    const auto dae = dir.write("a.dae", test::dae_text(mesh, map.matrix(), "0.0254"));
    TriangleMesh expected = mesh;
    for (Eigen::Vector3d& v : expected.vertices) v = scale * (0.0254 * (map * v));
    const TriangleMesh read = read_mesh(dae, {.scale = scale});
    const double shift = largest_shift(expected, read);
    EXPECT_GT(shift, 0.0);
    EXPECT_LE(shift, read.vertex_error);
    EXPECT_LE(read.vertex_error, 1e-5 * scale * 0.0254 * (1000.0 + 10.0 * 130.0));

    const auto glb = dir.write("a.glb", test::glb_bytes(mesh, motion.translation()));
    expected = rounded_to_float(mesh);
    for (Eigen::Vector3d& v : expected.vertices) v = scale * (v + 2.0 * motion.translation());
    const TriangleMesh read_glb = read_mesh(glb, {.scale = scale});
    EXPECT_LE(largest_shift(expected, read_glb), read_glb.vertex_error);
  }
}

TEST(ReadMesh, ScaleErrorIsCharged) {
  const TempDir dir;
  const TriangleMesh mesh = rounded_to_float(ugly_numbers());
  const auto path = dir.write("a.stl", test::binary_stl(mesh));
  const TriangleMesh read = read_mesh(path, {.scale = 1000.0});
  EXPECT_GT(read.vertex_error, 0.0);
  EXPECT_LT(read.vertex_error, 1e-9);
  EXPECT_LT((mesh_report(read).box.sizes() - 1000.0 * mesh_report(mesh).box.sizes()).norm(), 1e-9);
}

TEST(ReadMesh, ColladaKeepsItsAxesAndComesInMetres) {
  const TempDir dir;
  const TriangleMesh mesh = test::box_mesh({0, 0, 0}, {1, 2, 4});
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    const auto path =
        dir.write("a.dae", test::dae_text(mesh, Eigen::Matrix4d::Identity(), "0.5", up));
    const MeshReport report = mesh_report(read_mesh(path));
    EXPECT_EQ(report.box.max(), Eigen::Vector3d(0.5, 1, 2)) << up;
    EXPECT_TRUE(report.closed);
  }
}

TEST(ReadMesh, EqualVerticesAreJoinedOthersAreNot) {
  const TempDir dir;
  const auto path = dir.write("a.stl", test::text_stl(test::cube_mesh()));
  EXPECT_EQ(read_mesh(path).vertices.size(), 8u);
  TriangleMesh cracked = test::cube_mesh();
  cracked.vertices.push_back(cracked.vertices[0] + Eigen::Vector3d(1e-15, 0, 0));
  cracked.triangles[0][0] = 8;
  EXPECT_EQ(read_mesh(dir.write("b.obj", test::obj_text(cracked))).vertices.size(), 9u);
}

TEST(ReadMesh, KeepsWhatIsUnusual) {
  const TempDir dir;
  for (const test::NamedMesh& entry : test::mesh_zoo()) {
    const auto path = dir.write("a.off", test::off_text(entry.mesh));
    EXPECT_EQ(largest_shift(entry.mesh, read_mesh(path)), 0.0) << entry.name;
  }
}

TEST(WriteStl, RoundTrip) {
  const TempDir dir;
  for (const test::NamedMesh& entry : test::mesh_zoo()) {
    const auto path = dir.path() / "out.stl";
    write_stl(entry.mesh, path);
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(largest_shift(rounded_to_float(entry.mesh), read), 0.0) << entry.name;
  }
}

TEST(WriteStl, RefusesBadInputAndLeavesNoFile) {
  const TempDir dir;
  TriangleMesh mesh = test::cube_mesh();
  EXPECT_THROW(write_stl(mesh, dir.path() / "absent" / "a.stl"), Error);
  mesh.vertices[3].x() = std::nan("");
  EXPECT_THROW(write_stl(mesh, dir.path() / "a.stl"), Error);
  EXPECT_THROW(write_stl(TriangleMesh(), dir.path() / "a.stl"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

}  // namespace
}  // namespace spherule
