// SPDX-License-Identifier: BSD-3-Clause
// CAD files are read whole and in place, or refused with the file and the reason (G8).
#include "io/cad/cad_file.h"

#include "base/error.h"
#include "base/files.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

class CadFile : public testing::Test {
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
  const TriangleMesh once = read_cad(path).mesh;
  const TriangleMesh again = read_cad(path).mesh;
  EXPECT_EQ(once.vertices, again.vertices);
  EXPECT_EQ(once.triangles, again.triangles);
  EXPECT_EQ(once.vertex_error, again.vertex_error);
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

// --- what OpenCASCADE would leave out ---

// The number of the first entity of this type, with its #.
std::string entity(const std::string& bytes, const std::string& type) {
  const std::size_t end = bytes.find(" = " + type + "(");
  const std::size_t begin = bytes.rfind('#', end);
  return bytes.substr(begin, end - begin);
}

// What OpenCASCADE reads without, which is a part of the shape.
struct Lost {
  std::string name;
  std::string entities;  // $AXIS, $SHAPE: an axis placement, the shape's definition
  std::string item;      // of the shape's representation
  std::string named;     // in the refusal
};

// As the tests are called.
void PrintTo(const Lost& lost, std::ostream* out) {
  *out << lost.name;
}

class CadRefusal : public CadFile, public testing::WithParamInterface<Lost> {};

TEST_P(CadRefusal, NothingIsLeftOutOfTheShape) {
  std::string bytes = read_file(step(shape_named("box")));
  std::string added = GetParam().entities;
  const auto fill = [&](const std::string& key, const std::string& value) {
    for (std::size_t at = added.find(key); at != added.npos; at = added.find(key)) {
      added.replace(at, key.size(), value);
    }
  };
  const std::string representation = entity(bytes, "ADVANCED_BREP_SHAPE_REPRESENTATION");
  const std::string start = "ADVANCED_BREP_SHAPE_REPRESENTATION('',(";
  const std::size_t items = bytes.find(start) + start.size();
  const std::size_t close = bytes.find("),#", items);
  fill("$AXIS", entity(bytes, "AXIS2_PLACEMENT_3D"));
  fill("$SHAPE", entity(bytes, "PRODUCT_DEFINITION_SHAPE"));
  fill("$REPRESENTATION", representation);
  fill("$CONTEXT", bytes.substr(close + 2, bytes.find(')', close + 2) - close - 2));
  if (!GetParam().item.empty()) bytes.insert(items, GetParam().item + ",");
  bytes.insert(bytes.rfind("ENDSEC;"), added);
  expect_refusal(folder_.write("changed.step", bytes), GetParam().named);
}

const Lost kLost[] = {
    {"CsgSolid", "#9001=BLOCK('',$AXIS,100.,100.,100.);\n#9002=CSG_SOLID('',#9001);\n", "#9002",
     "#9002 (CsgSolid)"},
    {"CsgRepresentation",
     "#9001=BLOCK('',$AXIS,100.,100.,100.);\n#9002=CSG_SOLID('',#9001);\n"
     "#9003=CSG_SHAPE_REPRESENTATION('',(#9002),$CONTEXT);\n"
     "#9004=SHAPE_DEFINITION_REPRESENTATION($SHAPE,#9003);\n",
     "", "#9001 (Block)"},
    {"SphereInSet", "#9001=SPHERICAL_SURFACE('',$AXIS,100.);\n#9002=GEOMETRIC_SET('',(#9001));\n",
     "#9002", "#9001 (SphericalSurface)"},
    {"SurfaceAlone", "#9001=SPHERICAL_SURFACE('',$AXIS,100.);\n", "#9001",
     "#9001 (SphericalSurface)"},
    {"OffsetInSet",
     "#9000=PLANE('',$AXIS);\n"
     "#9005=RECTANGULAR_TRIMMED_SURFACE('',#9000,0.,100.,0.,100.,.T.,.T.);\n"
     "#9001=OFFSET_SURFACE('',#9005,50.,.F.);\n#9002=GEOMETRIC_SET('',(#9001));\n",
     "#9002", "#9001 (OffsetSurface)"},
    {"SweptDisk",
     "#9020=CARTESIAN_POINT('',(0.,0.,0.));\n#9021=CARTESIAN_POINT('',(0.,0.,100.));\n"
     "#9022=POLYLINE('',(#9020,#9021));\n#9023=SWEPT_DISK_SOLID('',#9022,5.,$,0.,1.);\n",
     "#9023", "illegal type"},
    {"Triangulated",
     "#9010=COORDINATES_LIST('',4,((0.,0.,0.),(90.,0.,0.),(0.,90.,0.),(0.,0.,90.)));\n"
     "#9011=TRIANGULATED_SURFACE_SET('',#9010,4,(),(),((1,2,3),(1,2,4),(1,3,4),(2,3,4)));\n"
     "#9012=TESSELLATED_SHAPE_REPRESENTATION('',(#9011),$CONTEXT);\n"
     "#9013=SHAPE_DEFINITION_REPRESENTATION($SHAPE,#9012);\n",
     "", "#901"},
    {"ExternalDocument",
     "#9001=DOCUMENT_TYPE('');\n#9002=DOCUMENT_FILE('lid.step','',$,#9001,'',$);\n", "",
     "#9002 (DocumentFile)"},
    {"ScaledItem",
     "#9000=CARTESIAN_POINT('',(0.,0.,0.));\n#9001=REPRESENTATION_MAP($AXIS,$REPRESENTATION);\n"
     "#9002=MAPPED_ITEM('',#9001,#9003);\n"
     "#9003=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,$,#9000,3.,$);\n"
     "#9004=SHAPE_REPRESENTATION('',($AXIS,#9002),$CONTEXT);\n",
     "", "CARTESIAN_TRANSFORMATION_OPERATOR"},
    // Fewer parameters than the entity has.
    {"BrokenEntity", "#9001=CARTESIAN_POINT('');\n#9002=LINE('',#9001);\n", "#9002", "#900"},
    {"NoSuchEntity", "#9001=GEOMETRIC_SET('',(#9999));\n", "#9001", "#9999"}};

INSTANTIATE_TEST_SUITE_P(Kinds, CadRefusal, testing::ValuesIn(kLost),
                         [](const auto& lost) { return lost.param.name; });

}  // namespace
}  // namespace spherule::test
