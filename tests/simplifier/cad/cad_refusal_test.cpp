// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "io/cad/cad_file.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

namespace spherule::test::cad_refusal_test {
namespace {

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

class CadRefusal : public ::testing::TestWithParam<Lost> {};

TEST_P(CadRefusal, NothingIsLeftOutOfTheShape) {
  const TempDir folder;
  const std::filesystem::path path = folder.path() / "part.step";
  write_step(shape_named("box"), path);
  std::string bytes = read_file(path);
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
  const std::filesystem::path changed = folder.write("changed.step", bytes);
  try {
    read_cad(changed);
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), changed.string());
    EXPECT_NE(error.reason().find(GetParam().named), std::string::npos) << error.reason();
  }
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

INSTANTIATE_TEST_SUITE_P(Kinds, CadRefusal, ::testing::ValuesIn(kLost),
                         [](const auto& lost) { return lost.param.name; });

}  // namespace
}  // namespace spherule::test::cad_refusal_test
