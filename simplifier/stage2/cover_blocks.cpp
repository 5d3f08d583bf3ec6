// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_blocks.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/median_split.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/types/zones.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::AlignedBox3d;
using spherule::bounds;

// Of the progress of a search: the first answers.
constexpr double kFirstShare = 0.1;

// Rounded outwards, as is that of a sphere (zones.h).
AlignedBox3d bounds(const BoxCell& cell) {
  AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = sub_down(cell.center[axis], cell.half[axis]);
    box.max()[axis] = add_up(cell.center[axis], cell.half[axis]);
  }
  return box;
}

template <class Item>
AlignedBox3d box_of(const std::vector<Item>& items) {
  AlignedBox3d box;
  for (const Item& item : items) box.extend(bounds(item));
  return box;
}

CoverOptions block_options(CoverOptions options, std::size_t block) {
  options.seed = seed_of(options.seed, block);
  options.lower_bound = false;
  options.progress = {};
  options.on_proved = {};
  return options;
}

}  // namespace

CoverBlocks::CoverBlocks(const Clearance& clearance, const MeshDistance& distance,
                         const CoverOptions& options, std::vector<BoxCell> cells,
                         const Stopwatch& watch, std::size_t block_cells)
    : clearance_(clearance), distance_(distance), options_(options), watch_(watch) {
  divide(std::move(cells), block_cells);
}

void CoverBlocks::divide(std::vector<BoxCell> cells, std::size_t block_cells) {
  std::vector<std::pair<std::size_t, std::size_t>> waiting{{0, cells.size()}};
  while (!waiting.empty()) {
    const auto [begin, end] = waiting.back();
    waiting.pop_back();
    const std::span part = std::span(cells).subspan(begin, end - begin);
    if (part.size() <= block_cells) {
      blocks_.push_back({.cells = {part.begin(), part.end()}, .own = {}});
      blocks_.back().box = box_of(blocks_.back().cells);
      continue;
    }
    AlignedBox3d centers;
    for (const BoxCell& cell : part) centers.extend(cell.center);
    const Eigen::Index axis = longest_axis(centers);
    const std::size_t half = split_at_median(part, [&](const BoxCell& cell) {
      return std::array{cell.center[axis], cell.center[(axis + 1) % 3],
                        cell.center[(axis + 2) % 3]};
    });
    waiting.emplace_back(begin + half, end);
    waiting.emplace_back(begin, begin + half);
  }
  for (Block& block : blocks_) {
    std::sort(block.cells.begin(), block.cells.end(), [](const BoxCell& a, const BoxCell& b) {
      return std::lexicographical_compare(a.center.begin(), a.center.end(), b.center.begin(),
                                          b.center.end());
    });
  }
}

std::vector<CoverBlocks::Turn> CoverBlocks::turns() const {
  std::vector<Turn> turns;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (blocks_[i].cells.empty()) continue;
    const auto is_apart = [&](const Turn& turn) {
      return std::ranges::none_of(
          turn, [&](std::size_t other) { return blocks_[i].box.intersects(blocks_[other].box); });
    };
    const auto found = std::ranges::find_if(turns, is_apart);
    if (found != turns.end()) {
      found->push_back(i);
    } else {
      turns.push_back({i});
    }
  }
  return turns;
}

std::vector<Sphere> CoverBlocks::spheres_near(const Block& block) const {
  std::vector<Sphere> near;
  for (const Block& other : blocks_) {
    if (&other == &block) continue;
    // Not for spheres whose boxes have no point in common with that of the block: the distance
    // along an axis is then no less than the radius as rounded, and so is all that follows.
    std::ranges::copy_if(other.own.spheres, std::back_inserter(near), [&](const Sphere& s) {
      return block.box.squaredExteriorDistance(s.center) < s.radius * s.radius;
    });
  }
  return near;
}

template <class OptionsOf>
void CoverBlocks::take(const Turn& turn, const OptionsOf& options_of) {
  std::vector<CoverFitter::Spheres> found(turn.size());
  parallel_for(0, turn.size(), [&](std::size_t k) {
    const Block& block = blocks_[turn[k]];
    if (const std::optional<CoverOptions> options = options_of(turn[k])) {
      CoverFitter fitter(clearance_, distance_, *options, spheres_near(block), block.cells);
      found[k] = fitter.run(block.own);
    } else {
      found[k] = block.own;
    }
    report();
  });
  for (std::size_t k = 0; k < turn.size(); ++k) blocks_[turn[k]].own = std::move(found[k]);
}

void CoverBlocks::cover() {
  total_ = blocks_.size();
  for (const Turn& turn : turns()) {
    take(turn, [&](std::size_t block) -> std::optional<CoverOptions> {
      CoverOptions options = block_options(options_, block);
      options.effort = 0;
      return options;
    });
  }
  is_proved_ = true;
}

void CoverBlocks::widen() {
  for (Block& block : blocks_) block.box = box_of(block.cells).merged(box_of(block.own.spheres));
  std::vector<std::vector<BoxCell>> met(blocks_.size());
  parallel_for(0, blocks_.size(), [&](std::size_t i) {
    const Block& block = blocks_[i];
    const SphereHierarchy spheres(block.own.spheres);
    for (const Block& other : blocks_) {
      if (!other.box.intersects(block.box)) continue;
      std::ranges::copy_if(other.cells, std::back_inserter(met[i]), [&](const BoxCell& cell) {
        return spheres.nearest(cell.center).lower <= cell.reach();
      });
    }
  });
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    Block& block = blocks_[i];
    block.cells = std::move(met[i]);
    block.box = box_of(block.cells).merged(box_of(block.own.spheres));
  }
}

std::optional<CoverOptions> CoverBlocks::search_options(std::size_t block, std::size_t at_once) {
  const std::size_t left = total_ - begun_++;
  if (options_.stop.stop_requested()) return std::nullopt;
  CoverOptions options = block_options(options_, block);
  if (options_.seconds > 0.0) {
    // An equal share for all that are left.
    options.seconds = (options_.seconds - watch_.seconds()) *
                      static_cast<double>(std::min(at_once, left)) / static_cast<double>(left);
    if (options.seconds <= 0.0) return std::nullopt;
  }
  return options;
}

void CoverBlocks::search() {
  const std::vector<Turn> all = turns();
  total_ = 0;
  for (const Turn& turn : all) total_ += turn.size();
  done_ = 0;
  for (const Turn& turn : all) {
    const std::size_t before = count();
    const std::size_t at_once = std::min(turn.size(), thread_count());
    take(turn, [&](std::size_t block) { return search_options(block, at_once); });
    if (options_.on_proved && count() < before) options_.on_proved(count());
  }
}

std::size_t CoverBlocks::count() const {
  std::size_t count = 0;
  for (const Block& block : blocks_) count += block.own.spheres.size();
  return count;
}

void CoverBlocks::report() {
  if (!options_.progress) return;
  const std::lock_guard lock(reporting_);
  const double share = static_cast<double>(++done_) / static_cast<double>(total_);
  if (!is_proved_) {
    options_.progress(options_.effort > 0 ? kFirstShare * share : share, "covering in blocks");
    return;
  }
  options_.progress(kFirstShare + (1.0 - kFirstShare) * share,
                    ("covering in blocks: " + std::to_string(count()) + " spheres proved").c_str());
}

std::vector<Sphere> CoverBlocks::run() {
  cover();
  if (options_.on_proved) options_.on_proved(count());
  if (options_.effort > 0) {
    widen();
    search();
  }
  std::vector<Sphere> all;
  for (const Block& block : blocks_) {
    all.insert(all.end(), block.own.spheres.begin(), block.own.spheres.end());
  }
  return all;
}

}  // namespace spherule::internal
