// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_mechanism.h"
#include "collide/robot/joint_positions.h"
#include "collide/robot/robot_model.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace spherule {

// A tree that stands still, in metres.
struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

// A link, with all of its meshes, and an obstacle that need not be tested, by their indices.
struct UntestedPair {
  int link = 0;
  std::size_t obstacle = 0;
};

// A mesh in the frame of a link, in metres.
struct LinkMesh {
  int link = 0;
  std::shared_ptr<const MeshTree> mesh;
};

// Where the robot stands, and which pairs are left out.
struct RobotMeshCheckerOptions {
  Pose world_from_root{};
  std::vector<UntestedPair> untested{};
  InstructionSet instructions = best_instruction_set();
};

// Does any mesh of a robot meet an obstacle that is made of spheres? For robots and tools that are
// not simplified among simplified obstacles. The trees of the robot's links are not looked at.
//
// The answer is exactly the one of collides() (mesh_tree.h) for each mesh and obstacle, under the
// poses that forward_kinematics() computes, and no instruction set changes it. A sphere wholly
// inside a mesh does not meet it. Links against each other are no matter of this class. Immutable,
// threads may share it, each with a scratch of its own.
class RobotMeshChecker {
 public:
  // Meshes are tested in their order. Throws Error for a missing mesh or tree, an index out of
  // range, a robot or obstacle that reaches beyond kMaxCoordinate, and instructions that this
  // machine has not got.
  RobotMeshChecker(RobotModel robot, std::vector<LinkMesh> meshes,
                   std::vector<PlacedTree> obstacles, const RobotMeshCheckerOptions& options = {});

  // What a query writes to: made for one checker, which must outlive its use; with that of another
  // one collides() throws Error. No query allocates once its scratch is warm.
  class Scratch {
   public:
    // For this checker.
    explicit Scratch(const RobotMeshChecker& checker)
        : check_(checker.check_), memory_(*check_), room_(checker.positions_.room_for(1)) {}

   private:
    friend class RobotMeshChecker;
    // Whose it is: kept, so that no later checker's is at its address.
    std::shared_ptr<const MeshMechanismCheck> check_;
    MeshMechanismCheck::Scratch memory_;
    std::vector<Pose> world_from_link_;
    JointPositions::Room room_;
  };

  // Throws Error for a configuration of the wrong size or with a number that is not finite.
  // Configurations with a joint's position beyond 100 (radians or metres) are answered as exactly,
  // but slowly; where such a one leads out of all bounds, forward_kinematics() throws.
  bool collides(std::span<const double> configuration, Scratch& scratch) const;

 private:
  struct Pair {
    std::size_t mesh;
    std::size_t obstacle;
  };

  bool meets(const Pair& pair, const std::vector<Pose>& world_from_link) const;

  RobotModel robot_;
  std::vector<LinkMesh> meshes_;
  std::vector<PlacedTree> obstacles_;
  Pose world_from_root_;
  JointPositions positions_;
  std::vector<Pair> pairs_;          // that are tested
  std::vector<std::size_t> moving_;  // the meshes that variables move
  bool always_ = false;              // a mesh that stands with the root meets an obstacle
  std::shared_ptr<const MeshMechanismCheck> check_;
};

}  // namespace spherule
