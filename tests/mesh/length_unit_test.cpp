// SPDX-License-Identifier: BSD-3-Clause
#include "io/length_unit.h"

#include "base/error.h"
#include "tests/mesh/mesh_files.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <utility>

namespace spherule::test {
namespace {

double in_millimetres(const std::string& text) {
  const std::optional<Length> length = parse_length(text);
  return length && length->unit != nullptr ? in_units_of(1000.0, *length) : -1.0;
}

TEST(LengthUnits, AreWrittenBehindTheNumber) {
  EXPECT_EQ(in_millimetres("1mm"), 1.0);
  EXPECT_EQ(in_millimetres("10cm"), 100.0);
  EXPECT_EQ(in_millimetres("0.5in"), 12.7);
  EXPECT_EQ(in_millimetres("0.5 inch"), 12.7);
  EXPECT_EQ(in_millimetres("1e-3m"), 1.0);
  EXPECT_EQ(in_millimetres("+2ft"), 609.6);
  EXPECT_EQ(in_millimetres("3MM"), 3.0);
  EXPECT_EQ(in_millimetres("7um"), 0.007);
  ASSERT_TRUE(parse_length("2.5"));
  EXPECT_EQ(parse_length("2.5")->value, 2.5);
  EXPECT_EQ(parse_length("2.5")->unit, nullptr);
  EXPECT_TRUE(std::isinf(parse_length("1e999mm")->value));
  for (const char* wrong : {"", "mm", "1 ", "1km", "1mm ", "1  mm", "1,5mm", "0x10mm", "1mm2"}) {
    EXPECT_FALSE(parse_length(wrong)) << wrong;
  }
}

// As each format has it.
TEST(LengthUnits, FilesStateTheirs) {
  const TempDir folder;
  const auto stated = [&](const std::string& ending, const std::string& bytes) {
    const std::filesystem::path path = folder.path() / ("part." + ending);
    std::ofstream(path, std::ios::binary) << bytes;
    return stated_unit(path);
  };
  const TriangleMesh mesh = cube_mesh();
  EXPECT_FALSE(stated("stl", text_stl(mesh)));
  EXPECT_FALSE(stated("obj", obj_text(mesh)));
  EXPECT_EQ(stated("glb", glb_bytes(mesh, {0, 0, 0}))->micrometres, 1e6);
  EXPECT_TRUE(stated("gltf", gltf_text(mesh, {0, 0, 0}))->by_format);
  const Eigen::Matrix4d unmoved = Eigen::Matrix4d::Identity();
  EXPECT_EQ(stated("dae", dae_text(mesh, unmoved, "0.0254"))->own_micrometres, 25400.0);
  EXPECT_EQ(stated("dae", dae_text(mesh, unmoved, "0.0254"))->micrometres, 1e6);
  std::string model = threemf_model(mesh);
  const std::size_t unit = model.find(" unit=\"");
  if (unit != std::string::npos) model.erase(unit, model.find('"', unit + 7) + 1 - unit);
  EXPECT_EQ(stated("3mf", threemf_bytes(model))->micrometres, 1000.0);
  const std::size_t root = model.find("<model") + 6;
  for (const auto& [name, size] :
       {std::pair{"micron", 1.0}, std::pair{"centimeter", 1e4}, std::pair{"inch", 25400.0},
        std::pair{"foot", 304800.0}, std::pair{"meter", 1e6}}) {
    std::string other = model;
    other.insert(root, std::string(" unit=\"") + name + "\"");
    EXPECT_EQ(stated("3mf", threemf_bytes(other))->micrometres, size) << name;
  }
  model.insert(root, " unit=\"cubit\"");
  EXPECT_THROW(stated("3mf", threemf_bytes(model)), Error);
  EXPECT_EQ(stated("step", "")->micrometres, 1000.0);
}

}  // namespace
}  // namespace spherule::test
