// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_contact.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace spherule {

// A robot whose links carry spheres that cover their collision meshes.
struct Arm {
  RobotModel model;
  std::vector<TriangleMesh> meshes;  // of each link, in its frame; empty for one without
  std::vector<std::shared_ptr<const CoveredMesh>> covers{};  // of those with spheres
  std::shared_ptr<const LinkPairs> pairs{};  // what is proved of them, by the meshes
  std::size_t triangles = 0;
  std::size_t spheres = 0;
};

// Every triangle is split at its longest edge until a sphere of `radius` (metres) holds the piece,
// and gets the spheres of its pieces: they contain the surface (it is the surfaces that FCL tests),
// protrude by no more than the radius, and are several times as many as a cover of the solid needs.
std::vector<Sphere> spheres_around(const TriangleMesh& mesh, double radius);

// Franka's Panda from a folder that holds robots/franka_panda. `cover` is either a spherized URDF,
// as `spherule robot` writes it, whose spheres its links carry; or the radius of spheres_around()
// its meshes. Throws Error if files are missing.
Arm make_panda(const std::filesystem::path& models, const std::string& cover);

// Which links of a Panda are not tested against each other: what is joined, and the two fingers;
// and what did not touch in a sample, too.
AllowedCollisions joined_contacts(const Arm& arm);
AllowedCollisions allowed_contacts(const Arm& arm);

}  // namespace spherule
