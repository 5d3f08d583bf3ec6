// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Scenes of a robot, with what is tested in them written down a second time: every pair of spheres
// in extended precision, under the poses of forward_kinematics(). Shares no code with the checker.

#include "geometry/triangle_mesh.h"
#include "robot/check/robot_scene.h"
#include "tests/support/random.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {

// Spheres that belong together: of a link, an attached object or an obstacle (link -1).
struct OracleBody {
  std::string name;
  int link = -1;
  Pose link_from_spheres;  // of an obstacle: world_from_spheres
  std::vector<std::vector<Sphere>> trees;
  long double padding = 0.0L;
};

struct OraclePair {
  std::size_t first = 0;
  std::size_t second = 0;
  long double padding = 0.0L;
  // Spheres of the first that are not tested.
  std::vector<BodySphere> left_out;
};

struct OracleScene {
  RobotModel robot;
  Pose world_from_root;
  std::vector<OracleBody> bodies;
  std::vector<OraclePair> pairs;  // that are tested

  // The smallest distance of any two spheres less their radii and padding; none if nothing is
  // tested. `nearest` is told which pair it is.
  std::optional<long double> gap(std::span<const double> configuration,
                                 std::size_t* nearest = nullptr) const;
  long double gap_of(const OraclePair& pair, std::span<const Pose> world_from_link) const;
};

// Whether a joint moves one link against the other.
bool moves_against(const RobotModel& robot, int first, int second);

// A random robot with links of random spheres, which stands among random trees, with or without
// attached objects, padding, regions and intended contacts.
struct RandomScene {
  RobotScene scene;
  OracleScene oracle;
};
RandomScene random_scene(Random& random);
// The same among solids and meshes of every kind, tiny and huge ones, of which the oracle is told
// nothing.
RandomScene scene_with_solids(Random& random);
constexpr int kMeshKinds = 8;
TriangleMesh mesh_of_kind(int kind);

}  // namespace spherule::test
