// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_contact.h"
#include "collide/robot/robot_model.h"
#include "spheretree/triangle_mesh.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace spherule {

// A robot whose links carry spheres that cover their collision meshes.
struct Arm {
  RobotModel model;
  std::vector<TriangleMesh> meshes;  // of each link, in its frame; empty for one without
  std::vector<std::shared_ptr<const CoveredMesh>> covers{};  // of those with spheres
  std::size_t triangles = 0;
  std::size_t spheres = 0;
};

// Franka's Panda from a folder that holds robots/franka_panda. The spheres contain the surfaces:
// every triangle is split at its longest edge until a ball of `radius` (metres) holds the piece,
// and gets the balls of its pieces. They protrude by no more than the radius, and are several times
// as many as a cover of the solid needs; it is the surfaces that FCL tests. Throws Error if files
// are missing.
Arm make_panda(const std::filesystem::path& models, double radius);

// The same with the balls of a spherized URDF, as `spherule robot` writes it, for the same links.
Arm make_panda(const std::filesystem::path& models, const std::filesystem::path& spherized);

}  // namespace spherule
