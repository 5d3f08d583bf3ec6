// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Is a robot free of obstacles and of itself, in configurations and on motions?
//
// @code{.cpp}
// #include <spherule/robot/check/robot_checker.h>
// #include <spherule/robot/check/robot_scene.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{1, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// robot.attach("arm", sphere);
// spherule::RobotScene scene(robot);
// scene.add("post", sphere);
// const spherule::RobotChecker checker = scene.snapshot();
// spherule::RobotChecker::Scratch scratch(checker);
// const std::vector<double> left{-1.0}, right{1.0};
// assert(checker.check_config(left, scratch) && checker.check_config(right, scratch));
// const spherule::EdgeResult edge = checker.check_edge(left, right, scratch);
// assert(edge.verdict == spherule::Verdict::kCollision);  // the post is in between
// @endcode

#include "collide/contact.h"
#include "collide/search/instruction_set.h"
#include "collide/sweep.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule {

class CoveredMesh;

// How a RobotChecker answers.
struct RobotCheckerOptions {
  // A configuration with a joint outside its limits counts as a collision.
  bool enforce_limits = false;
  InstructionSet instructions = best_instruction_set();
  // Confirmation on the triangles (opt-in). It holds for each body or obstacle whose tree is the
  // same object as the cover() of one of these; an equal tree in another object is not recognised,
  // and a mesh without such a body is ignored. Such a body counts as its mesh with the inside
  // (mesh_contact.h), grown by the padding that is requested, against all that it is tested with: a
  // contact of its spheres counts only if the mesh touches, in configurations as on motions. Free
  // stays certain where the spheres cover the inside, too, as covers of the simplifier do; false
  // alarms of coarse covers vanish. Bodies of which a region may touch are judged by their spheres.
  std::vector<std::shared_ptr<const CoveredMesh>> meshes{};
};

// When an explanation may stop.
struct ExplainRequest {
  // At most so many entries are returned: contacts first, then what is proved free.
  std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
  // Tell, too, of spheres that overlap though their bodies are proved free of each other.
  bool proved_free = false;
};

// One side of a pair that is tested: a link, an attached object or an obstacle.
struct CheckedBody {
  // What the body is.
  enum class Kind { kLink, kAttached, kObstacle };
  Kind kind = Kind::kLink;
  std::string name;
  // The tree and sphere that touch, as BodySphere tells them; -1 for a mesh or a primitive.
  std::size_t tree = 0;
  std::int32_t sphere = -1;
};

// Two bodies, or a body and an obstacle, that touch.
struct CheckedContact {
  CheckedBody first;   // a body
  CheckedBody second;  // another, or an obstacle
  // How much is missing, at least, for the two named spheres (or the sphere and the solid) to keep
  // the padding that is requested; rounded downward. Below zero only by rounding.
  double overlap_depth = 0.0;
  double padding = 0.0;  // requested, of both bodies and the pair together; rounded upward
  Eigen::Vector3d world_point = Eigen::Vector3d::Zero();  // between the two, up to rounding
  // No contact: the spheres overlap, but the two bodies are proved free (RobotScene::reason()).
  bool is_proved_free = false;
};

// Of what a clearance is.
struct ClearanceRequest {
  // Pass over two bodies while they are proved free of each other (RobotScene::set_link_pairs()).
  // Their spheres may overlap there, and would leave a clearance of 0 that says nothing.
  bool skip_proved_free = false;
};

// How far a robot is from the nearest contact, between two bounds.
struct RobotClearance {
  // No two of the spheres and solids that are tested against each other come nearer than this to
  // touching, in exact arithmetic; 0 where they touch or nearly, and where a joint's position is
  // beyond kLargestJointPosition in magnitude, for which no error is known. Metres. Infinite if
  // nothing is tested, or all of it is passed over: then no distance is known.
  double lower = std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  // the nearest two are not further apart
  CheckedBody first;  // the pair that attains `upper`, empty names if nothing is tested
  CheckedBody second;
  bool skipped = false;  // some bodies were passed over, as requested: no bound is of these
};

// Is a robot free of obstacles and of itself? A snapshot of a RobotScene, immutable: threads may
// share it, each with a scratch of its own; a copy shares what the first one holds.
//
// "Free" means: no two spheres (padded as the scene says) of what is tested against each other
// overlap or touch, in exact arithmetic under the poses that forward_kinematics() computes (G4); a
// solid mesh or primitive is tested with its inside, and what is confirmed as its mesh. Two bodies
// that are proved free of each other (RobotScene::set_link_pairs()) are free of each other,
// whatever their spheres do: there the meshes are apart, of the exact mechanism. What is not free
// has a gap of rounding only (G5), collision_slack() for spheres.
//
// Configurations and motions are evaluated in single precision with proved margins, eight side by
// side; what these leave undecided is decided by the queries of the library in double precision:
// verdicts of configurations are the same on every instruction set. Of motions, what is proved and
// where a contact is found may differ by rounding and by what the scratch was queried before.
class RobotChecker {
 public:
  // Copies share what the first one holds.
  RobotChecker(const RobotChecker&) noexcept = default;
  // As the copy constructor.
  RobotChecker& operator=(const RobotChecker&) noexcept = default;

  // The robot that is checked.
  const RobotModel& robot() const;

  // What a query writes to: made for one snapshot and its copies; with that of another one every
  // query throws Error. Unless it says so, no query allocates
  // once its scratch is warm.
  class Scratch {
   public:
    // For this checker and its copies.
    explicit Scratch(const RobotChecker& checker);
    ~Scratch();
    Scratch(Scratch&&) noexcept;
    Scratch& operator=(Scratch&&) noexcept;

   private:
    friend class RobotChecker;
    struct Memory;
    std::unique_ptr<Memory> memory_;
  };

  // All throw Error for a configuration of the wrong size or with a number that is not finite.

  // Configurations with a joint's position beyond this in magnitude (radians or metres) are
  // answered as exactly, but slowly; where one leads out of all bounds, forward_kinematics()
  // throws. Motions do not start or end there.
  static constexpr double kLargestPosition = kLargestJointPosition;

  // True if the configuration is free: of obstacles and of itself, and within the limits if these
  // are enforced.
  bool check_config(std::span<const double> configuration, Scratch& scratch) const;

  // check_config() for many configurations, which lie one behind the other: free[i] is 1 if the
  // i-th is free, otherwise 0. Throws Error also if there are not variable_count() numbers for
  // every answer; after an Error the answers mean nothing.
  void check_configs(std::span<const double> configurations, Scratch& scratch,
                     std::span<std::uint8_t> free) const;
  // check_configs() on as many threads as oneTBB gives, at most one for each scratch: the
  // same answers, and the same Error. Throws Error, too, if there is no scratch. Allocates.
  void check_configs(std::span<const double> configurations, std::span<Scratch> scratches,
                     std::span<std::uint8_t> free) const;

  // Whether the straight motion in joint space is free at every point of it: proved (G6), for the
  // exact motion as for the poses that forward_kinematics() computes for configurations on it.
  // Continuous joints turn as the request says; by the shorter way, the exact motion is from `from`
  // by at most half a turn to the posture of `to`, and ShortestMotion has the configurations on it.
  // Where limits are enforced, leaving them is a contact, stated at the end that is outside of them
  // (contact_at is 0 or 1) unless bodies are found to touch before. Unless the first contact is
  // requested, free_until may be 0 where one is found. Throws Error also for a position beyond
  // kLargestPosition, at the end of the shorter way too, for a resolution that is not above zero,
  // and for the shorter way where ShortestMotion::require() does.
  EdgeResult check_edge(std::span<const double> from, std::span<const double> to, Scratch& scratch,
                        const EdgeRequest& request = {}) const;

  // check_edge() for many motions, each from from[i] to to[i], which lie one behind the other: the
  // edges of a path of n configurations are those from the first n - 1 to the last n - 1. At
  // most one thread for each scratch, as above.
  std::vector<EdgeResult> check_edges(std::span<const double> from, std::span<const double> to,
                                      std::span<Scratch> scratches,
                                      const EdgeRequest& request = {}) const;

  // How much of the motion is proved free: every point before this fraction is; 1 if all of it is,
  // its end, too. At most the fraction of the first contact. `resolution` and `continuous` as in
  // EdgeRequest.
  double measure_edge(std::span<const double> from, std::span<const double> to, Scratch& scratch,
                      double resolution = 1e-4,
                      ContinuousMotion continuous = ContinuousMotion::kAsGiven) const;

  // The configuration at a fraction of the motion that check_edge() proves, in [0, 1], rounded as
  // there: at EdgeResult::contact_at explain() names the bodies that touch, or none where only a
  // joint is outside of its limits. `continuous` as in EdgeRequest. Throws Error as check_edge(),
  // and for a fraction outside of [0, 1]. Allocates.
  std::vector<double> configuration_on_edge(
      std::span<const double> from, std::span<const double> to, double fraction,
      ContinuousMotion continuous = ContinuousMotion::kAsGiven) const;

  // Whether any two of the spheres and solids that are tested against each other come within
  // `clearance` (metres) of touching: never false if they do in exact arithmetic. Proofs of pairs
  // say nothing of clearances: their spheres are queried. Throws Error, too, as require_clearance()
  // does.
  bool within(std::span<const double> configuration, double clearance, Scratch& scratch) const;

  // How far the robot is from the nearest contact, and of which two: of the spheres, where contacts
  // are confirmed or, unless these are skipped, pairs proved free, too, so that `lower` holds for
  // the meshes. Allocates.
  RobotClearance clearance(std::span<const double> configuration, Scratch& scratch,
                           const ClearanceRequest& request = {}) const;

  // What touches what: one contact, the deepest, for each two bodies, and each body and obstacle,
  // that touch. Empty exactly if all are free of each other, unless what is proved free is
  // requested: the limits are not queried. Where a mesh confirms the contact of two bodies, the
  // spheres are the deepest two whose triangles touch if both are meshes without padding, otherwise
  // of all. Allocates.
  std::vector<CheckedContact> explain(std::span<const double> configuration, Scratch& scratch,
                                      const ExplainRequest& request = {}) const;

 private:
  friend class RobotScene;
  struct Parts;
  explicit RobotChecker(std::shared_ptr<const Parts> parts);

  void require_own(const Scratch& scratch) const;
  void require_end_of_edge(std::span<const double> configuration) const;
  // Where the motion that is meant ends: `to`, or what is written to `memory`. Throws Error for
  // ends that check_edge() refuses.
  std::span<const double> end_of_motion(std::span<const double> from, std::span<const double> to,
                                        ContinuousMotion continuous,
                                        std::vector<double>& memory) const;
  bool is_free_of_itself(std::span<const double> configuration, Scratch& scratch) const;
  EdgeResult check_within_limits(std::span<const double> from, std::span<const double> to,
                                 double end, Scratch& scratch, const EdgeRequest& request) const;
  // Of a pair: what is told of its two sides, and of the padding.
  CheckedBody body_of(int piece, std::int32_t sphere) const;
  CheckedBody other_of(std::size_t pair, std::int32_t sphere) const;
  double padding_of(std::size_t pair) const;

  std::shared_ptr<const Parts> parts_;
};

}  // namespace spherule
