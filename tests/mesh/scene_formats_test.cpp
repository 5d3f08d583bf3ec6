// SPDX-License-Identifier: BSD-3-Clause
// COLLADA and glTF: what they show and where, against assimp and by hand, and files that are broken
// or made to do harm.
#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/mesh/mesh_files.h"
#include "tests/mesh/read_files.h"
#include "tests/mesh/scene_files.h"
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

namespace spherule::scene_formats_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

class SceneFormats : public test::ReadFiles {
 protected:
  AlignedBox3d box(const std::string& extension, std::string_view bytes) {
    return mesh_report(read(extension, bytes)).box;
  }

  TriangleMesh cube_ = test::cube_mesh();
};

using test::replaced;

TEST_F(SceneFormats, Collada) {
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  const std::string good = test::dae_text(cube_, identity);
  EXPECT_TRUE(mesh_report(read("dae", good)).closed);
  // Shown twice, once moved.
  const std::string twice =
      replaced(good, "</visual_scene>",
               "<node><translate>5 0 0</translate><instance_geometry url=\"#g\"/></node>"
               "</visual_scene>");
  EXPECT_EQ(mesh_report(read("dae", twice)).components, 2u);
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 2 99"), "dae"));
  EXPECT_TRUE(refused("dae", replaced(good, "\">0 0 0 1 0", "\">nan 0 0 1 0"), "not a finite"));
  EXPECT_TRUE(refused("dae", replaced(good, "\">0 0 0 1 0", "\">1e999 0 0 1 0"), "not a finite"));
  EXPECT_TRUE(refused("dae", replaced(good, "\">0 0 0 1 0", "\">1e30 0 0 1 0"), "beyond 1e15"));
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 2 3."), "not a whole number"));
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 -2 3"), "vertex -2"));
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 4294967298 3"), "4294967298"));
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 <b/>2 3"), "between its numbers"));
  EXPECT_TRUE(refused("dae", replaced(good, "<p>0 2 3", "<p>0 2"), "count of triangles"));
  EXPECT_TRUE(refused("dae", good.substr(0, good.size() / 2), "is not XML"));
  EXPECT_TRUE(
      refused("dae", "<COLLADA>\n<a>\n</COLLADA>", "line 2: is not XML: an element is not closed"));
  EXPECT_TRUE(
      refused("gltf", "{\"asset\": {}\n 1}", "line 2, column 2: is not JSON: unexpected number"));
  EXPECT_TRUE(refused("dae", "<html/>", "not COLLADA"));
  EXPECT_TRUE(
      refused("dae", replaced(good, "<instance_geometry url=\"#g\"/>", ""), "no triangles"));
  EXPECT_TRUE(refused("dae", replaced(good, "url=\"#g\"", "url=\"other.dae#g\""), "in this file"));
  EXPECT_TRUE(refused("dae", replaced(good, "url=\"#g\"", "url=\"#h\""), "not there"));
  Eigen::Matrix4d projective = identity;
  projective(3, 0) = 0.5;
  EXPECT_TRUE(refused("dae", test::dae_text(cube_, projective), "affine"));
}

// Numbers become the nearest doubles.
TEST_F(SceneFormats, ColladaIsReadInDoublePrecision) {
  const std::string text = replaced(test::dae_text(cube_, Eigen::Matrix4d::Identity()),
                                    "\">0 0 0 1 0", "\">0.1234567890123456789 0 0 1 0");
  const TriangleMesh mesh = read("dae", text);
  const auto is_exact = [](const Vector3d& v) { return v.x() == 0.1234567890123456789; };
  EXPECT_TRUE(std::ranges::any_of(mesh.vertices, is_exact));
  EXPECT_LT(mesh.vertex_error, 1e-15);
}

TEST_F(SceneFormats, ColladaAccessorsStayWithinTheirArrays) {
  const std::string good = test::dae_text(cube_, Eigen::Matrix4d::Identity());
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
  EXPECT_TRUE(refused("dae", replaced(good, "count=\"24\"", "count=\"23\""), "as many numbers"));
}

// A node that shows a node that shows ... each twice: 2^60 cubes from sixty nodes.
TEST_F(SceneFormats, ColladaNodesEndSomewhere) {
  const std::string good = test::dae_text(cube_, Eigen::Matrix4d::Identity());
  std::string bomb = "<library_nodes>";
  for (int i = 0; i < 60; ++i) {
    const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
    bomb += "<node id=\"n" + std::to_string(i) + "\">" + next + next + "</node>";
  }
  bomb += "<node id=\"n60\"/></library_nodes><library_visual_scenes>";
  const std::string shown = "<instance_node url=\"#n0\"/><instance_geometry";
  EXPECT_TRUE(refused(
      "dae", replaced(replaced(good, "<library_visual_scenes>", bomb), "<instance_geometry", shown),
      "more than 2^18 nodes"));
  const std::string cycle =
      "<library_nodes><node id=\"a\"><node id=\"b\"><instance_node url=\"#a\"/></node></node>"
      "</library_nodes><library_visual_scenes>";
  EXPECT_TRUE(
      refused("dae",
              replaced(replaced(good, "<library_visual_scenes>", cycle), "<instance_geometry",
                       "<instance_node url=\"#a\"/><instance_geometry"),
              "within itself"));
  std::string deep, shut;
  for (int i = 0; i < 20000; ++i) {
    deep += "<node>";
    shut += "</node>";
  }
  EXPECT_TRUE(refused("dae",
                      replaced(good, "<instance_geometry url=\"#g\"/>",
                               deep + "<instance_geometry url=\"#g\"/>" + shut),
                      "too deep"));
}

// An asset of a part would override the one of the document.
TEST_F(SceneFormats, ColladaOfSeveralUnitsIsRefused) {
  const std::string good = test::dae_text(cube_, Eigen::Matrix4d::Identity(), "0.01");
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
  EXPECT_TRUE(refused("dae", replaced(good, "<geometry id", "<asset>\n<unit/></asset><geometry id"),
                      "line 5: <unit>"));
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
  const std::string good = test::dae_text(cube_, Eigen::Matrix4d::Identity());
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
  EXPECT_TRUE(refused("dae", replaced(good, "<mesh>", "<a:b/><mesh>"), "prefix"));
}

TEST_F(SceneFormats, ColladaRefusesWhatItCannotPlace) {
  const std::string good = test::dae_text(cube_, Eigen::Matrix4d::Identity());
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

TEST_F(SceneFormats, SkinsAndMorphTargetsAreRefused) {
  EXPECT_TRUE(refused("dae", test::skinned_dae(cube_), "a skin or morph targets"));
  EXPECT_TRUE(refused("gltf", test::skinned_gltf(cube_), "a mesh with a skin"));
  EXPECT_TRUE(refused("gltf", test::morphed_gltf(cube_), "a mesh with morph targets"));
}

TEST_F(SceneFormats, XmlInUtf16IsRefused) {
  EXPECT_TRUE(refused("dae", std::string("\xFF\xFE<\0C\0", 6), "UTF-16 is not supported"));
  EXPECT_TRUE(refused("dae", std::string("\0<\0C", 4), "UTF-16 is not supported"));
}

TEST_F(SceneFormats, Gltf) {
  const Vector3d shift(1, 2, 3);
  const std::string good = test::gltf_text(cube_, shift);
  EXPECT_EQ(box("gltf", good).min(), Vector3d(2, 4, 6));
  EXPECT_TRUE(refused("gltf", replaced(good, "5126", "5123"), "of the type"));
  EXPECT_TRUE(refused("gltf", replaced(good, "VEC3", "VEC2"), "of the type"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"count\":8", "\"count\":7"), "vertex 7"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"count\":8", "\"count\":9"), "beyond its buffer"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"count\":36", "\"count\":35"), "incomplete"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"count\":36", "\"count\":3600"), "beyond"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"count\":36", "\"count\":-3"), "whole number"));
  EXPECT_TRUE(refused("gltf", replaced(good, "[1]", "[0]"), "two parents"));
  EXPECT_TRUE(refused("gltf", replaced(good, "[1]", "[7]"), "not there"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"2.0\"", "\"1.0\""), "version 2"));
  EXPECT_TRUE(refused(
      "gltf",
      replaced(good, "{\"mesh\":0,", "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"),
      "a matrix beside"));
  // Minor versions may be read as older ones unless the file says from which on.
  const auto with_version = [&](const std::string& version) {
    return replaced(good, "\"2.0\"", version);
  };
  EXPECT_EQ(error("gltf", with_version("\"2.1\"")), "");
  EXPECT_EQ(error("gltf", with_version(R"("2.1","minVersion":"2.0")")), "");
  EXPECT_TRUE(refused("gltf", with_version(R"("2.1","minVersion":"2.1")"), "version '2.1' of"));
  EXPECT_TRUE(refused("gltf", with_version(R"("2.0","minVersion":2)"), "is not a text"));
  // Names within an object are unique (the specification, "JSON Encoding").
  EXPECT_TRUE(refused("gltf", replaced(good, "\"scene\":0", "\"scene\":0,\"scene\":0"),
                      "\"scene\" appears twice"));
  const std::string deep = "\"extras\":" + std::string(300, '[') + std::string(300, ']') + ",";
  EXPECT_TRUE(refused("gltf", replaced(good, "\"scene\":0", deep + "\"scene\":0"), "too deeply"));
  EXPECT_TRUE(refused("gltf",
                      replaced(good, "\"scene\":0",
                               "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_"
                               "mesh_compression\"]"),
                      "requires the extension"));
  // Buffers outside the folder are not opened.
  for (const char* elsewhere : {"../", "/etc/", "file:///etc/", "%2e%2e/", "https://a/"}) {
    EXPECT_TRUE(refused("gltf", replaced(good, "data:application/octet-stream;base64,", elsewhere),
                        "in its folder"))
        << elsewhere;
  }
  EXPECT_TRUE(refused("gltf", replaced(good, "base64,", "base64,*"), "not base64"));
  EXPECT_TRUE(refused("gltf", replaced(good, "\"buffer\":0,\"byteOffset\":0", "\"buffer\":9"),
                      "not there"));
  for (const char* place : {"\"byteOffset\":1", "\"byteOffset\":18446744073709551615",
                            "\"byteStride\":13,\"byteOffset\":0", "\"byteStride\":4"}) {
    EXPECT_TRUE(refused("gltf", replaced(good, "\"byteOffset\":0", place), "str") ||
                refused("gltf", replaced(good, "\"byteOffset\":0", place), "beyond") ||
                read("gltf", replaced(good, "\"byteOffset\":0", place)).triangles.size() == 12)
        << place;
  }

  const std::string glb = test::glb_bytes(cube_, shift);
  EXPECT_EQ(box("glb", glb).min(), Vector3d(2, 4, 6));
  EXPECT_TRUE(refused("glb", glb.substr(0, glb.size() - 1), "cut short"));
  EXPECT_TRUE(refused("glb", glb.substr(0, 15), "cut short"));
  EXPECT_TRUE(refused("glb", replaced(glb, "\"scene\":", "\"asset\":"),
                      "in its JSON: the key \"asset\" appears twice"));
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
  const std::string good = test::gltf_text(cube_, Vector3d::Zero());
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
  const std::string gltf = replaced(test::gltf_text(cube_, Vector3d(1, 2, 3)), "{\"mesh\":0,",
                                    "{\"mesh\":0,\"scale\":[-1,2,3],");
  const auto volume = [&](const std::string& extension, const std::string& bytes) {
    return mesh_report(read(extension, bytes)).volume;
  };
  EXPECT_NEAR(volume("dae", test::dae_text(cube_, mirror)), 6.0, 1e-12);
  EXPECT_NEAR(volume("gltf", gltf), 6.0, 1e-12);
  EXPECT_NEAR(
      volume("3mf", test::threemf_bytes(test::threemf_model(cube_, "-1 0 0 0 2 0 0 0 3 0 0 0"))),
      6.0, 1e-12);
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
  test::Random random(5);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    for (const bool is_collada : {true, false}) {
      const std::string bytes =
          is_collada ? test::random_dae(cube_, random) : test::random_gltf(cube_, random);
      const auto path = dir_.write(is_collada ? "a.dae" : "a.gltf", bytes);
      expect_same(corners_of(read_mesh(path)), corners_by_assimp(path.string()));
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace spherule::scene_formats_test
