// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/internal/box_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// The kernels compute the coordinate of a position with an error below 1e-13 of a cell, of which
// none is wider than 200 / 64. What a leaf that is not proved takes of a cell without its being
// noted, at most half of kNegligible at either end of either interval, lies within
// FreeBoxes::kTolerance of a leaf beside it in this cell that is free: one that is not takes the
// cell, because each takes one at least.

namespace spherule::internal {
namespace {

constexpr double kNegligible = 1e-13;
// Cells of narrower ranges are not worth having.
constexpr double kNarrowest = 1e-6;
constexpr int kCells = FreeCells::kCells;
static_assert(1e-13 * (2.0 * FreeBoxes::kLargestPosition / kCells) + kNegligible <
              FreeBoxes::kTolerance);

// The cells that an interval takes more of than is negligible, from the first to the one behind the
// last; that of its middle at least.
std::array<int, 2> cells_taken(const FreeCells::Axis& axis, double lower, double upper) {
  const auto coordinate = [&](double value) {
    return std::clamp((value - axis.lower) * axis.scale, 0.0, static_cast<double>(kCells));
  };
  const int middle =
      std::min(static_cast<int>(std::floor(coordinate(0.5 * lower + 0.5 * upper))), kCells - 1);
  const int first = static_cast<int>(std::floor(coordinate(lower + 0.5 * kNegligible)));
  const int end = static_cast<int>(std::ceil(coordinate(upper - 0.5 * kNegligible)));
  return {std::min(first, middle), std::max(end, middle + 1)};
}

}  // namespace

std::shared_ptr<const FreeCells> box_cells(const FreeBoxes& boxes, std::span<const int> positions) {
  const std::vector<FreeBoxes::Variable>& variables = boxes.variables();
  if (variables.empty() || variables.size() > FreeCells::kMostJoints) return nullptr;
  std::array<FreeCells::Axis, FreeCells::kMostJoints> axes{};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double width = variables[i].upper - variables[i].lower;
    if (!(width > kNarrowest)) return nullptr;
    axes[i] = {positions[i], variables[i].lower, kCells / width};
  }
  if (variables.size() == 1) axes[1] = {positions[0], 0.0, 0.0};
  std::array<std::uint64_t, kCells> words{};
  std::fill_n(words.begin(), variables.size() == 1 ? 1 : kCells, ~std::uint64_t{0});
  boxes.for_each_leaf([&](bool is_free, std::span<const double> lower,
                          std::span<const double> upper) {
    if (is_free) return;
    const auto [first, end] = cells_taken(axes[0], lower[0], upper[0]);
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
