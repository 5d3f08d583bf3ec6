// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A fast test of a jointed mechanism in single precision, before an exact one.
//
// @code{.cpp}
// #include <spherule/collide/mechanism/mechanism_check.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// #include <vector>
//
// const auto sphere = std::make_shared<const spherule::SphereTree>(
//     spherule::build_tree(std::vector<spherule::Sphere>{{{1, 0, 0}, 0.1}}));
// const std::vector<spherule::MechanismFrame> frames{{.parent = -1, .variable = 0}};
// const std::vector<spherule::MechanismBody> bodies{{.frame = 0, .tree = sphere}};
// const std::vector<spherule::MechanismObstacle> obstacles{{.tree = sphere}};
// const std::vector<spherule::MechanismPair> pairs{{.body = 0, .obstacle = 0}};
// const spherule::MechanismCheck check(frames, bodies, obstacles, pairs, 1e-9);
// spherule::MechanismCheck::Scratch scratch(check);
// const auto confirm = [](const spherule::MechanismContact&) { return true; };  // if in doubt
// assert(check.collides(std::vector{0.0}, scratch, confirm));
// assert(!check.collides(std::vector{1.0}, scratch, confirm));  // turned by 1 rad
// @endcode

#include "collide/search/instruction_set.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace spherule {

// A frame that a variable moves: at zero its pose in the parent frame is `parent_from_frame`; then
// it turns about its z axis by the variable (radians), or is shifted along it.
struct MechanismFrame {
  int parent = -1;  // an earlier frame, or -1 for the root
  Pose parent_from_frame{};
  int variable = 0;
  bool prismatic = false;
};

// Spheres that are rigidly attached to a frame.
struct MechanismBody {
  int frame = 0;
  Pose frame_from_tree{};
  std::shared_ptr<const SphereTree> tree;
};

// Spheres that stand still in the root's frame.
struct MechanismObstacle {
  Pose root_from_tree{};
  std::shared_ptr<const SphereTree> tree;
};

// A body that is tested against an obstacle, by their indices.
struct MechanismPair {
  int body = 0;
  int obstacle = 0;
};

// A contact of two spheres that is uncertain.
struct MechanismContact {
  MechanismPair pair;
  std::int32_t body_sphere = 0;  // indices into spheres() of the trees
  std::int32_t obstacle_sphere = 0;
};

// How a MechanismCheck answers.
struct MechanismCheckOptions {
  InstructionSet instructions = best_instruction_set();
  bool always_exact = false;  // no contact counts as sure: each is left to `confirm`
};

// Bodies of a jointed mechanism against obstacles that stand still, in single precision: a fast
// test before an exact one. For each configuration it finds either that no two spheres of a pair
// touch, or that some do, for sure; where rounding leaves that uncertain it calls `confirm`.
//
// Proof in mechanism/mechanism_check.cpp. Exactness is meant with respect to any poses of the
// bodies that are within `pose_error` of those of the exact mechanism: the largest distance of a
// point of the body, in the unit of the trees. Bodies on one frame, and obstacles, that are tested
// against the same are searched as one tree. Immutable; threads may share it, each with a scratch
// of its own.
class MechanismCheck {
 public:
  // Pairs are tested in their order, as far as bodies are not searched together. Throws Error for
  // indices out of range, a missing tree, a mechanism or obstacle that reaches beyond
  // kMaxCoordinate (joined with those that it is searched with, too), a pose_error that is no
  // length, or instructions that this machine has not got.
  MechanismCheck(std::span<const MechanismFrame> frames, std::span<const MechanismBody> bodies,
                 std::span<const MechanismObstacle> obstacles, std::span<const MechanismPair> pairs,
                 double pose_error, const MechanismCheckOptions& options = {});
  ~MechanismCheck();
  // Copies share what is held, and so do one and what was moved from it.
  MechanismCheck(const MechanismCheck&) noexcept;
  MechanismCheck& operator=(const MechanismCheck&) noexcept;

  // What a query writes to: made for one check and its copies; with that of another one, or
  // one whose content was moved away, every query throws Error.
  class Scratch {
   public:
    // For this check.
    explicit Scratch(const MechanismCheck& check);
    ~Scratch();
    Scratch(Scratch&&) noexcept;
    Scratch& operator=(Scratch&&) noexcept;

   private:
    friend class MechanismCheck;
    struct Memory;
    std::unique_ptr<Memory> memory_;
  };

  // The largest magnitude of a variable, in radians or the unit of the trees, for which collides()
  // may be called: all budgets of errors, those of the robot's motions too, are proved up to it.
  // Beyond what joints of robots do (16 turns, 100 metres), and so small that a position less its
  // whole turns is known to 2e-14 (kernel_vectors.h).
  static constexpr double kLargestVariable = 100.0;
  // Whether all variables are finite and none is larger than that in magnitude.
  static bool is_in_range(std::span<const double> variables);

  // True if two spheres of a pair touch for sure or `confirm`, given a MechanismContact, says so of
  // two that may; false if none do. is_in_range() must hold, for as many variables as the frames
  // name. The scratch remembers contacts and clearances from one configuration to the next, which
  // changes no answer: near the last ones it may answer without calling `confirm`. Allocates
  // nothing.
  template <class Confirm>
  bool collides(std::span<const double> variables, Scratch& scratch, Confirm confirm) const {
    const ConfirmFunction confirm_function = [](void* context, int,
                                                const MechanismContact& contact) -> bool {
      return (*static_cast<Confirm*>(context))(contact);
    };
    return collides(variables, scratch, confirm_function, std::addressof(confirm));
  }

  // Whether no two spheres of a pair touch for any variables on the straight motion from one
  // configuration to another, in exact arithmetic: true only if so, false where that is not known
  // soon. None where the motion does not follow in small steps the configuration or motion that was
  // checked last with the scratch, as those of a path do. is_in_range() must hold for both ends.
  // Allocates nothing.
  std::optional<bool> is_free_along(std::span<const double> from, std::span<const double> to,
                                    Scratch& scratch) const;

  // For `confirm` of collides() to say that a sphere (in the coordinates of a frame) touches an
  // obstacle, and would wherever none of its points has moved by more than `depth` from where the
  // exact mechanism has it. That is remembered, where it is worth while, for configurations near
  // this one; it changes no answer.
  void remember_contact(int frame, const Sphere& sphere, double depth, Scratch& scratch) const;
  // Whether it is worth while: the last configurations were near each other.
  bool is_following(const Scratch& scratch) const;

  // Configurations that are checked side by side; answers are bits, the first configuration's is
  // the lowest.
  static constexpr std::size_t kBlock = 16;
  // A bit for every configuration of a block.
  struct BlockAnswer {
    std::uint32_t collides;
    std::uint32_t out_of_range;  // is_in_range() does not hold: no answer
  };

  // Which configurations of a block collide; `confirm`, as collides() of one configuration calls
  // it, is given the configuration's index, too. Each pointer leads to as many variables as the
  // frames name. Fast where neighbours in the block differ little; the scratch remembers contacts
  // from block to block, which changes no answer. Allocates nothing.
  template <class Confirm>
  BlockAnswer collides(std::span<const double* const, kBlock> configurations, Scratch& scratch,
                       Confirm confirm) const {
    const ConfirmFunction confirm_function = [](void* context, int index,
                                                const MechanismContact& contact) -> bool {
      return (*static_cast<Confirm*>(context))(index, contact);
    };
    return collides(configurations, scratch, confirm_function, std::addressof(confirm));
  }

 private:
  using ConfirmFunction = bool (*)(void* context, int index, const MechanismContact& contact);
  bool collides(std::span<const double> variables, Scratch& scratch,
                ConfirmFunction confirm_function, void* context) const;
  BlockAnswer collides(std::span<const double* const, kBlock> configurations, Scratch& scratch,
                       ConfirmFunction confirm_function, void* context) const;

  void require_own(const Scratch& scratch) const;

  struct Parts;
  struct Translator;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace spherule
