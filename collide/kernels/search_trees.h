// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The trees over a set of spheres that compiled checks search, in the coordinates of the spheres:
// what takes time to build, once for every set.

#include "collide/search/culling_spheres.h"
#include "collide/solid_mesh.h"
#include "spheretree/sphere_tree.h"

#include <map>
#include <memory>
#include <mutex>
#include <span>

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

// Keeps the search trees of sphere trees, and of spheres around solid meshes (solid_spheres.h), for
// as long as these live and are not assigned to. Threads may share it.
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
