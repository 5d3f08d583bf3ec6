// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/search_trees.h"

#include "spheretree/build.h"

namespace spherule::internal {
SearchTrees::SearchTrees(std::span<const Sphere> spheres)
    : narrow(build_tree(spheres, {.branching = kNarrow})),
      narrow_spheres(narrow),
      wide(build_tree(spheres)),
      wide_spheres(wide) {}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SphereTree>& tree) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const auto& entry) { return entry.second.tree.expired(); });
    const auto found = entries_.find(tree.get());
    if (found != entries_.end()) return found->second.trees;
  }
  auto trees = std::make_shared<const SearchTrees>(tree->spheres());
  const std::lock_guard lock(mutex_);
  return entries_.try_emplace(tree.get(), Entry{tree, std::move(trees)}).first->second.trees;
}

}  // namespace spherule::internal
