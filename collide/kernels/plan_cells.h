// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Whether positions lie in free cells of a pair (free_cells.h). Part of the kernels, see
// plan_kernel_impl.h.
//
// Coordinates are computed in double: those of positions up to 100 err by less than 1e-13 of a
// cell, for which free_cells.cpp has room.

#include "collide/kernels/plan_poses.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

SPHERULE_INLINE bool is_in_free_cell(const PlanFreeCells& cells, const double* positions) {
  if (cells.words == nullptr) return false;
  const double i = (positions[cells.position[0]] - cells.lower[0]) * cells.scale[0];
  const double j = (positions[cells.position[1]] - cells.lower[1]) * cells.scale[1];
  constexpr double kEnd = PlanFreeCells::kCells;
  if (!(i >= 0.0 && i < kEnd && j >= 0.0 && j < kEnd)) return false;
  return (cells.words[static_cast<int>(j)] >> static_cast<int>(i) & 1U) != 0;
}

// Those of the lanes whose configurations lie in free cells, or with `parts` all of the part.
template <class Real, bool kMoves>
unsigned lanes_in_free_cells(const PlanFreeCells& cells, const PlanScratch<Real>& scratch,
                             const PlanParts* parts, unsigned lanes) {
  if (cells.words == nullptr) return 0;
  alignas(64) std::int32_t first[2][kPlanLanes];
  alignas(64) std::int32_t last[2][kPlanLanes];
  for (int k = 0; k < 2; ++k) {
    const std::int32_t p = cells.position[k];
    const Double8 offset = load(scratch.positions[p].lane) - cells.lower[k];
    Double8 low = offset * cells.scale[k];
    Double8 high = low;
    if constexpr (kMoves) {
      const double rate = scratch.to[p] - scratch.from[p];
      const Double8 way =
          load(parts->half) * ((rate < 0.0 ? -rate : rate) * (1.0 + 0x1p-40)) + 1e-12;
      low = (offset - way) * cells.scale[k];
      high = (offset + way) * cells.scale[k];
    }
    lanes &= ~above(Double8{}, low) & above(all(double{PlanFreeCells::kCells}), high);
    if (lanes == 0) return 0;
    *reinterpret_cast<Int8*>(first[k]) = to_integers(low);
    if (kMoves) *reinterpret_cast<Int8*>(last[k]) = to_integers(high);
  }
  unsigned free = 0;
  for (unsigned left = lanes; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    const std::int32_t i = first[0][lane];
    if constexpr (kMoves) {
      const std::uint64_t bits = ~std::uint64_t{0} >> (63 - (last[0][lane] - i)) << i;
      std::uint64_t missing = 0;
      for (std::int32_t j = first[1][lane]; j <= last[1][lane]; ++j) {
        missing |= bits & ~cells.words[j];
      }
      if (missing == 0) free |= 1U << lane;
    } else {
      free |= static_cast<unsigned>(cells.words[first[1][lane]] >> i & 1U) << lane;
    }
  }
  return free;
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
