// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "io/placement.h"
#include "tests/io/read_files.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// COLLADA and glTF: what they show and where, against assimp and by hand, and files that are broken
// or made to do harm.

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

class SceneFormats : public ReadFiles {
 protected:
  AlignedBox3d box(const std::string& extension, std::string_view bytes) {
    return mesh_report(read(extension, bytes)).box;
  }
};

TEST_F(SceneFormats, Collada) {
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  const std::string good = dae_text(cube_, identity);
  EXPECT_TRUE(mesh_report(read("dae", good)).closed);
  // Shown twice, once moved.
  const std::string twice =
      replaced(good, "</visual_scene>",
               "<node><translate>5 0 0</translate><instance_geometry url=\"#g\"/></node>"
               "</visual_scene>");
  EXPECT_EQ(mesh_report(read("dae", twice)).components, 2u);
  expect_refused("dae", good,
                 {{"<p>0 2 3", "<p>0 2 99", "dae"},
                  {"\">0 0 0 1 0", "\">nan 0 0 1 0", "not a finite"},
                  {"\">0 0 0 1 0", "\">1e999 0 0 1 0", "not a finite"},
                  {"\">0 0 0 1 0", "\">1e30 0 0 1 0", "beyond 1e15"},
                  {"<p>0 2 3", "<p>0 2 3.", "not a whole number"},
                  {"<p>0 2 3", "<p>0 -2 3", "vertex -2"},
                  {"<p>0 2 3", "<p>0 4294967298 3", "4294967298"},
                  {"<p>0 2 3", "<p>0 <b/>2 3", "between its numbers"},
                  {"<p>0 2 3", "<p>0 2", "count of triangles"}});
  EXPECT_TRUE(refused("dae", good.substr(0, good.size() / 2), "is not XML"));
  EXPECT_TRUE(
      refused("dae", "<COLLADA>\n<a>\n</COLLADA>", "line 2: is not XML: an element is not closed"));
  EXPECT_TRUE(
      refused("gltf", "{\"asset\": {}\n 1}", "line 2, column 2: is not JSON: unexpected number"));
  EXPECT_TRUE(refused("dae", "<html/>", "not COLLADA"));
  expect_refused("dae", good,
                 {{"<instance_geometry url=\"#g\"/>", "", "no triangles"},
                  {"url=\"#g\"", "url=\"other.dae#g\"", "in this file"},
                  {"url=\"#g\"", "url=\"#h\"", "not there"}});
  Eigen::Matrix4d projective = identity;
  projective(3, 0) = 0.5;
  EXPECT_TRUE(refused("dae", dae_text(cube_, projective), "affine"));
}

// Numbers become the nearest doubles.
TEST_F(SceneFormats, ColladaIsReadInDoublePrecision) {
  const std::string text = replaced(dae_text(cube_, Eigen::Matrix4d::Identity()), "\">0 0 0 1 0",
                                    "\">0.1234567890123456789 0 0 1 0");
  const TriangleMesh mesh = read("dae", text);
  const auto is_exact = [](const Vector3d& v) { return v.x() == 0.1234567890123456789; };
  EXPECT_TRUE(std::ranges::any_of(mesh.vertices, is_exact));
  EXPECT_LT(mesh.vertex_error, 1e-15);
}

TEST_F(SceneFormats, ColladaAccessorsStayWithinTheirArrays) {
  const std::string good = dae_text(cube_, Eigen::Matrix4d::Identity());
  const std::string accessor = "count=\"8\" stride=\"3\"";
  for (const char* broken :
       {"count=\"8\" stride=\"4\"", "count=\"9\" stride=\"3\"",
        "count=\"8\" stride=\"3\" offset=\"1\"", "count=\"8\" stride=\"4294967295\"",
        "count=\"8\" stride=\"3\" offset=\"4294967290\"", "count=\"4294967295\" stride=\"3\"",
        "count=\"8\" stride=\"2\"", "count=\"8\" stride=\"0\""}) {
    EXPECT_TRUE(refused("dae", replaced(good, accessor, broken), "reaches beyond")) << broken;
  }
  EXPECT_TRUE(
      refused("dae", replaced(good, accessor, "count=\"-8\" stride=\"3\""), "whole number"));
  expect_refused("dae", good, {{"count=\"24\"", "count=\"23\"", "as many numbers"}});
}

// An asset of a part would override the one of the document.
TEST_F(SceneFormats, ColladaOfSeveralUnitsIsRefused) {
  const std::string good = dae_text(cube_, Eigen::Matrix4d::Identity(), "0.01");
  const std::string why = "differs from that of the whole file";
  for (const std::string place :
       {"<library_geometries>", "<geometry id=\"g\">", "<library_visual_scenes>",
        "<visual_scene id=\"s\">", "<node id=\"n\">"}) {
    const auto with = [&](const std::string& stated) {
      return replaced(good, place, place + "<asset>" + stated + "</asset>");
    };
    EXPECT_EQ(error("dae", with("<created/>")), "");
    EXPECT_EQ(error("dae", with("<unit meter=\"1e-2\"/><up_axis> Z_UP </up_axis>")), "");
    EXPECT_TRUE(refused("dae", with("<unit meter=\"0.001\"/>"), "<unit> " + why)) << place;
    EXPECT_TRUE(refused("dae", with("<unit/>"), why)) << place;  // metres
    EXPECT_TRUE(refused("dae", with("<unit meter=\"x\"/>"), "no usable size")) << place;
    EXPECT_TRUE(refused("dae", with("<up_axis>Y_UP</up_axis>"), "<up_axis> " + why)) << place;
    EXPECT_EQ(error("dae", replaced(good, place,
                                    place + "<extra><asset><unit meter=\"3\"/></asset>"
                                            "</extra>")),
              "");
  }
  expect_refused("dae", good,
                 {{"<geometry id", "<asset>\n<unit/></asset><geometry id", "line 5: <unit>"}});
  // What a document does not state is one metre and Y_UP.
  const std::string bare = replaced(replaced(good, "<unit name=\"unit\" meter=\"0.01\"/>", ""),
                                    "<up_axis>Z_UP</up_axis>", "");
  const auto with = [&](const std::string& stated) {
    return replaced(bare, "<geometry id", "<asset>" + stated + "</asset><geometry id");
  };
  EXPECT_EQ(error("dae", with("<unit meter=\"1\"/><up_axis>Y_UP</up_axis>")), "");
  EXPECT_TRUE(refused("dae", with("<unit meter=\"0.01\"/>"), why));
  EXPECT_TRUE(refused("dae", with("<up_axis>Z_UP</up_axis>"), why));
}

// Data of other programs, comments, and the places of cameras.
TEST_F(SceneFormats, ColladaPassesOverWhatIsNoShape) {
  const std::string good = dae_text(cube_, Eigen::Matrix4d::Identity());
  const AlignedBox3d expected = box("dae", good);
  const std::string extra =
      "<extra><technique profile=\"p\" xmlns:a=\"u\"><a:b id=\"g\"/></technique></extra>";
  for (const std::string& text :
       {replaced(good, "</node>", extra + "</node>"),
        replaced(good, "<technique_common>",
                 "<technique profile=\"p\"><a:b/></technique>"
                 "<technique_common>"),
        replaced(good, "\">0 0 0 1 0", "\"><!-- c -->0 0 0 <!--\n9-->1<!-- --> 0"),
        replaced(good, "<p>0 2 3", "<p>0 2 <!-- 1 -->3"),
        replaced(good, "</visual_scene>",
                 "<node><lookat>0 0 1 0 0 0 0 1 0</lookat>"
                 "<instance_camera url=\"#c\"/></node></visual_scene>")}) {
    EXPECT_EQ(error("dae", text), "");
    EXPECT_TRUE(box("dae", text).isApprox(expected));
    EXPECT_EQ(read("dae", text).triangles.size(), 12u);
  }
  expect_refused("dae", good, {{"<mesh>", "<a:b/><mesh>", "prefix"}});
}

TEST_F(SceneFormats, ColladaRefusesWhatItCannotPlace) {
  const std::string good = dae_text(cube_, Eigen::Matrix4d::Identity());
  for (const char* transform :
       {"<skew>45 0 1 0 1 0 0</skew>", "<lookat>0 0 0 1 0 0 0 1 0</lookat>"}) {
    EXPECT_TRUE(refused(
        "dae", replaced(good, "<instance_geometry", std::string(transform) + "<instance_geometry"),
        "not supported"));
  }
  for (const char* shape : {"brep", "convex_mesh"}) {
    const std::string name = shape;
    EXPECT_TRUE(refused("dae", replaced(good, "<mesh>", "<" + name + "/><mesh>"), "not supported"));
  }
}

TEST_F(SceneFormats, Gltf) {
  const Vector3d shift(1, 2, 3);
  const std::string good = gltf_text(cube_, shift);
  EXPECT_EQ(box("gltf", good).min(), Vector3d(2, 4, 6));
  expect_refused("gltf", good,
                 {{"5126", "5123", "of the type"},
                  {"VEC3", "VEC2", "of the type"},
                  {"\"count\":8", "\"count\":7", "vertex 7"},
                  {"\"count\":8", "\"count\":9", "beyond its buffer"},
                  {"\"count\":36", "\"count\":35", "incomplete"},
                  {"\"count\":36", "\"count\":3600", "beyond"},
                  {"\"count\":36", "\"count\":-3", "whole number"},
                  {"[1]", "[0]", "two parents"},
                  {"[1]", "[7]", "not there"},
                  {"\"2.0\"", "\"1.0\"", "version 2"},
                  {"{\"mesh\":0,", "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],",
                   "a matrix beside"}});
  // Minor versions may be read as older ones unless the file says from which on.
  const auto with_version = [&](const std::string& version) {
    return replaced(good, "\"2.0\"", version);
  };
  EXPECT_EQ(error("gltf", with_version("\"2.1\"")), "");
  EXPECT_EQ(error("gltf", with_version(R"("2.1","minVersion":"2.0")")), "");
  EXPECT_TRUE(refused("gltf", with_version(R"("2.1","minVersion":"2.1")"), "version '2.1' of"));
  EXPECT_TRUE(refused("gltf", with_version(R"("2.0","minVersion":2)"), "is not a text"));
  // Names within an object are unique (the specification, "JSON Encoding").
  expect_refused("gltf", good,
                 {{"\"scene\":0", "\"scene\":0,\"scene\":0", "\"scene\" appears twice"}});
  const std::string deep = "\"extras\":" + std::string(300, '[') + std::string(300, ']') + ",";
  EXPECT_TRUE(refused("gltf", replaced(good, "\"scene\":0", deep + "\"scene\":0"), "too deeply"));
  expect_refused("gltf", good,
                 {{"\"scene\":0",
                   "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_"
                   "mesh_compression\"]",
                   "requires the extension"}});
  expect_refused("gltf", good,
                 {{"{\"mesh\":0,", "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{}},",
                   "EXT_mesh_gpu_instancing shows in many places"}});
  // Buffers outside the folder are not opened.
  for (const char* elsewhere : {"../", "/etc/", "file:///etc/", "%2e%2e/", "https://a/"}) {
    EXPECT_TRUE(refused("gltf", replaced(good, "data:application/octet-stream;base64,", elsewhere),
                        "in its folder"))
        << elsewhere;
  }
  expect_refused("gltf", good,
                 {{"base64,", "base64,*", "not base64"},
                  {"\"buffer\":0,\"byteOffset\":0", "\"buffer\":9", "not there"}});
  for (const char* place : {"\"byteOffset\":1", "\"byteOffset\":18446744073709551615",
                            "\"byteStride\":13,\"byteOffset\":0", "\"byteStride\":4"}) {
    EXPECT_TRUE(refused("gltf", replaced(good, "\"byteOffset\":0", place), "str") ||
                refused("gltf", replaced(good, "\"byteOffset\":0", place), "beyond") ||
                read("gltf", replaced(good, "\"byteOffset\":0", place)).triangles.size() == 12)
        << place;
  }

  const std::string glb = glb_bytes(cube_, shift);
  EXPECT_EQ(box("glb", glb).min(), Vector3d(2, 4, 6));
  EXPECT_TRUE(refused("glb", glb.substr(0, glb.size() - 1), "cut short"));
  EXPECT_TRUE(refused("glb", glb.substr(0, 15), "cut short"));
  expect_refused("glb", glb,
                 {{"\"scene\":", "\"asset\":", "in its JSON: the key \"asset\" appears twice"}});
}

TEST_F(SceneFormats, GltfNodesMayBeDeep) {
  std::string nodes = "\"nodes\":[";
  std::string moved = nodes;
  constexpr int kDepth = 20000;
  for (int i = 0; i < kDepth; ++i) {
    const std::string child = "\"children\":[" + std::to_string(i + 1) + "]},";
    nodes += "{" + child;
    moved += "{\"translation\":[1,0,0]," + child;
  }
  const std::string good = gltf_text(cube_, Vector3d::Zero());
  const std::size_t begin = good.find("\"nodes\":[{"), end = good.find("\"meshes\"");
  EXPECT_EQ(read("gltf", good.substr(0, begin) + nodes + "{\"mesh\":0}]," + good.substr(end))
                .triangles.size(),
            12u);
  EXPECT_TRUE(refused("gltf", good.substr(0, begin) + moved + "{\"mesh\":0}]," + good.substr(end),
                      "512 transforms"));
}

// A part of what is closed would be turned inside out.
TEST_F(SceneFormats, MirroredMeshesAreTurnedOver) {
  const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 2, 3, 1).asDiagonal();
  const std::string gltf = replaced(gltf_text(cube_, Vector3d(1, 2, 3)), "{\"mesh\":0,",
                                    "{\"mesh\":0,\"scale\":[-1,2,3],");
  const auto volume = [&](const std::string& extension, const std::string& bytes) {
    const MeshReport report = mesh_report(read(extension, bytes));
    EXPECT_EQ(report.inverted_components, 0U) << extension;
    return report.volume;
  };
  EXPECT_NEAR(volume("dae", dae_text(cube_, mirror)), 6.0, 1e-12);
  EXPECT_NEAR(volume("gltf", gltf), 6.0, 1e-12);
  EXPECT_NEAR(volume("3mf", threemf_bytes(threemf_model(cube_, "-1 0 0 0 2 0 0 0 3 0 0 0"))), 6.0,
              1e-12);
}

// The vertices of all triangles in an order of their own.
std::vector<Vector3d> corners_of(const TriangleMesh& mesh) {
  std::vector<Vector3d> corners;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int corner : t) corners.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
  }
  return corners;
}

std::vector<Vector3d> corners_by_assimp(const std::string& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene = importer.ReadFile(file, 0);
  if (scene == nullptr) throw Error(file, importer.GetErrorString());
  std::vector<Vector3d> corners;
  const std::function<void(const aiNode&, const aiMatrix4x4&)> visit = [&](const aiNode& node,
                                                                           const aiMatrix4x4& to) {
    const aiMatrix4x4 here = to * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene->mMeshes[node.mMeshes[i]];
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
          const aiVector3D v = here * mesh.mVertices[mesh.mFaces[f].mIndices[k]];
          corners.emplace_back(v.x, v.y, v.z);
        }
      }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], here);
  };
  visit(*scene->mRootNode, aiMatrix4x4());
  return corners;
}

// As far as single precision goes; each library has its own order of nodes.
void expect_same(std::vector<Vector3d> a, std::vector<Vector3d> b) {
  ASSERT_EQ(a.size(), b.size());
  double size = 0.0;
  for (const Vector3d& v : a) size = std::max(size, v.norm());
  std::size_t found = 0;
  for (const Vector3d& v : a) {
    const auto near =
        std::ranges::find_if(b, [&](const Vector3d& w) { return (v - w).norm() <= 1e-5 * size; });
    if (near == b.end()) continue;
    ++found;
    b.erase(near);
  }
  EXPECT_EQ(found, a.size());
}

TEST_F(SceneFormats, RandomScenesAreThoseOfAssimp) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    for (const bool is_collada : {true, false}) {
      const std::string bytes = is_collada ? random_dae(cube_, random) : random_gltf(cube_, random);
      const auto path = dir_.write(is_collada ? "a.dae" : "a.gltf", bytes);
      expect_same(corners_of(read_mesh(path)), corners_by_assimp(path.string()));
      if (HasFailure()) return;
    }
  }
}

// Small files that show their parts, or refer to their numbers, very many times. Each took minutes
// or gigabytes before it had a limit.

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

class SceneLimits : public ReadFiles {
 protected:
  // The cube as geometry #g; `nodes` stands in a library, `shown` in the scene.
  std::string collada(const std::string& nodes, const std::string& shown) const {
    const std::string text = replaced(dae_text(cube_, Eigen::Matrix4d::Identity()),
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

TEST_F(SceneLimits, ThreeMfElements) {
  const std::string good = threemf_model(cube_);
  const auto with_metadata = [&](const std::string& text, Zip form = Zip::kStored) {
    return threemf_bytes(replaced(good, "<build>", text + "<build>"), form);
  };
  EXPECT_EQ(read("3mf", with_metadata(repeated("<m>", 50) + repeated("</m>", 50))).triangles.size(),
            12u);
  EXPECT_TRUE(refused("3mf", with_metadata(repeated("<m>", 100000)), "nested too deep"));
  // As many in few bytes as a tree of them takes gigabytes for.
  const std::string many = repeated("<m/>", 1'500'000);
  EXPECT_TRUE(refused("3mf", with_metadata(many, Zip::kDeflated64), "too many tags"));
}

TEST_F(SceneLimits, ColladaNodes) {
  EXPECT_TRUE(refused("dae", collada(doubled(60, ""), kRoot + kShown), "more than 2^18 nodes"));
  const std::string cycle =
      R"(<node id="n0"><node id="b"><instance_node url="#n0"/></node></node>)";
  EXPECT_TRUE(refused("dae", collada(cycle, kRoot + kShown), "within itself"));
  const std::string deep = repeated("<node>", 20000) + kShown + repeated("</node>", 20000);
  EXPECT_TRUE(refused("dae", collada("", deep), "too deep"));
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
  const std::string good = gltf_text(cube_, Eigen::Vector3d::Zero());
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
  if (kSanitized) return;  // 16 million numbers
  EXPECT_TRUE(refused("gltf", with_primitives(zeros("5592405"), primitive, 9), "too many times"));
}

}  // namespace
}  // namespace spherule::test
