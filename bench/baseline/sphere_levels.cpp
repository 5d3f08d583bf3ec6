// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/sphere_levels.h"

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/enclosing_sphere.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace spherule {
namespace {

void check(const SphereLevels& levels, std::size_t leaves) {
  if (levels.levels.empty() || levels.parents.size() + 1 != levels.levels.size()) {
    throw Error("sphere levels", "need parents for every level but the coarsest");
  }
  if (leaves != levels.levels.back().size()) {
    throw Error("leaves", "are not as many as the spheres of the finest level");
  }
  for (std::size_t k = 0; k < levels.parents.size(); ++k) {
    if (levels.parents[k].size() != levels.levels[k + 1].size()) {
      throw Error("sphere levels", "level " + std::to_string(k + 1) + " lacks parents");
    }
    const auto count = static_cast<std::int32_t>(levels.levels[k].size());
    for (const std::int32_t parent : levels.parents[k]) {
      if (parent < 0 || parent >= count) throw Error("sphere levels", "a parent is not there");
    }
  }
}

// Encloses the children with the reserve that build_tree_from_levels() requires.
Sphere enclosing(const Sphere& own, std::span<const Sphere> children) {
  if (children.size() == 1 && certainly_encloses(own, children[0])) return own;
  Sphere best = enclosing_sphere(children);
  double about_own = own.radius;
  for (const Sphere& child : children) {
    about_own = std::max(about_own, add_up(distance_upper(own.center, child.center), child.radius));
  }
  if (about_own <= best.radius) best = {own.center, about_own};
  best.radius = mul_up(best.radius, 1.0 + 4.0 * SphereLevel::kReserve);
  return best;
}

}  // namespace

LevelTree enclosing_tree(const SphereLevels& levels, std::span<const Sphere> leaves) {
  check(levels, leaves.size());
  std::vector<SphereLevel> above;  // the finest first
  std::vector<Sphere> below(leaves.begin(), leaves.end());
  std::vector<std::int32_t> kept(leaves.size());  // index in the level of each of `below`
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = static_cast<std::int32_t>(i);
  for (std::size_t k = levels.parents.size(); k-- > 0;) {
    std::vector<std::vector<Sphere>> children(levels.levels[k].size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      const auto own = static_cast<std::size_t>(kept[i]);
      children[static_cast<std::size_t>(levels.parents[k][own])].push_back(below[i]);
    }
    SphereLevel level;
    std::vector<std::int32_t> place(children.size(), -1);
    std::vector<std::int32_t> kept_here;
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (children[i].empty()) continue;
      place[i] = static_cast<std::int32_t>(level.spheres.size());
      level.spheres.push_back(enclosing(levels.levels[k][i], children[i]));
      kept_here.push_back(static_cast<std::int32_t>(i));
    }
    for (const std::int32_t own : kept) {
      const std::int32_t parent = levels.parents[k][static_cast<std::size_t>(own)];
      level.parent_of.push_back(place[static_cast<std::size_t>(parent)]);
    }
    below = level.spheres;
    kept = std::move(kept_here);
    above.push_back(std::move(level));
  }
  return build_tree_from_levels(leaves, above);
}

}  // namespace spherule
