// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/stopwatch.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/types/simplification.h"

#include <Eigen/Geometry>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

namespace spherule::internal {

// Covers a solid that is too large for one search (CoverFitter) in blocks, whose number grows with
// the solid: a block is a part of its cells, and is covered by a search of its own, by new spheres
// together with those that blocks before it have there. Each search proves its own cells against
// spheres that stay, so that in the end all cells are proved.
//
// Where the options allow for a search, the spheres of each block are then replaced by fewer, one
// block after the other; between two of them all spheres together cover all cells. What is to be
// covered again are all cells that the block's spheres meet, in other blocks too: any other cell
// was covered by other spheres alone, and still is.
//
// Blocks whose boxes have no point in common take their turn together, in parallel. What one of
// them has to cover meets no sphere of another, so that no proof rests on spheres that are replaced
// at the same time.
class CoverBlocks {
 public:
  static constexpr std::size_t kBlockCells = 30000;

  // The cells together hold S, and no two have the same centre. A block has `block_cells` at most.
  // The seconds of the options are those of the `watch`.
  CoverBlocks(const Clearance& clearance, const MeshDistance& distance, const CoverOptions& options,
              std::vector<BoxCell> cells, const Stopwatch& watch = {},
              std::size_t block_cells = kBlockCells);

  // Spheres that were proved to cover S.
  std::vector<Sphere> run();

 private:
  struct Block {
    std::vector<BoxCell> cells;    // to be covered
    CoverFitter::Spheres own;      // proved to cover them, with those of other blocks
    Eigen::AlignedBox3d box = {};  // of the cells and, in the search, of the spheres as it began
  };
  using Turn = std::vector<std::size_t>;

  // Makes the blocks: halves the cells until they are few enough.
  void divide(std::vector<BoxCell> cells, std::size_t block_cells);
  // The blocks that have cells, in turns of some whose boxes have no point in common.
  std::vector<Turn> turns() const;
  // The first answer.
  void cover();
  // From here on each block has to cover all cells that its spheres meet: none, if it has none.
  void widen();
  // Has each block search for fewer spheres.
  void search();
  // Runs the searches of a turn's blocks, each from its own spheres on, if it has any. A block
  // without options keeps these.
  template <class OptionsOf>
  void take(const Turn& turn, const OptionsOf& options_of);
  // The options for a block that begins its search now, or none if it should not.
  std::optional<CoverOptions> search_options(std::size_t block, std::size_t at_once);
  std::vector<Sphere> spheres_near(const Block& block) const;
  // Of spheres, in all blocks.
  std::size_t count() const;
  // That another block is done.
  void report();

  const Clearance& clearance_;
  const MeshDistance& distance_;
  const CoverOptions& options_;
  Stopwatch watch_;
  std::vector<Block> blocks_;
  bool is_proved_ = false;
  std::size_t total_ = 0;               // blocks of the first answer, or of the search
  std::atomic<std::size_t> begun_ = 0;  // of these
  std::mutex reporting_;
  std::size_t done_ = 0;
};

}  // namespace spherule::internal
