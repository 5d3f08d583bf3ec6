// SPDX-License-Identifier: BSD-3-Clause
// Small files that show their parts, or refer to their numbers, very many times. Each took minutes
// or gigabytes before it had a limit.
#include "io/placement.h"
#include "tests/mesh/mesh_files.h"
#include "tests/mesh/read_files.h"
#include "tests/mesh/scene_files.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <string>

namespace spherule::scene_limits_test {
namespace {

using test::replaced;

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

class SceneLimits : public test::ReadFiles {
 protected:
  // The cube as geometry #g; `nodes` stands in a library, `shown` in the scene.
  std::string collada(const std::string& nodes, const std::string& shown) const {
    const std::string text = replaced(test::dae_text(cube_, Eigen::Matrix4d::Identity()),
                                      "<instance_geometry url=\"#g\"/>", shown);
    return replaced(text, "<library_visual_scenes>",
                    "<library_nodes>" + nodes + "</library_nodes><library_visual_scenes>");
  }

  // A node that shows a node that shows ... each twice, and in the last one `leaf`.
  static std::string doubled(int levels, const std::string& leaf) {
    std::string nodes;
    for (int i = 0; i < levels; ++i) {
      const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
      nodes += "<node id=\"n" + std::to_string(i) + "\">" + next + next + "</node>";
    }
    return nodes + "<node id=\"n" + std::to_string(levels) + "\">" + leaf + "</node>";
  }

  // The cube under `chain` objects that move it, and `levels` that show the one before twice.
  std::string threemf(int chain, int levels) const {
    const std::string moved = R"( transform="1 0 0 0 1 0 0 0 1 0.5 0 0"/>)";
    std::string objects;
    int last = 1;
    for (int i = 0; i < chain + levels; ++i, ++last) {
      const std::string part = "<component objectid=\"" + std::to_string(last) + "\"" + moved;
      objects += "<object id=\"" + std::to_string(last + 1) + "\"><components>" + part +
                 (i < chain ? "" : part) + "</components></object>";
    }
    const std::string model =
        replaced(test::threemf_model(cube_), "</resources>", objects + "</resources>");
    return test::threemf_bytes(
        replaced(model, "<item objectid=\"1\"", "<item objectid=\"" + std::to_string(last) + "\""));
  }

  TriangleMesh cube_ = test::cube_mesh();
};

const std::string kMatrix = "<matrix>1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>";
const std::string kShown = "<instance_geometry url=\"#g\"/>";
const std::string kRoot = "<instance_node url=\"#n0\"/>";

TEST(SceneBudget, Counts) {
  const std::string file = "scene";
  internal::SceneBudget budget(file, 2);
  budget.take_steps(2);
  EXPECT_THROW(budget.take_steps(1), Error);
  TriangleMesh mesh;
  mesh.vertices.resize(1 << 20);
  for (int i = 0; i < 32; ++i) budget.take(mesh);
  EXPECT_THROW(budget.take(mesh), Error);
  budget.take_moves((1 << 20) - 1, 512);
  EXPECT_THROW(budget.take_moves(0, 1), Error);
  for (int i = 0; i < 1 << 18; ++i) budget.take_node();
  EXPECT_THROW(budget.take_node(), Error);
}

TEST_F(SceneLimits, ThreeMfComponents) {
  EXPECT_EQ(read("3mf", threemf(40, 10)).triangles.size(), 1024u * 12u);
  EXPECT_TRUE(refused("3mf", threemf(46, 18), "more than 2^18 nodes"));
}

TEST_F(SceneLimits, ThreeMfElements) {
  const std::string good = test::threemf_model(cube_);
  const auto with_metadata = [&](const std::string& text) {
    return test::threemf_bytes(replaced(good, "<build>", text + "<build>"));
  };
  EXPECT_EQ(
      read("3mf", with_metadata(repeated("<m>", 100) + repeated("</m>", 100))).triangles.size(),
      12u);
  EXPECT_TRUE(refused("3mf", with_metadata(repeated("<m>", 100000)), "nested too deep"));
}

TEST_F(SceneLimits, ColladaNodes) {
  const std::string leaf = repeated(kMatrix, 200) + kShown;
  EXPECT_EQ(read("dae", collada(doubled(10, leaf), kRoot)).triangles.size(), 1024u * 12u);
  EXPECT_TRUE(
      refused("dae", collada(doubled(17, repeated(kMatrix, 490)), kRoot), "too many times"));
  EXPECT_TRUE(
      refused("dae", collada(doubled(17, repeated("<extra/>", 10000)), kRoot), "too many times"));
  EXPECT_TRUE(
      refused("dae", collada(doubled(17, repeated("<!>", 10000)), kRoot), "too many times"));
}

TEST_F(SceneLimits, ColladaSourcesAndNames) {
  std::string geometries =
      "<geometry id=\"h\"><mesh><source id=\"t\"><float_array id=\"u\">" + repeated("0 ", 30000) +
      "</float_array><technique_common><accessor source=\"#u\" count=\"10000\" "
      "stride=\"3\"><param name=\"X\"/><param name=\"Y\"/><param name=\"Z\"/>"
      "</accessor></technique_common></source><vertices id=\"w\">"
      "<input semantic=\"POSITION\" source=\"#t\"/></vertices></mesh></geometry>";
  std::string shown;
  for (int i = 0; i < 800; ++i) {
    const std::string id = "h" + std::to_string(i);
    geometries += "<geometry id=\"" + id + "\"><mesh><vertices id=\"w" + id +
                  "\"><input semantic=\"POSITION\" source=\"#t\"/></vertices></mesh></geometry>";
    shown += "<instance_geometry url=\"#" + id + "\"/>";
  }
  const auto with_geometries = [&](const std::string& instances) {
    return replaced(collada("", instances + kShown), "<library_geometries>",
                    "<library_geometries>" + geometries);
  };
  EXPECT_EQ(read("dae", with_geometries("")).triangles.size(), 12u);
  EXPECT_TRUE(refused("dae", with_geometries(shown), "too many times"));

  const std::string name(60000, 'x');
  const std::string node = "<instance_node url=\"#" + name + "\"/>";
  EXPECT_TRUE(
      refused("dae", collada("<node id=\"" + name + "\"/>" + doubled(16, repeated(node, 8)), kRoot),
              "too many times"));
  std::string attributes;
  for (int i = 0; i < 257; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  EXPECT_TRUE(refused("dae", collada("<node" + attributes + "/>", kShown), "256 attributes"));
}

TEST_F(SceneLimits, GltfAccessors) {
  const std::string good = test::gltf_text(cube_, Eigen::Vector3d::Zero());
  const auto zeros = [&](const std::string& count) {
    return replaced(good, R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":8)",
                    R"({"componentType":5126,"type":"VEC3","count":)" + count +
                        R"(,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5125},)"
                        R"("values":{"bufferView":0}})");
  };
  EXPECT_EQ(read("gltf", zeros("8")).vertices.size(), 1u);  // all are at the same place
  EXPECT_TRUE(refused("gltf", zeros("5592406"), "more than 2^24 numbers"));
  const auto with_primitives = [&](const std::string& text, const std::string& primitive,
                                   int times) {
    return replaced(text, R"("primitives":[)", R"("primitives":[)" + repeated(primitive, times));
  };
  const std::string primitive = R"({"attributes":{"POSITION":0},"indices":1},)";
  EXPECT_EQ(read("gltf", with_primitives(good, primitive, 9)).triangles.size(), 120u);
  if (test::kSanitized) return;  // 16 million numbers
  EXPECT_TRUE(refused("gltf", with_primitives(zeros("5592405"), primitive, 9), "too many times"));
}

}  // namespace
}  // namespace spherule::scene_limits_test
