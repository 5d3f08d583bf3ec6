// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/box_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// The kernels compute the coordinate of a position with an error below 1e-13 of a cell, of which
// none is wider than 200 / 64. What is left of a cell inside a leaf that is not proved, at most
// kNegligible wide, lies within FreeBoxes::kTolerance of the leaves beside it, which are free if no
// other leaf takes the cell.

namespace spherule::internal {
namespace {

constexpr double kNegligible = 1e-13;
constexpr int kCells = FreeCells::kCells;
static_assert(1e-13 * (2.0 * FreeBoxes::kLargestPosition / kCells) + 0.5 * kNegligible <
              FreeBoxes::kTolerance);

// The cells that an interval takes more of than is negligible, from the first to the one behind the
// last.
std::array<int, 2> cells_taken(const FreeCells::Axis& axis, double lower, double upper) {
  const auto coordinate = [&](double value) {
    return std::clamp((value - axis.lower) * axis.scale, 0.0, static_cast<double>(kCells));
  };
  return {static_cast<int>(std::floor(coordinate(lower + 0.5 * kNegligible))),
          static_cast<int>(std::ceil(coordinate(upper - 0.5 * kNegligible)))};
}

}  // namespace

std::shared_ptr<const FreeCells> box_cells(const FreeBoxes& boxes, std::span<const int> positions) {
  const std::vector<FreeBoxes::Variable>& variables = boxes.variables();
  if (variables.empty() || variables.size() > FreeCells::kMostJoints) return nullptr;
  std::array<FreeCells::Axis, FreeCells::kMostJoints> axes{};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double width = variables[i].upper - variables[i].lower;
    if (!(width > 0.0)) return nullptr;
    axes[i] = {positions[i], variables[i].lower, kCells / width};
  }
  if (variables.size() == 1) axes[1] = {positions[0], 0.0, 0.0};
  std::array<std::uint64_t, kCells> words{};
  std::fill_n(words.begin(), variables.size() == 1 ? 1 : kCells, ~std::uint64_t{0});
  boxes.for_each_leaf([&](bool is_free, std::span<const double> lower,
                          std::span<const double> upper) {
    if (is_free) return;
    const auto [first, end] = cells_taken(axes[0], lower[0], upper[0]);
    if (first >= end) return;
    const std::uint64_t bits = ~std::uint64_t{0} >> (kCells - (end - first)) << first;
    const auto [row, last_row] =
        variables.size() == 1 ? std::array<int, 2>{0, 1} : cells_taken(axes[1], lower[1], upper[1]);
    for (int j = row; j < last_row; ++j) words[static_cast<std::size_t>(j)] &= ~bits;
  });
  const bool has_any =
      std::any_of(words.begin(), words.end(), [](std::uint64_t word) { return word != 0; });
  return has_any ? std::make_shared<const FreeCells>(axes, words) : nullptr;
}

}  // namespace spherule::internal
