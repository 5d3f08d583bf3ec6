// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/cad_file.h"

#include "base/error.h"
#include "base/files.h"
#include "geometry/mesh_distance.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <string>

namespace spherule::test::cad_file_test {
namespace {

using Eigen::Vector3d;

class CadFile : public ::testing::Test {
 protected:
  std::filesystem::path step(const TopoDS_Shape& shape, const char* unit = "MM") {
    const std::filesystem::path path = folder_.path() / "part.step";
    write_step(shape, path, unit);
    return path;
  }

  void expect_refusal(const std::filesystem::path& path, const std::string& reason) {
    try {
      read_cad(path);
      ADD_FAILURE() << path << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), path.string());
      EXPECT_NE(error.reason().find(reason), std::string::npos) << error.reason();
    }
  }

  TempDir folder_;
};

void expect_box(const TriangleMesh& mesh, const Vector3d& low, const Vector3d& high) {
  const Eigen::AlignedBox3d box = MeshDistance(mesh).box();
  EXPECT_LT((box.min() - low).norm(), 1e-9) << box.min().transpose();
  EXPECT_LT((box.max() - high).norm(), 1e-9) << box.max().transpose();
}

TEST_F(CadFile, ABoxIsTwelveTriangles) {
  const CadPart part = read_cad(step(shape_named("box")));
  EXPECT_EQ(part.faces, 6u);
  EXPECT_EQ(part.free_edges, 0u);
  EXPECT_EQ(part.mesh.triangles.size(), 12u);
  EXPECT_EQ(part.mesh.vertices.size(), 8u);
  expect_box(part.mesh, {0, 0, 0}, {20, 30, 40});
  // Flat: only the tolerance of the file and rounding are left.
  EXPECT_LT(part.chord_error, part.tolerance + 1e-9);
}

TEST_F(CadFile, UnitsBecomeMillimetres) {
  for (const char* unit : {"MM", "INCH", "M"}) {
    const CadPart part = read_cad(step(shape_named("box"), unit));
    expect_box(part.mesh, {0, 0, 0}, {20, 30, 40});
  }
  EXPECT_NE(read_file(step(shape_named("box"), "INCH")).find("'INCH'"), std::string::npos);
}

TEST_F(CadFile, ScaleAppliesToAllLengths) {
  const std::filesystem::path path = step(shape_named("torus"));
  const CadPart millimetres = read_cad(path, {.chord_error = 0.25});
  const CadPart metres = read_cad(path, {.scale = 0.001, .chord_error = 0.00025});
  ASSERT_EQ(metres.mesh.triangles.size(), millimetres.mesh.triangles.size());
  EXPECT_NEAR(metres.chord_error, 0.001 * millimetres.chord_error, 1e-12);
  EXPECT_GE(metres.mesh.vertex_error, metres.chord_error);
  EXPECT_NEAR((metres.mesh.vertices[5] - 0.001 * millimetres.mesh.vertices[5]).norm(), 0.0, 1e-15);
  EXPECT_NEAR(metres.asked, 0.00025, 1e-15);
}

TEST_F(CadFile, PartsOfAnAssemblyAreInPlace) {
  const CadPart part = read_cad(step(assembly()));
  EXPECT_EQ(part.faces, 12u);
  expect_box(part.mesh, {0, 0, 0}, {100, 20, 5});
  const MeshReport report = mesh_report(part.mesh);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.components, 2u);
  EXPECT_NEAR(report.volume, 2000.0, 1e-6);
}

TEST_F(CadFile, AFaceAloneIsRead) {
  const CadPart part = read_cad(step(shape_named("wavy_face")));
  EXPECT_EQ(part.faces, 1u);
  EXPECT_FALSE(mesh_report(part.mesh).closed);
}

TEST_F(CadFile, EqualFilesGiveEqualMeshes) {
  const std::filesystem::path path = step(shape_named("plate"));
  const CadPart once = read_cad(path);
  const CadPart again = read_cad(path);
  EXPECT_EQ(once.mesh.vertices, again.mesh.vertices);
  EXPECT_EQ(once.mesh.triangles, again.mesh.triangles);
  EXPECT_EQ(once.mesh.vertex_error, again.mesh.vertex_error);
}

TEST_F(CadFile, BadFilesAreRefused) {
  expect_refusal(folder_.path() / "none.step", "no such file");
  expect_refusal(folder_.write("empty.step", ""), "empty");
  for (const char* name : {"noise.step", "noise.stp", "noise.iges", "noise.igs"}) {
    expect_refusal(folder_.write(name, "what is this\n\x01\x02;;\n"), "");
  }
  const std::string step_bytes = read_file(step(shape_named("plate")));
  expect_refusal(folder_.write("head.step", step_bytes.substr(0, step_bytes.find("DATA;"))), "");
  expect_refusal(step(wire()), "holds no faces");
  std::string tessellated = step_bytes;
  tessellated.insert(tessellated.rfind("ENDSEC;"), "#99999=TESSELLATED_SOLID('',(),$);\n");
  expect_refusal(folder_.write("tessellated.step", tessellated), "TESSELLATED_SOLID");
}

// A file cut short, or with a record broken, is refused or read whole; nothing is left out.
TEST_F(CadFile, DamagedFilesAreNeverReadInPart) {
  const std::string bytes = read_file(step(shape_named("box")));
  int refused = 0;
  const auto try_bytes = [&](const std::string& damaged) {
    try {
      EXPECT_EQ(read_cad(folder_.write("damaged.step", damaged)).faces, 6u);
    } catch (const Error&) {
      ++refused;
    }
  };
  const std::string kFace = "ADVANCED_FACE";
  for (std::size_t at = bytes.find(kFace); at != bytes.npos; at = bytes.find(kFace, at + 1)) {
    std::string damaged = bytes;
    damaged[at + kFace.size() + 4] = '9';  // within the list of its bounds
    try_bytes(damaged);
  }
  const std::string kPlane = "= PLANE(";
  std::string without_surface = bytes;
  without_surface.replace(bytes.find(kPlane), kPlane.size(), "= PLAIN(");
  try_bytes(without_surface);
  for (const double share : {0.5, 0.8, 0.95}) {
    try_bytes(bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
  }
  EXPECT_GE(refused, 2);
}

TEST_F(CadFile, BadOptionsAreRefused) {
  const std::filesystem::path path = step(shape_named("box"));
  EXPECT_THROW(read_cad(path, {.scale = 0.0}), Error);
  EXPECT_THROW(read_cad(path, {.chord_error = -1.0}), Error);
  EXPECT_THROW(read_cad(path, {.angle = 0.0}), Error);
}

// A mesh reader that is given a CAD file says who reads it.
TEST_F(CadFile, MeshReadersNameTheReader) {
  EXPECT_TRUE(is_cad_file("a/b.STEP"));
  EXPECT_TRUE(is_cad_file("b.igs"));
  EXPECT_FALSE(is_cad_file("step.stl"));
  try {
    read_mesh(step(shape_named("box")));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.reason().find("read_cad"), std::string::npos);
  }
}

}  // namespace
}  // namespace spherule::test::cad_file_test
