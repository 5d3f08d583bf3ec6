// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The trees over a set of spheres that compiled checks search, in the coordinates of the spheres:
// what takes time to build, once for every set.

#include "collide/meshes/solid_mesh.h"
#include "collide/search/packed_tree.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace spherule::internal {

struct SearchTrees {
  // Children of a node. Wide nodes cost the lanes that are apart from some of their children,
  // narrow ones more levels: from 2 to 8 proofs of motions of an arm differ by less than noise.
  static constexpr int kNarrow = 4;

  explicit SearchTrees(std::span<const Sphere> spheres);

  SphereTree narrow;  // for lanes that hold configurations
  CullingSpheres narrow_spheres;
  SphereTree wide;  // for lanes that hold children
  CullingSpheres wide_spheres;
};

// Keeps the search trees of sphere trees, and of spheres around solid meshes (spheres_inside.h),
// for as long as these live and are not assigned to. Threads may share it.
class SearchTreeCache {
 public:
  std::shared_ptr<const SearchTrees> of(const std::shared_ptr<const SphereTree>& tree);
  std::shared_ptr<const SearchTrees> of(const std::shared_ptr<const SolidMesh>& solid);

 private:
  template <class Content>
  std::shared_ptr<const SearchTrees> find(const std::shared_ptr<const void>& owner,
                                          const Content& content);

  struct Entry {
    std::weak_ptr<const void> owner;
    std::weak_ptr<const void> identity;  // of the solid that was in it
    std::shared_ptr<const SearchTrees> trees;
  };
  std::mutex mutex_;
  std::map<const void*, Entry> entries_;
};

}  // namespace spherule::internal

// Where two bodies of a mechanism are proved apart, by the positions of the joints between them
// alone: a grid of cells over the intervals of one or two joints, a bit for each cell.

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

// What compiled checks of a robot are made from and takes time to compute, kept with the robot.
struct CheckCache {
  SearchTreeCache search_trees;
  FreeCellsCache free_cells;
};

}  // namespace spherule::internal
