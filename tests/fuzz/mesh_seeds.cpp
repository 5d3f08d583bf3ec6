// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/mesh/mesh_files.h"
#include "tests/mesh/scene_files.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

namespace spherule::test {
namespace {

const TriangleMesh& solid() {
  static const TriangleMesh mesh = cube_mesh();
  return mesh;
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

std::vector<std::string> dae_seeds() {
  Random random(1);
  std::vector<std::string> seeds = {dae_text(solid(), Eigen::Matrix4d::Identity()),
                                    skinned_dae(solid())};
  for (int i = 0; i < 4; ++i) seeds.push_back(random_dae(solid(), random));
  return seeds;
}

std::vector<std::string> gltf_seeds() {
  Random random(2);
  std::vector<std::string> seeds = {gltf_text(solid(), {1, 2, 3}), skinned_gltf(solid()),
                                    morphed_gltf(solid())};
  for (int i = 0; i < 4; ++i) seeds.push_back(random_gltf(solid(), random));
  return seeds;
}

std::vector<std::string> glb_seeds() {
  return {glb_bytes(solid(), {1, 2, 3})};
}

}  // namespace spherule::test
