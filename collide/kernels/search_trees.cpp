// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/search_trees.h"

#include "collide/solids/solid_spheres.h"
#include "spheretree/build.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// What search trees are made of, and whether kept ones are of this: an object may have been
// assigned to since, and then holds other spheres in the same place.
struct SpheresOfTree {
  const SphereTree& tree;

  std::span<const Sphere> operator()() const { return tree.spheres(); }
  bool are(std::span<const Sphere> kept) const { return std::ranges::equal(kept, tree.spheres()); }
};

struct SpheresOfSolid {
  const SolidMesh& solid;

  std::vector<Sphere> operator()() const { return spheres_around(solid); }
  // Those around the triangles come first.
  bool are(std::span<const Sphere> kept) const {
    const std::span<const Sphere> triangles = solid.mesh().tree().spheres();
    const double inflation = solid.inflation();
    const auto is_inflated = [&](const Sphere& around, const Sphere& sphere) {
      return around.center == sphere.center &&
             sphere.radius == (inflation > 0.0 ? add_up(around.radius, inflation) : around.radius);
    };
    return triangles.size() <= kept.size() &&
           std::equal(triangles.begin(), triangles.end(), kept.begin(), is_inflated);
  }
};

}  // namespace

SearchTrees::SearchTrees(std::span<const Sphere> spheres)
    : narrow(build_tree(spheres, {.branching = kNarrow})),
      narrow_spheres(narrow),
      wide(build_tree(spheres)),
      wide_spheres(wide) {}

template <class SpheresOf>
std::shared_ptr<const SearchTrees> SearchTreeCache::find(const std::shared_ptr<const void>& owner,
                                                         const SpheresOf& spheres_of) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const auto& entry) { return entry.second.owner.expired(); });
    const auto found = entries_.find(owner.get());
    if (found != entries_.end()) {
      if (spheres_of.are(found->second.trees->narrow.spheres())) return found->second.trees;
      entries_.erase(found);
    }
  }
  auto trees = std::make_shared<const SearchTrees>(spheres_of());
  const std::lock_guard lock(mutex_);
  return entries_.try_emplace(owner.get(), Entry{owner, std::move(trees)}).first->second.trees;
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SphereTree>& tree) {
  return find(tree, SpheresOfTree{*tree});
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SolidMesh>& solid) {
  return find(solid, SpheresOfSolid{*solid});
}

}  // namespace spherule::internal
