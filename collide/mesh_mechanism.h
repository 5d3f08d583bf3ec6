// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism_check.h"
#include "collide/mesh_tree.h"

#include <cstdint>
#include <memory>
#include <span>

namespace spherule {

// A mesh that is rigidly attached to a frame of a mechanism.
struct MechanismMesh {
  int frame = 0;
  Pose frame_from_mesh{};
  std::shared_ptr<const MeshTree> mesh;
};

// A sphere of an obstacle and a triangle of a body, in doubt.
struct MeshContactInDoubt {
  MechanismPair pair;
  std::int32_t sphere = 0;    // index into spheres() of the obstacle's tree
  std::int32_t triangle = 0;  // of the body's mesh
};

// MechanismCheck (collide/mechanism_check.h) for bodies that stay triangle meshes: for each
// configuration it finds either that no sphere of an obstacle meets a triangle of a body it is
// tested against, or that one does, for sure; where rounding leaves a doubt it asks. What is said
// there of poses and their error holds here, too; what it asks about is decided as by collides() of
// mesh_tree.h, and what it finds free or in contact without asking is so by that test. Proof in the
// .cpp. Immutable; threads may share it, each with a scratch of its own.
class MeshMechanismCheck {
 public:
  // Throws Error as MechanismCheck does.
  MeshMechanismCheck(std::span<const MechanismFrame> frames, std::span<const MechanismMesh> bodies,
                     std::span<const MechanismObstacle> obstacles,
                     std::span<const MechanismPair> pairs, double pose_error,
                     InstructionSet instructions = best_instruction_set());
  ~MeshMechanismCheck();
  MeshMechanismCheck(MeshMechanismCheck&&) noexcept;
  MeshMechanismCheck& operator=(MeshMechanismCheck&&) noexcept;

  // What a query writes to: made for one check; with that of another one every query throws Error.
  class Scratch {
   public:
    // For this check.
    explicit Scratch(const MeshMechanismCheck& check);
    ~Scratch();
    Scratch(Scratch&&) noexcept;
    Scratch& operator=(Scratch&&) noexcept;

   private:
    friend class MeshMechanismCheck;
    struct Memory;
    std::unique_ptr<Memory> memory_;
  };

  // True if a sphere meets a triangle of a pair for sure or `confirm`, given a MeshContactInDoubt,
  // says so of two that may; false if none do. MechanismCheck::is_in_range() must hold, for as many
  // variables as the frames name. Allocates nothing.
  template <class Confirm>
  bool collides(std::span<const double> variables, Scratch& scratch, Confirm confirm) const {
    const Ask ask = [](void* context, const MeshContactInDoubt& contact) -> bool {
      return (*static_cast<Confirm*>(context))(contact);
    };
    return collides(variables, scratch, ask, std::addressof(confirm));
  }

 private:
  using Ask = bool (*)(void* context, const MeshContactInDoubt& contact);
  bool collides(std::span<const double> variables, Scratch& scratch, Ask ask, void* context) const;

  struct Parts;
  struct Translator;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace spherule
