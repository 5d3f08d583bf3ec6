// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/search_trees.h"

#include "collide/solids/solid_spheres.h"
#include "spheretree/build.h"

#include <utility>

namespace spherule::internal {

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
    if (found != entries_.end()) return found->second.trees;
  }
  auto trees = std::make_shared<const SearchTrees>(spheres_of());
  const std::lock_guard lock(mutex_);
  return entries_.try_emplace(owner.get(), Entry{owner, std::move(trees)}).first->second.trees;
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SphereTree>& tree) {
  return find(tree, [&] { return tree->spheres(); });
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SolidMesh>& solid) {
  return find(solid, [&] { return spheres_around(*solid); });
}

}  // namespace spherule::internal
