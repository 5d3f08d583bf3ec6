// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"
#include "robot/pairs/allowed_collisions.h"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace spherule {

// The arm's spheres without a hierarchy: all of each link against all obstacles, and all pairs of
// two links', behind a test of the spheres around links (and, for the points of a cloud, of each
// point). Double precision, in loops that compilers vectorise. Solid meshes are not queried.
class FlatArm {
 public:
  FlatArm(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

  bool collides(std::span<const double> configuration);

 private:
  // Coordinates and radii, in the link's frame or the world.
  struct Spheres {
    std::vector<double> x, y, z, radius;

    void add(const Sphere& sphere);
    std::size_t size() const { return x.size(); }
  };
  struct LinkSpheres {
    std::size_t link;
    bool moves;
    Spheres spheres;
    Sphere around;
  };

  static bool any_within(const Spheres& spheres, const Eigen::Vector3d& center, double radius);
  bool touches_obstacles(const Spheres& placed, const Sphere& around) const;

  const RobotModel& robot_;
  const ArmScene& scene_;
  std::vector<LinkSpheres> links_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // of links_
  Spheres cloud_;
  std::vector<Pose> poses_;
  std::vector<Spheres> placed_;
  std::vector<Sphere> around_;
};

}  // namespace spherule
