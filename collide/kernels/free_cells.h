// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where two bodies of a mechanism are proved apart, by the positions of the joints between them
// alone: a grid of cells over the intervals of one or two joints, a bit for each cell.

#include "collide/kernels/search_trees.h"
#include "spheretree/pose.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace spherule::internal {

// What is between two bodies: the chains of joints from the last frame that carries both, in the
// order in which they lead away from it.
struct FreeCellsSource {
  struct Joint {
    Pose parent_from_frame{};  // it turns about, or slides along, the z axis of its frame
    bool turns = true;
    int position = 0;
    double lower = 0.0;  // what cells are sought in
    double upper = 0.0;
  };
  struct Side {
    std::vector<Joint> chain{};
    std::shared_ptr<const SearchTrees> trees{};
    Pose frame_from_trees{};
  };
  Side first{};
  Side second{};
  // What two spheres must be apart by, roundings of this search not included.
  double margin = 0.0;

  bool operator==(const FreeCellsSource& other) const;
};

class FreeCells {
 public:
  static constexpr int kCells = 64;  // in each direction
  static constexpr int kMostJoints = 2;

  // None if there are no joints, too many, or no cell is free.
  static std::shared_ptr<const FreeCells> of(const FreeCellsSource& source);

  // A coordinate of the grid, in cells: (position - lower) * scale, for the position's number. With
  // one joint the second coordinate is always 0.
  struct Axis {
    int position = 0;
    double lower = 0.0;
    double scale = 0.0;
  };
  const std::array<Axis, kMostJoints>& axes() const { return axes_; }

  // Of cells that are proved free in another way.
  FreeCells(const std::array<Axis, kMostJoints>& axes,
            const std::array<std::uint64_t, kCells>& words)
      : axes_(axes), words_(words) {}

  // Bit i of word j: in all positions whose coordinates lie in [i, i + 1] and [j, j + 1] the two
  // are proved free; by of(): further apart than the margin.
  const std::array<std::uint64_t, kCells>& words() const { return words_; }

 private:
  FreeCells() = default;

  std::array<Axis, kMostJoints> axes_{};
  std::array<std::uint64_t, kCells> words_{};
};

// Keeps the cells of pairs for as long as the search trees of both live. Threads may share it.
class FreeCellsCache {
 public:
  std::shared_ptr<const FreeCells> of(const FreeCellsSource& source);

 private:
  // The source without its trees, which are held weakly.
  struct Entry {
    FreeCellsSource source;
    std::weak_ptr<const SearchTrees> first;
    std::weak_ptr<const SearchTrees> second;
    std::shared_ptr<const FreeCells> cells;
  };
  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace spherule::internal
