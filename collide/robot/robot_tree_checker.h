// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism_check.h"
#include "collide/mesh_contact.h"
#include "collide/robot/joint_positions.h"
#include "collide/robot/robot_contact.h"
#include "collide/robot/robot_model.h"
#include "spheretree/error.h"
#include "spheretree/pose.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule {

// A link, with all of its trees, and an obstacle that need not be tested, by their indices.
struct UntestedPair {
  int link = 0;
  std::size_t obstacle = 0;
};

// A tree that stands still, in metres.
struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

// How a RobotTreeChecker answers.
struct RobotTreeCheckerOptions {
  Pose world_from_root{};
  // Confirmation on the triangles (opt-in): contacts of two trees that are both the cover() of one
  // of these count only if their meshes touch (mesh_contact.h). Free stays certain; false alarms
  // vanish.
  std::vector<std::shared_ptr<const CoveredMesh>> meshes{};
  std::vector<UntestedPair> untested{};
  InstructionSet instructions = best_instruction_set();
};

// Does any link of a robot touch an obstacle? Made once for a robot and standing obstacles, then
// asked for many configurations.
//
// The answer is exactly the one of collides() for each link's trees and each obstacle, under the
// poses that forward_kinematics() computes, or of collides() of covered meshes where these are
// given; so G4 and G5 hold with respect to these poses, and no instruction set changes an answer.
// Links of the robot against each other are no matter of this class. It keeps the robot and the
// trees alive; immutable, threads may share it, each with a scratch of its own.
class RobotTreeChecker {
 public:
  // Throws Error for a missing tree, an index out of range, a robot or obstacle that reaches beyond
  // kMaxCoordinate from the world's origin or the robot's root, and instructions that this machine
  // has not got.
  RobotTreeChecker(RobotModel robot, std::vector<PlacedTree> obstacles,
                   const RobotTreeCheckerOptions& options = {});

 private:
  // A contact that was confirmed on triangles: of the body's mesh and the obstacle's.
  struct Touch {
    MechanismContact contact;
    TrianglePair triangles;
  };

 public:
  // The robot that is checked.
  const RobotModel& robot() const { return robot_; }

  // What a query writes to: made for one checker, which must outlive its use; with that of another
  // one every query throws Error. Unless it says so, no query allocates once its scratch is warm.
  // Those of several threads share no cache line.
  class alignas(64) Scratch {
   public:
    // For this checker.
    explicit Scratch(const RobotTreeChecker& checker)
        : check_(checker.check_),
          memory_(*check_),
          room_(checker.positions_.room_for(MechanismCheck::kBlock)) {}

   private:
    friend class RobotTreeChecker;
    // Whose it is: kept, so that no later checker's is at its address.
    std::shared_ptr<const MechanismCheck> check_;
    MechanismCheck::Scratch memory_;
    std::vector<Pose> world_from_link_;
    std::vector<MechanismPair> unconfirmed_;  // spheres touch, but no triangles do
    std::optional<Touch> last_;
    JointPositions::Room room_;
  };

  // Fastest where each configuration is near the one before: the scratch then knows how far the
  // robot was from everything, or how deep in it.
  // Throws Error for a configuration of the wrong size or with a number that is not finite.
  // Configurations with a joint's position beyond 100 (radians or metres) are answered as exactly,
  // but slowly; where such a one leads out of all bounds, forward_kinematics() throws.
  bool collides(std::span<const double> configuration, Scratch& scratch) const;

  // What touches what: a contact for each link and each obstacle that touch, of the link's trees
  // the one whose contact overlaps deepest; links from the last to the first, because the tool at
  // the end usually touches, for each the obstacles in their order. Empty exactly if collides()
  // says no, unless the request asks for none. Found anew for each configuration: what the scratch
  // remembers changes nothing. Allocates. Throws Error as collides() does.
  std::vector<RobotContact> explain(std::span<const double> configuration, Scratch& scratch,
                                    const ExplainRequest& request = {}) const;

  // Whether any link's spheres come within `clearance` (metres) of an obstacle's: exactly what
  // within() answers for the pairs that are tested, under the same poses; no meshes are asked.
  // Throws Error, too, as require_clearance() does.
  bool within(std::span<const double> configuration, double clearance, Scratch& scratch) const;

  // What collides() says of many configurations, which lie one behind the other: verdicts[i] is 1
  // if the i-th collides, otherwise 0. Several times faster where neighbours differ little, as on a
  // path. Throws Error if there are not variable_count() numbers for every verdict, or one is not
  // finite; then the verdicts mean nothing.
  void collides(std::span<const double> configurations, Scratch& scratch,
                std::span<std::uint8_t> verdicts) const;

  // The same on several threads, one for each scratch, of which the caller's is one: the same
  // verdicts, and the same Error, thrown once all have ended. Each thread takes kPiece neighbouring
  // configurations at a time; fewer than kFewestShared are left to the caller's thread. Throws
  // Error, too, if there is no scratch. Starting threads allocates.
  void collides(std::span<const double> configurations, std::span<Scratch> scratches,
                std::span<std::uint8_t> verdicts) const;

  // Whole blocks of MechanismCheck, and so many that what a scratch remembers is worth something.
  static constexpr std::size_t kPiece = 512;
  // To start and end a thread takes 40 to 75 us on a small cloud machine, a configuration of an
  // easy cell 41 ns: for as many as this the second thread saves what it costs; more, or slower
  // ones, gain.
  static constexpr std::size_t kFewestShared = 4096;

  // Whether the robot is free all along a straight motion in joint space, from one configuration to
  // another: proved at every point of it (G6), for the exact motion (of mimics, too) as for the
  // poses that forward_kinematics() computes for configurations on it. A contact that is found is
  // one for which collides() answers true; where meshes are given, a body inside another that
  // touches none of its triangles is not looked for: such a motion is kUnknown. Throws Error for
  // configurations as above, a position beyond 100 in magnitude, and a resolution that is not above
  // zero.
  EdgeResult check_edge(std::span<const double> from, std::span<const double> to, Scratch& scratch,
                        const EdgeRequest& request = {}) const;

 private:
  struct Body {
    std::shared_ptr<const SphereTree> tree;
    std::size_t link;
    std::size_t tree_index;  // among the link's
    const CoveredMesh* mesh;
    int frame = -1;  // of the check; -1: it stands with the root
    Pose frame_from_link{};
  };

  struct Standing {
    Body body;
    Pose world_from_link;
    std::size_t obstacle;
  };

  // A body and an obstacle that are tested against each other, moved or standing.
  struct TestedBody {
    const Body* body;
    std::size_t obstacle;
  };
  std::vector<TestedBody> tested_bodies() const;
  std::optional<Contact> contact_of(const TestedBody& tested, const Pose& world_from_link) const;

  void require_own(const Scratch& scratch) const {
    if (scratch.check_ != check_) throw Error("scratch", "it was made for another checker");
  }

  enum class Finding { kApart, kSpheres, kTouch };
  Finding find(const MechanismContact& contact, Scratch& scratch) const;
  bool touches_still(const Touch& touch, Scratch& scratch) const;
  double depth_of(const Touch& touch, const Scratch& scratch) const;
  void remember(const Touch& touch, double depth, Scratch& scratch) const;
  bool touches(std::span<const double> configuration, const MechanismContact& contact,
               bool& is_placed, Scratch& scratch) const;
  std::optional<std::span<const double>> usual_positions(std::span<const double> configuration,
                                                         Scratch& scratch,
                                                         std::size_t place = 0) const;
  bool contains_component(Scratch& scratch) const;
  const CoveredMesh* mesh_of(const SphereTree& tree) const;
  bool body_collides(const Body& body, const Pose& world_from_link, std::size_t obstacle) const;
  // What robot_collides() says of the pairs that are tested.
  bool collides_exactly(std::span<const double> configuration, Scratch& scratch) const;

  RobotModel robot_;
  std::vector<PlacedTree> obstacles_;
  Pose world_from_root_;
  std::vector<std::shared_ptr<const CoveredMesh>> meshes_;
  std::vector<const CoveredMesh*> obstacle_meshes_;
  JointPositions positions_;
  std::vector<Body> bodies_;  // that variables move, the last link first
  std::vector<MechanismPair> pairs_;
  std::vector<Standing> standing_;  // pairs that no variable moves
  double pose_error_ = 0.0;
  bool always_ = false;  // a link that stands with the root touches
  std::shared_ptr<const MechanismCheck> check_;
};

}  // namespace spherule
