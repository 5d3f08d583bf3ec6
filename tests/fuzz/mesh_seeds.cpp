// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

namespace spherule::test {
namespace {

const TriangleMesh& solid() {
  static const TriangleMesh mesh = cube_mesh();
  return mesh;
}

// A strip of two triangles, one vertex moved by a sparse accessor, and two triangles in a fan.
std::string sparse_gltf() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5},
      {"attributes": {"POSITION": 0}, "indices": 1, "mode": 6}]}],
    "accessors": [{"componentType": 5126, "type": "VEC3", "count": 4, "sparse": {"count": 1,
        "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 1}}},
      {"bufferView": 2, "componentType": 5121, "type": "SCALAR", "count": 4}],
    "bufferViews": [{"buffer": 0, "byteLength": 1},
      {"buffer": 0, "byteOffset": 4, "byteLength": 12},
      {"buffer": 0, "byteOffset": 16, "byteLength": 4}],
    "buffers": [{"byteLength": 20, "uri":
      "data:application/octet-stream;base64,AgAAAAAAgD8AAABAAABAQAABAgM="}]})";
}

}  // namespace

std::vector<std::string> stl_seeds() {
  return {binary_stl(solid()), text_stl(solid())};
}

std::vector<std::string> obj_seeds() {
  return {obj_text(solid()), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1//1 2/1/1 3/2 -1\n"};
}

std::vector<std::string> ply_seeds() {
  return {ply_bytes(solid(), PlyForm::kText, true), ply_bytes(solid(), PlyForm::kBigEndian, false),
          ply_bytes(solid(), PlyForm::kLittleEndian, true)};
}

std::vector<std::string> off_seeds() {
  return {off_text(solid())};
}

std::vector<std::string> threemf_seeds() {
  const std::string model = threemf_model(solid(), "1 0 0 0 1 0 0 0 1 10 20 30");
  return {threemf_bytes(model), threemf_bytes(model, Zip::kDeflated64)};
}

std::vector<std::string> threemf_model_seeds() {
  const std::string model = threemf_model(solid(), "1 0 0 0 1 0 0 0 1 10 20 30");
  const std::string end = "</resources>";
  std::string assembled = model;
  assembled.replace(
      assembled.find(end), end.size(),
      R"(<object id="2" type="model"><metadatagroup><metadata name="n">v</metadata></metadatagroup>)"
      R"(<components><component objectid="1"/>)"
      R"(<component objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 0 0"/></components></object>)"
      R"(<object id="3"><components><component objectid="2" transform="2 0 0 0 2 0 0 0 2 0 0 1"/>)"
      R"(<component objectid="2"/></components></object></resources>)");
  const std::string item = R"(<build><item objectid="3"/>)";
  assembled.replace(assembled.find("<build>"), std::string("<build>").size(), item);
  return {model, assembled};
}

std::vector<std::string> dae_seeds() {
  Random random(1);
  std::vector<std::string> seeds = {dae_text(solid(), Eigen::Matrix4d::Identity())};
  for (int i = 0; i < 4; ++i) seeds.push_back(random_dae(solid(), random));
  return seeds;
}

std::vector<std::string> gltf_seeds() {
  Random random(2);
  std::vector<std::string> seeds = {gltf_text(solid(), {1, 2, 3}), sparse_gltf()};
  for (int i = 0; i < 4; ++i) seeds.push_back(random_gltf(solid(), random));
  return seeds;
}

std::vector<std::string> glb_seeds() {
  return {glb_bytes(solid(), {1, 2, 3})};
}

}  // namespace spherule::test
