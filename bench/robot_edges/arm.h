// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A robot arm, the scenes that it moves in, and its moves.

#include "bench/checkers/workload.h"
#include "bench/studies/refined_cover.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "robot/check/robot_scene.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
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

// Another library's check of an arm's meshes in a scene, one configuration a call.
class ArmChecker {
 public:
  virtual ~ArmChecker() = default;
  virtual const char* name() const = 0;
  virtual bool collides(std::span<const double> configuration) = 0;
};

// What is tested: links with a mesh that a variable moves, against the scene; and pairs of links.
struct TestedLinks {
  std::vector<std::size_t> moving{};
  std::vector<std::pair<std::size_t, std::size_t>> pairs{};
};
TestedLinks tested_links(const Arm& arm, const AllowedCollisions& allowed);

struct Edge {
  Configuration from;
  Configuration to;
};

// Within the limits of the joints.
Configuration random_configuration(const RobotModel& robot, RandomNumbers& random);

// In the direction of another configuration, by up to 1.5 radians of the joint that turns most.
Edge random_edge(const RobotModel& robot, RandomNumbers& random);

// All configurations but the start, which is known to be free, with no more than `step` between
// neighbours in any joint: the end first and then halves of what is left, as planners take them
// (OMPL's DiscreteMotionValidator), so as to meet a contact early.
std::vector<Configuration> samples(const Edge& edge, double step);

struct PlacedPrimitive {
  std::string name;
  Primitive primitive;
  Pose world_from_primitive;
};

struct ArmScene {
  std::string name;
  std::vector<PlacedPrimitive> obstacles{};
  // Measured points, each with what is within cloud_radius of it, and a solid mesh, in the world.
  std::vector<Eigen::Vector3d> cloud{};
  double cloud_radius = 0.0;
  TriangleMesh mesh{};
};

// Seven scenes around an arm that stands at the origin and reaches 0.85 m, the like of those that
// planners are compared in. The same each time.
std::vector<ArmScene> primitive_scenes();

// So many boxes, cylinders and spheres about the arm.
ArmScene scene_of_primitives(std::size_t count);

// The surfaces of a few bodies about the arm, as about so many points, and as a solid mesh of about
// so many triangles.
ArmScene scene_of_points(std::size_t count);
ArmScene scene_of_triangles(std::size_t count);

// Fifty primitives, a cloud of 4,000 points and a solid mesh of 20,000 triangles.
std::vector<ArmScene> larger_scenes();

// The arm in a scene, as a RobotScene. What stands with the arm's root is not tested against the
// scene.
RobotScene robot_scene(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

}  // namespace spherule
