// SPDX-License-Identifier: BSD-3-Clause

// Is a mechanism free all along a straight motion of its variables? Parts of the motion are looked
// at in their middle, with every body grown by how far any of its points is from there anywhere in
// the part: if the grown bodies are apart from the obstacles, the part is free. Otherwise it is
// halved, and only pairs that were not apart are looked at again; the left half first, so that what
// is proved is always one piece from the start.
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

#include "collide/internal/mechanism_parts.h"
#include "collide/internal/single_precision.h"
#include "collide/mechanism_check.h"
#include "spheretree/error.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace spherule {
namespace {

constexpr double kMiddleError = 1e-13;
constexpr double kRelative = 1e-6;

// No part is halved more often than this: then it is shorter than what double tells apart near one.
constexpr std::size_t kDeepest = 64;

// A part of the motion, and the pairs that may touch in it: those from `first_pair` on in the list.
struct Part {
  double begin;
  double end;
  std::size_t depth;  // halvings
  std::size_t first_pair;
  std::size_t end_pair;
};

}  // namespace

class MechanismCheck::EdgeSearch {
 public:
  EdgeSearch(const Parts& parts, std::span<const double> from, std::span<const double> to,
             Scratch::Memory& memory, const EdgeRequest& request, AskAt ask, void* context)
      : parts_(parts),
        from_(from),
        to_(to),
        memory_(memory),
        request_(request),
        ask_(ask),
        context_(context),
        variables_(static_cast<std::size_t>(parts.problem.variable_count)) {
    memory_.changes.resize(variables_);
    for (std::size_t i = 0; i < variables_; ++i) {
      memory_.changes[i] = std::abs(to_[i] - from_[i]) * (1.0 + kRelative);
    }
    // A list of as many pairs as there are for each depth, and one for what the deepest leaves.
    memory_.open_pairs.resize(parts_.scene.pairs.size() * (kDeepest + 2));
  }

  EdgeResult run() {
    const std::size_t pairs = parts_.scene.pairs.size();
    for (std::size_t i = 0; i < pairs; ++i) {
      memory_.open_pairs[i] = static_cast<std::int32_t>(i);
    }
    std::array<Part, kDeepest + 2> waiting;  // one for each depth, and two of the deepest
    std::size_t top = 0;
    waiting[top++] = {0.0, 1.0, 0, 0, pairs};
    while (top > 0) {
      const Part part = waiting[--top];
      if (part.begin >= result_.contact_at) break;  // only what is before a contact matters
      if (is_spent()) return concluded(Verdict::kUnknown);
      const Look look = look_at(part);
      if (look.end_pair == part.end_pair) {
        result_.free_until = part.end;
        continue;
      }
      const double middle = middle_of(part);
      if (result_.contact_at <= middle && !request_.first) break;
      const bool is_last = look.growth <= 0.5 * request_.resolution || part.depth == kDeepest ||
                           !(part.begin < middle && middle < part.end);
      if (is_last) return unresolved(part);
      waiting[top++] = {middle, part.end, part.depth + 1, part.end_pair, look.end_pair};
      waiting[top++] = {part.begin, middle, part.depth + 1, part.end_pair, look.end_pair};
    }
    return concluded(Verdict::kFree);
  }

 private:
  // What is left of a part: its pairs from end_pair of the part to `end_pair`.
  struct Look {
    std::size_t end_pair;
    double growth;  // the largest of any body left
  };

  static double middle_of(const Part& part) { return 0.5 * part.begin + 0.5 * part.end; }

  void set(double at) {
    for (std::size_t i = 0; i < variables_; ++i) {
      memory_.variables[i] = (1.0 - at) * from_[i] + at * to_[i];
    }
    ++result_.configurations;
  }

  Look look_at(const Part& part) {
    const double middle = middle_of(part);
    const double half = 0.5 * (part.end - part.begin);
    set(middle);
    parts_.kernels->place(parts_.problem, memory_.variables.data(), memory_.view);
    Look look{part.end_pair, 0.0};
    std::int32_t grown_body = -1;
    double growth = 0.0;
    for (std::size_t i = part.first_pair; i < part.end_pair; ++i) {
      const internal::KernelPair pair =
          parts_.scene.pairs[static_cast<std::size_t>(memory_.open_pairs[i])];
      if (pair.body != grown_body) {
        growth = growth_of(static_cast<std::size_t>(pair.body), half);
        grown_body = pair.body;
      }
      const internal::KernelFinding finding =
          parts_.kernels->look(parts_.problem, pair, internal::rounded_up_to_single(growth),
                               memory_.view, &Translator::confirm, &translator_);
      if (finding == internal::KernelFinding::kApart) continue;
      if (finding == internal::KernelFinding::kTouch) {
        result_.contact_at = std::min(result_.contact_at, middle);
      }
      memory_.open_pairs[look.end_pair++] = memory_.open_pairs[i];
      look.growth = std::max(look.growth, growth);
    }
    return look;
  }

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

  // The part cannot be proved free, and is not halved. The contact that it comes close to is likely
  // to be in it, or soon after.
  EdgeResult unresolved(const Part& part) {
    const double half = 0.5 * (part.end - part.begin);
    for (const double halves : {0.0, 1.0, 2.0, 4.0, 8.0}) {
      const double at = std::min(part.begin + halves * half, 1.0);
      if (at >= result_.contact_at || is_spent()) break;
      set(at);
      if (parts_.kernels->check(parts_.problem, memory_.variables.data(), 0.0F, 0.0F, memory_.view,
                                &Translator::confirm, &translator_)) {
        result_.contact_at = at;
      }
    }
    return concluded(Verdict::kUnknown);
  }

  bool is_spent() const { return result_.configurations >= request_.max_configurations; }

  EdgeResult concluded(Verdict unless_in_contact) {
    result_.verdict = result_.contact_at <= 1.0 ? Verdict::kCollision : unless_in_contact;
    return result_;
  }

  // For the configuration that was set last.
  static bool ask_at(void* search, int, const MechanismContact& contact) {
    const auto& self = *static_cast<const EdgeSearch*>(search);
    return self.ask_(self.context_, self.result_.configurations,
                     std::span(self.memory_.variables).first(self.variables_), contact);
  }

  const Parts& parts_;
  std::span<const double> from_;
  std::span<const double> to_;
  Scratch::Memory& memory_;
  const EdgeRequest& request_;
  AskAt ask_;
  void* context_;
  std::size_t variables_;
  Translator translator_{parts_.scene, &ask_at, this};
  EdgeResult result_;
};

void require_resolution(double resolution) {
  if (!(resolution > 0.0)) throw Error("resolution", "it is not above zero");
}

EdgeResult MechanismCheck::check_edge(std::span<const double> from, std::span<const double> to,
                                      Scratch& scratch, const EdgeRequest& request, AskAt ask,
                                      void* context) const {
  assert(is_in_range(from) && is_in_range(to));
  assert(scratch.memory_->owner == parts_.get());
  require_resolution(request.resolution);
  return EdgeSearch(*parts_, from, to, *scratch.memory_, request, ask, context).run();
}

}  // namespace spherule
