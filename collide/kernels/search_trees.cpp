// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/search_trees.h"

#include "collide/solids/solid_spheres.h"
#include "spheretree/build.h"
#include "spheretree/moved_from.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// What search trees are made of, and whether kept ones are of this: an object may have been
// assigned to since, and then holds something else in the same place.
struct ContentOfTree {
  const SphereTree& tree;

  std::span<const Sphere> spheres() const { return tree.spheres(); }
  std::weak_ptr<const void> identity() const { return {}; }
  bool is_that_of(const auto& kept) const {
    return std::ranges::equal(kept.trees->narrow.spheres(), tree.spheres());
  }
};

// The spheres around the triangles do not tell: the same ones may be around a surface that is open,
// which has no inside.
struct ContentOfSolid {
  const SolidMesh& solid;

  std::vector<Sphere> spheres() const { return spheres_around(solid); }
  std::weak_ptr<const void> identity() const { return solid.shared_inside(); }
  bool is_that_of(const auto& kept) const {
    require_content(solid.mesh().tree().node_count() > 0, "SolidMesh");
    return kept.identity.lock() == solid.shared_inside();
  }
};

}  // namespace

SearchTrees::SearchTrees(std::span<const Sphere> spheres)
    : narrow(build_tree(spheres, {.branching = kNarrow})),
      narrow_spheres(narrow),
      wide(build_tree(spheres)),
      wide_spheres(wide) {}

template <class Content>
std::shared_ptr<const SearchTrees> SearchTreeCache::find(const std::shared_ptr<const void>& owner,
                                                         const Content& content) {
  Entry kept;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const auto& entry) { return entry.second.owner.expired(); });
    const auto found = entries_.find(owner.get());
    if (found != entries_.end()) kept = found->second;
  }
  if (kept.trees != nullptr && content.is_that_of(kept)) return kept.trees;
  auto trees = std::make_shared<const SearchTrees>(content.spheres());
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[owner.get()];
  // Unless another thread was faster.
  if (entry.trees == kept.trees) entry = {owner, content.identity(), std::move(trees)};
  return entry.trees;
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SphereTree>& tree) {
  return find(tree, ContentOfTree{*tree});
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SolidMesh>& solid) {
  return find(solid, ContentOfSolid{*solid});
}

}  // namespace spherule::internal
