// SPDX-License-Identifier: BSD-3-Clause

// Is a mechanism free all along a straight motion of its variables? Parts of the motion are looked
// at in their middle, with every body grown by how far any of its points is from there anywhere in
// the part: if the grown bodies are apart from the obstacles, the part is free. Otherwise it is
// halved (edge_halving.h).
//
// By how much a body is grown. Let the variable of frame k change by at most D_k between the middle
// and any other point of the part, let p be a point of the body, and e_k how far p is at most from
// where it is in the middle, as seen from the parent of frame k; e is 0 beyond the last frame. In
// frame k, before its turn, p is at y and in the middle at y', |y - y'| <= e_{k+1}. A turn by up to
// D_k moves y by at most D_k times its distance from the axis, which is at most d_k + e_{k+1}, d_k
// being the distance of p from the axis of frame k in the middle. So
//     e_k <= e_{k+1} + D_k (d_k + e_{k+1}),      e_k <= e_{k+1} + D_k for a shift.
// For all points of the body, d_k is at most the distance of the centre of the ball around all from
// the axis, plus its radius.
//
// Rounding. The middle is computed with an error below 3 u (|from| + |to|) < 1e-13, which each D_k
// takes up, too. Of the chain of n frames, origins and centres err by less than 2.1e-11 n W each, W
// being how far the body reaches, and axes by 2.1e-11 n (mechanism_parts.cpp). With `tilt` = 1e-10
// (n + 1), four times as much, a point's offset from an axis errs by less than `tilt` W, and the
// difference of squares that gives its distance by less than 2 `tilt` of the offset's square for
// the axis and 1e-14 of it for rounding. The sums err by far less than kRelative.

#include "collide/edge_halving.h"
#include "collide/internal/mechanism_parts.h"
#include "collide/internal/single_precision.h"
#include "collide/mechanism_check.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace spherule {
namespace {

constexpr double kMiddleError = 1e-13;
constexpr double kRelative = 1e-6;

}  // namespace

// The motion as EdgeHalving asks for it.
class MechanismCheck::EdgeMotion {
 public:
  EdgeMotion(const Parts& parts, std::span<const double> from, std::span<const double> to,
             Scratch::Memory& memory, AskAt ask, void* context)
      : parts_(parts),
        from_(from),
        to_(to),
        memory_(memory),
        ask_(ask),
        context_(context),
        variables_(static_cast<std::size_t>(parts.problem.variable_count)) {
    memory_.changes.resize(variables_);
    for (std::size_t i = 0; i < variables_; ++i) {
      memory_.changes[i] = std::abs(to_[i] - from_[i]) * (1.0 + kRelative);
    }
  }

  void set(double at, std::uint64_t number) {
    for (std::size_t i = 0; i < variables_; ++i) {
      memory_.variables[i] = (1.0 - at) * from_[i] + at * to_[i];
    }
    number_ = number;
    is_placed_ = false;
  }

  PartFinding look(std::int32_t open, double half, double& growth) {
    if (!is_placed_) {
      parts_.kernels->place(parts_.problem, memory_.variables.data(), memory_.view);
      is_placed_ = true;
      grown_body_ = -1;
    }
    const internal::KernelPair pair = parts_.scene.pairs[static_cast<std::size_t>(open)];
    if (pair.body != grown_body_) {
      growth_ = growth_of(static_cast<std::size_t>(pair.body), half);
      grown_body_ = pair.body;
    }
    growth = growth_;
    switch (parts_.kernels->look(parts_.problem, pair, internal::rounded_up_to_single(growth_),
                                 memory_.view, &Translator::confirm, &translator_)) {
      case internal::KernelFinding::kApart:
        return PartFinding::kApart;
      case internal::KernelFinding::kTouch:
        return PartFinding::kTouch;
      default:
        return PartFinding::kNear;
    }
  }

  bool touches() {
    is_placed_ = false;
    return parts_.kernels->check(parts_.problem, memory_.variables.data(), 0.0F, 0.0F, memory_.view,
                                 &Translator::confirm, &translator_);
  }

 private:
  // An upper bound of how far any point of a body, as placed, is from there while no variable
  // changes by more than `half` of what it does in all.
  double growth_of(std::size_t index, double half) const {
    const internal::KernelBody& body = parts_.problem.bodies[index];
    const double tilt = parts_.tilt[index];
    const double error = tilt * parts_.reach[index];
    const auto& at = memory_.poses[static_cast<std::size_t>(body.frame)].columns;
    double center[3];
    for (int i = 0; i < 3; ++i) {
      center[i] = at[0][i] * body.center[0] + at[1][i] * body.center[1] +
                  at[2][i] * body.center[2] + at[3][i];
    }
    double moved = 0.0;
    for (std::int32_t f = body.frame; f >= 0;
         f = parts_.frames[static_cast<std::size_t>(f)].parent) {
      const internal::KernelFrame& frame = parts_.frames[static_cast<std::size_t>(f)];
      const auto& pose = memory_.poses[static_cast<std::size_t>(f)].columns;
      const double change =
          memory_.changes[static_cast<std::size_t>(frame.variable)] * half + kMiddleError;
      if (frame.prismatic) {
        moved += change;
        continue;
      }
      double squared = 0.0;
      double along = 0.0;
      for (int i = 0; i < 3; ++i) {
        const double offset = center[i] - pose[3][i];
        squared += offset * offset;
        along += offset * pose[2][i];
      }
      const double beside = std::max(0.0, squared - along * along) + (2.0 * tilt + 1e-14) * squared;
      moved += change * (std::sqrt(beside) + static_cast<double>(body.radius) + error + moved);
    }
    return moved * (1.0 + kRelative) + error;
  }

  // For the configuration that was set last.
  static bool ask_at(void* motion, int, const MechanismContact& contact) {
    const auto& self = *static_cast<const EdgeMotion*>(motion);
    return self.ask_(self.context_, self.number_,
                     std::span(self.memory_.variables).first(self.variables_), contact);
  }

  const Parts& parts_;
  std::span<const double> from_;
  std::span<const double> to_;
  Scratch::Memory& memory_;
  AskAt ask_;
  void* context_;
  std::size_t variables_;
  std::uint64_t number_ = 0;
  bool is_placed_ = false;  // whether the scratch holds the poses
  std::int32_t grown_body_ = -1;
  double growth_ = 0.0;
  Translator translator_{parts_.scene, &ask_at, this};
};

void require_resolution(double resolution) {
  if (!(resolution > 0.0)) throw Error("resolution", "it is not above zero");
}

EdgeResult MechanismCheck::check_edge(std::span<const double> from, std::span<const double> to,
                                      Scratch& scratch, const EdgeRequest& request, AskAt ask,
                                      void* context) const {
  assert(is_in_range(from) && is_in_range(to));
  require_own(scratch);
  require_resolution(request.resolution);
  Scratch::Memory& memory = *scratch.memory_;
  using Halving = EdgeHalving<EdgeMotion>;
  memory.open_pairs.resize(Halving::list_size(parts_->scene.pairs.size()));
  EdgeMotion motion(*parts_, from, to, memory, ask, context);
  return Halving(motion, memory.open_pairs, request).run();
}

}  // namespace spherule
