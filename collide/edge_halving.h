// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/edge.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
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
// others are left the part is halved, and these alone are looked at again. The large parts come
// first, so that a contact is likely to be met early; smaller ones from the left to the right.
//
// A pair that is not apart though it was grown by no more than half the resolution is given up in
// that part: there the two are nearer to each other than that. The motion is not proved free then,
// but a contact is still looked for.
//
// A Motion has
//   void set(double at, std::uint64_t number)  takes the configuration at a fraction of the motion;
//                                              the numbers start at 1 and differ
//   PartFinding look(std::int32_t pair, double half, double& growth)
//                                              at the configuration that was set, for the part
//                                              within `half` of it; says by how much was grown
//   bool touches()                             whether any pair touches there, without doubt
template <class Motion>
class EdgeHalving {
 public:
  // No part is halved more often than this: then it is shorter than what double tells apart near
  // one.
  static constexpr std::size_t kDeepest = 64;
  // The parts that are halved less often than this are the large ones.
  static constexpr std::size_t kSpread = 4;
  // A list of as many pairs as there are, one for each large part, and one for each depth.
  static constexpr std::size_t list_size(std::size_t pairs) { return pairs * kLists; }

  // `open_pairs` has list_size() elements. All that is referred to must outlive it.
  EdgeHalving(Motion& motion, std::span<std::int32_t> open_pairs, const EdgeRequest& request,
              double end = 1.0)
      : motion_(motion), open_pairs_(open_pairs), request_(request), end_(end) {}

  // Of the motion up to `end`, as EdgeResult says; free_until is `end` for kFree.
  EdgeResult run() {
    const std::size_t pairs = open_pairs_.size() / kLists;
    for (std::size_t i = 0; i < pairs; ++i) open_pairs_[i] = static_cast<std::int32_t>(i);
    parts_[last_++] = {0.0, end_, 0, 0, pairs};
    std::size_t list = pairs;
    while (first_ < last_ && parts_[first_].depth < kSpread) {
      const Part part = parts_[first_++];
      const std::optional<std::size_t> rest = look_at(part, list);
      if (!rest) return concluded();
      if (*rest == list) continue;
      parts_[last_++] = half_of(part, false, list, *rest);
      parts_[last_++] = half_of(part, true, list, *rest);
      list = *rest;
    }
    // A stack, the leftmost on top.
    std::reverse(parts_.data() + first_, parts_.data() + last_);
    while (first_ < last_) {
      const Part part = parts_[--last_];
      const std::size_t next = std::max(list, part.end_pair);
      const std::optional<std::size_t> rest = look_at(part, next);
      if (!rest) return concluded();
      if (*rest == next) continue;
      parts_[last_++] = half_of(part, true, next, *rest);
      parts_[last_++] = half_of(part, false, next, *rest);
    }
    return concluded();
  }

 private:
  static constexpr std::size_t kLarge = std::size_t{1} << kSpread;
  static constexpr std::size_t kLists = kLarge + kDeepest + 2;
  // Where pairs are given up in so many parts, no contact is looked for any more.
  static constexpr int kMostGivenUp = 32;

  // A part of the motion, and the pairs that may touch in it: those from `first_pair` on in the
  // list.
  struct Part {
    double begin;
    double end;
    std::size_t depth;  // halvings
    std::size_t first_pair;
    std::size_t end_pair;
  };

  static double middle_of(const Part& part) { return 0.5 * part.begin + 0.5 * part.end; }

  static Part half_of(const Part& part, bool is_right, std::size_t first, std::size_t end) {
    const double middle = middle_of(part);
    if (is_right) return {middle, part.end, part.depth + 1, first, end};
    return {part.begin, middle, part.depth + 1, first, end};
  }

  // Lists, from `list` on, the pairs that have to be looked at in the halves of a part, and says
  // where they end; nothing once there is no more to be found. What is behind a contact does not
  // matter.
  std::optional<std::size_t> look_at(const Part& part, std::size_t list) {
    if (part.begin >= result_.contact_at) return list;
    if (result_.configurations >= request_.max_configurations) {
      unproved_from_ = std::min(unproved_from_, part.begin);
      return std::nullopt;
    }
    const double middle = middle_of(part);
    const double half = 0.5 * (part.end - part.begin);
    const bool is_shortest = part.depth == kDeepest || !(part.begin < middle && middle < part.end);
    motion_.set(middle, ++result_.configurations);
    std::size_t end = list;
    bool gives_up = false;
    for (std::size_t i = part.first_pair; i < part.end_pair; ++i) {
      double growth = 0.0;
      const PartFinding finding = motion_.look(open_pairs_[i], half, growth);
      if (finding == PartFinding::kApart) continue;
      if (finding == PartFinding::kTouch) {
        result_.contact_at = std::min(result_.contact_at, middle);
        if (!request_.first) {
          unproved_from_ = std::min(unproved_from_, part.begin);
          return std::nullopt;
        }
      }
      if (is_shortest || growth <= 0.5 * request_.resolution) {
        gives_up = true;
      } else {
        open_pairs_[end++] = open_pairs_[i];
      }
    }
    if (!gives_up) return end;
    unproved_from_ = std::min(unproved_from_, part.begin);
    settle(part);
    const bool is_enough = result_.contact_at <= 1.0 && !request_.first;
    if (is_enough || ++given_up_ == kMostGivenUp) return std::nullopt;
    return end;
  }

  // A part in which bodies nearly touch: whether they do, where that can be told.
  void settle(const Part& part) {
    for (const double at : {part.begin, middle_of(part), part.end}) {
      if (at >= result_.contact_at) return;
      if (result_.configurations >= request_.max_configurations) return;
      motion_.set(at, ++result_.configurations);
      if (motion_.touches()) result_.contact_at = at;
    }
  }

  EdgeResult concluded() {
    for (std::size_t i = first_; i < last_; ++i) {
      unproved_from_ = std::min(unproved_from_, parts_[i].begin);
    }
    result_.free_until = std::min({unproved_from_, result_.contact_at, end_});
    result_.verdict = result_.contact_at <= 1.0 ? Verdict::kCollision
                      : unproved_from_ <= end_  ? Verdict::kUnknown
                                                : Verdict::kFree;
    return result_;
  }

  Motion& motion_;
  std::span<std::int32_t> open_pairs_;
  const EdgeRequest& request_;
  const double end_;
  EdgeResult result_;
  // Parts that wait, from first_ to last_: of the large ones two for each that was looked at, then
  // one for each depth, and two of the deepest.
  std::array<Part, 2 * kLarge + kDeepest + 2> parts_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double unproved_from_ = std::numeric_limits<double>::infinity();
  int given_up_ = 0;
};

}  // namespace spherule
