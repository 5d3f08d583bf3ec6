// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/edge.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace spherule {

// How two bodies stand to each other in the middle of a part of a motion, one of them grown by how
// far the two move against each other in it.
enum class PartFinding {
  kApart,  // so they do not touch anywhere in the part
  kNear,   // nothing is known of the part
  kTouch,  // as for kNear; in the middle the canonical test finds a contact
};

// Proves a motion over [0, end] free, or finds a contact, for pairs of bodies: parts of the motion
// are looked at in their middle. A pair that is apart when grown is free in the whole part; where
// others are left the part is halved, and these alone are looked at again; the left half first, so
// that what is proved is always one piece from the start.
//
// A Motion has
//   void set(double at, std::uint64_t number)  takes the configuration at a fraction of the motion;
//                                              the numbers start at 1 and differ
//   PartFinding look(std::int32_t pair, double half, double& growth)
//                                              at the configuration that was set, for the part
//                                              within `half` of it; says by how much was grown
//   bool touches()                             whether any pair touches there
template <class Motion>
class EdgeHalving {
 public:
  // No part is halved more often than this: then it is shorter than what double tells apart near
  // one.
  static constexpr std::size_t kDeepest = 64;
  // A list of as many pairs as there are for each depth, and one for what the deepest leaves.
  static constexpr std::size_t list_size(std::size_t pairs) { return pairs * (kDeepest + 2); }

  // `open_pairs` has list_size() elements. All that is referred to must outlive it.
  EdgeHalving(Motion& motion, std::span<std::int32_t> open_pairs, const EdgeRequest& request,
              double end = 1.0)
      : motion_(motion), open_pairs_(open_pairs), request_(request), end_(end) {}

  // Of the motion up to `end`, as EdgeResult says; free_until is `end` for kFree.
  EdgeResult run() {
    const std::size_t pairs = open_pairs_.size() / (kDeepest + 2);
    for (std::size_t i = 0; i < pairs; ++i) open_pairs_[i] = static_cast<std::int32_t>(i);
    std::array<Part, kDeepest + 2> waiting;  // one for each depth, and two of the deepest
    std::size_t top = 0;
    waiting[top++] = {0.0, end_, 0, 0, pairs};
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
  // A part of the motion, and the pairs that may touch in it: those from `first_pair` on in the
  // list.
  struct Part {
    double begin;
    double end;
    std::size_t depth;  // halvings
    std::size_t first_pair;
    std::size_t end_pair;
  };

  // What is left of a part: its pairs from end_pair of the part to `end_pair`.
  struct Look {
    std::size_t end_pair;
    double growth;  // the largest of any pair left
  };

  static double middle_of(const Part& part) { return 0.5 * part.begin + 0.5 * part.end; }

  void set(double at) { motion_.set(at, ++result_.configurations); }

  Look look_at(const Part& part) {
    const double middle = middle_of(part);
    const double half = 0.5 * (part.end - part.begin);
    set(middle);
    Look look{part.end_pair, 0.0};
    for (std::size_t i = part.first_pair; i < part.end_pair; ++i) {
      double growth = 0.0;
      const PartFinding finding = motion_.look(open_pairs_[i], half, growth);
      if (finding == PartFinding::kApart) continue;
      if (finding == PartFinding::kTouch) {
        result_.contact_at = std::min(result_.contact_at, middle);
      }
      open_pairs_[look.end_pair++] = open_pairs_[i];
      look.growth = std::max(look.growth, growth);
    }
    return look;
  }

  // The part cannot be proved free, and is not halved. The contact that it comes close to is likely
  // to be in it, or soon after.
  EdgeResult unresolved(const Part& part) {
    const double half = 0.5 * (part.end - part.begin);
    for (const double halves : {0.0, 1.0, 2.0, 4.0, 8.0}) {
      const double at = std::min(part.begin + halves * half, end_);
      if (at >= result_.contact_at || is_spent()) break;
      set(at);
      if (motion_.touches()) result_.contact_at = at;
    }
    return concluded(Verdict::kUnknown);
  }

  bool is_spent() const { return result_.configurations >= request_.max_configurations; }

  EdgeResult concluded(Verdict unless_in_contact) {
    result_.verdict = result_.contact_at <= 1.0 ? Verdict::kCollision : unless_in_contact;
    return result_;
  }

  Motion& motion_;
  std::span<std::int32_t> open_pairs_;
  const EdgeRequest& request_;
  const double end_;
  EdgeResult result_;
};

}  // namespace spherule
