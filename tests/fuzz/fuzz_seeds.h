// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

// Small valid inputs of each target, made anew in every run (seeded).

namespace spherule::test {

std::vector<std::string> stl_seeds();
std::vector<std::string> obj_seeds();
std::vector<std::string> ply_seeds();
std::vector<std::string> off_seeds();
std::vector<std::string> threemf_seeds();
std::vector<std::string> threemf_model_seeds();
std::vector<std::string> dae_seeds();
std::vector<std::string> gltf_seeds();
std::vector<std::string> glb_seeds();

std::vector<std::string> sphere_file_seeds();
std::vector<std::string> tree_seeds();
std::vector<std::string> tree_content_seeds();
std::vector<std::string> zone_seeds();

std::vector<std::string> scene_seeds();
std::vector<std::string> trajectory_seeds();
std::vector<std::string> point_seeds();
std::vector<std::string> urdf_seeds();
std::vector<std::string> srdf_seeds();
std::vector<std::string> pair_seeds();
std::vector<std::string> pair_content_seeds();
std::vector<std::string> sphere_xml_seeds();
std::vector<std::string> sphere_yaml_seeds();
std::vector<std::string> sphere_json_seeds();
std::vector<std::string> bradshaw_seeds();

// Files of the user that spheres are written into.
std::vector<std::string> into_yaml_seeds();
std::vector<std::string> into_srdf_seeds();
std::vector<std::string> into_urdf_seeds();

}  // namespace spherule::test
