// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_blocks.h"

#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"
#include "spheretree/median_split.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <span>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Of the progress of a search: the first answers.
constexpr double kFirstShare = 0.1;

AlignedBox3d box_of(const BoxCell& cell) {
  return {cell.center - cell.half, cell.center + cell.half};
}

AlignedBox3d box_of(const Sphere& sphere) {
  const Vector3d radius = Vector3d::Constant(sphere.radius);
  return {sphere.center - radius, sphere.center + radius};
}

template <class Item>
AlignedBox3d box_of(const std::vector<Item>& items) {
  AlignedBox3d box;
  for (const Item& item : items) box.extend(box_of(item));
  return box;
}

CoverOptions block_options(CoverOptions options) {
  options.lower_bound = false;
  options.progress = {};
  options.on_proved = {};
  return options;
}

}  // namespace

CoverBlocks::CoverBlocks(const Clearance& clearance, const MeshDistance& distance,
                         const CoverOptions& options, std::vector<BoxCell> cells,
                         std::size_t block_cells)
    : clearance_(clearance), distance_(distance), options_(options) {
  divide(std::move(cells), block_cells);
}

void CoverBlocks::divide(std::vector<BoxCell> cells, std::size_t block_cells) {
  std::vector<std::pair<std::size_t, std::size_t>> waiting{{0, cells.size()}};
  while (!waiting.empty()) {
    const auto [begin, end] = waiting.back();
    waiting.pop_back();
    const std::span part = std::span(cells).subspan(begin, end - begin);
    if (part.size() <= block_cells) {
      blocks_.push_back({.cells = {part.begin(), part.end()}, .spheres = {}, .box = {}});
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
    if (&other == &block || !other.box.intersects(block.box)) continue;
    std::ranges::copy_if(other.spheres, std::back_inserter(near),
                         [&](const Sphere& s) { return box_of(s).intersects(block.box); });
  }
  return near;
}

std::vector<std::vector<Sphere>> CoverBlocks::covered(const Turn& turn,
                                                      const CoverOptions& options) {
  std::vector<std::vector<Sphere>> found(turn.size());
  parallel_for(0, turn.size(), [&](std::size_t k) {
    const Block& block = blocks_[turn[k]];
    if (is_proved_ && options.stop.stop_requested()) {
      found[k] = block.spheres;
      return;
    }
    CoverOptions own = options;
    own.seed = seed_of(options.seed, turn[k]);
    found[k] = CoverFitter(clearance_, distance_, own, spheres_near(block), block.cells).run();
    ++done_;
    report();
  });
  return found;
}

void CoverBlocks::cover() {
  CoverOptions options = block_options(options_);
  options.effort = 0;
  for (const Turn& turn : turns()) {
    std::vector<std::vector<Sphere>> found = covered(turn, options);
    for (std::size_t k = 0; k < turn.size(); ++k) {
      Block& block = blocks_[turn[k]];
      block.spheres = std::move(found[k]);
      block.box.extend(box_of(block.spheres));
    }
  }
  is_proved_ = true;
}

void CoverBlocks::widen() {
  std::vector<std::vector<BoxCell>> met(blocks_.size());
  parallel_for(0, blocks_.size(), [&](std::size_t i) {
    const Block& block = blocks_[i];
    const SphereHierarchy spheres(block.spheres);
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
    block.box = box_of(block.cells).merged(box_of(block.spheres));
  }
}

void CoverBlocks::search() {
  const auto start = std::chrono::steady_clock::now();
  CoverOptions options = block_options(options_);
  std::size_t left = blocks_.size();
  done_ = 0;
  for (const Turn& turn : turns()) {
    if (options_.seconds > 0.0) {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      const std::size_t at_once = std::min(turn.size(), thread_count());
      options.seconds = (options_.seconds - elapsed.count()) * static_cast<double>(at_once) /
                        static_cast<double>(left);
      if (options.seconds <= 0.0) return;
    }
    const std::size_t before = count();
    std::vector<std::vector<Sphere>> found = covered(turn, options);
    for (std::size_t k = 0; k < turn.size(); ++k) {
      std::vector<Sphere>& spheres = blocks_[turn[k]].spheres;
      if (found[k].size() < spheres.size()) spheres = std::move(found[k]);
    }
    left -= turn.size();
    if (options_.on_proved && count() < before) options_.on_proved(count());
  }
}

std::size_t CoverBlocks::count() const {
  std::size_t count = 0;
  for (const Block& block : blocks_) count += block.spheres.size();
  return count;
}

void CoverBlocks::report() const {
  if (!options_.progress) return;
  const double share = static_cast<double>(done_) / static_cast<double>(blocks_.size());
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
    all.insert(all.end(), block.spheres.begin(), block.spheres.end());
  }
  return all;
}

}  // namespace spherule::internal
