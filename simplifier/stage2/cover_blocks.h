// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/cover.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/clearance.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <atomic>
#include <cstddef>
#include <vector>

namespace spherule::internal {

// Covers a solid that is too large for one search (CoverFitter) in blocks, whose number grows with
// the solid: a block is a part of its cells, and is covered by a search of its own, by new spheres
// together with those that blocks before it have there. Each search proves its own cells, so that
// in the end all cells are proved.
//
// Where the options allow for a search, the spheres of each block are then replaced by fewer, one
// block after the other. What is to be covered there are all cells that its spheres meet, in other
// blocks too: any other cell was covered by other spheres alone, and still is.
//
// Blocks that are apart from each other take their turn together, in parallel.
class CoverBlocks {
 public:
  // More cells, of the coarsest that a search begins with, are too many for one search.
  static constexpr std::size_t kMostCells = 100000;
  static constexpr std::size_t kBlockCells = 30000;

  // The cells together hold S, and no two have the same centre. A block has `block_cells` at most.
  CoverBlocks(const Clearance& clearance, const MeshDistance& distance, const CoverOptions& options,
              std::vector<BoxCell> cells, std::size_t block_cells = kBlockCells);

  // Spheres that were proved to cover S.
  std::vector<Sphere> run();

 private:
  struct Block {
    std::vector<BoxCell> cells;
    std::vector<Sphere> spheres;  // proved to cover the cells, with those of other blocks
    Eigen::AlignedBox3d box;      // of both
  };
  using Turn = std::vector<std::size_t>;

  // Makes the blocks: halves the cells until they are few enough.
  void divide(std::vector<BoxCell> cells, std::size_t block_cells);
  // The blocks, in turns of some whose boxes have no point in common.
  std::vector<Turn> turns() const;
  // The first answer.
  void cover();
  // From here on each block has to cover all cells that its spheres meet.
  void widen();
  // Has each block search for fewer spheres.
  void search();
  // Covers the blocks of a turn anew, each together with the spheres of the others. Those that a
  // stop leaves out keep their spheres.
  std::vector<std::vector<Sphere>> covered(const Turn& turn, const CoverOptions& options);
  std::vector<Sphere> spheres_near(const Block& block) const;
  // Of spheres, in all blocks.
  std::size_t count() const;
  void report() const;

  const Clearance& clearance_;
  const MeshDistance& distance_;
  const CoverOptions& options_;
  std::vector<Block> blocks_;
  bool is_proved_ = false;
  std::atomic<std::size_t> done_ = 0;  // blocks, of the first answer or of the search
};

}  // namespace spherule::internal
