// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/cell_octree.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/stage2/cover_moves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using internal::CellOctree;
using Cell = CellOctree::Cell;
using State = CellOctree::State;

double step_of(const OctreeSpheresOptions& options, const Eigen::AlignedBox3d& box,
               double padding) {
  internal::check_padding(options.padding);
  if (options.depth == 0) {
    internal::check_max_error(options.max_error);
    return internal::edge_for_error(options.max_error);
  }
  if (options.max_error != 0.0) throw Error("depth", "leaves nothing to a max error");
  if (options.depth < 0 || options.depth > CellOctree::kMostLevels) {
    throw Error("depth", std::to_string(options.depth) + " is not between 1 and " +
                             std::to_string(CellOctree::kMostLevels));
  }
  // A hair above, so that as many cells hold the margins, too.
  const double size = box.sizes().maxCoeff() + 2.0 * padding;
  return std::ldexp(size * (1.0 + 0x1p-10), -options.depth);
}

// The nodes of the sphere tree, breadth-first.
class TreeMaker {
 public:
  TreeMaker(const CellOctree& octree, const MeshDistance& distance,
            const OctreeSpheresOptions& options)
      : octree_(octree),
        distance_(distance),
        whole_surface_(options.depth > 0),
        inside_(options.filling == Filling::kSolid),
        max_error_(options.depth > 0 ? 2.0 * octree.circumscribed(octree.levels())
                                     : options.max_error) {
    find_kept();
  }

  SphereTreeData run() {
    std::vector<Cell> nodes = {octree_.cells().front()};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Cell cell = nodes[i];
      const Sphere sphere{octree_.center(cell), octree_.circumscribed(cell.level)};
      add_sphere(sphere);
      if (is_leaf(cell, sphere)) {
        data_.first_child.push_back(static_cast<std::int32_t>(data_.spheres.size()));
        data_.child_count.push_back(0);
        data_.spheres.push_back(sphere);
        continue;
      }
      data_.first_child.push_back(static_cast<std::int32_t>(nodes.size()));
      const std::size_t before = nodes.size();
      for (std::uint32_t k = 0; k < 8; ++k) {
        if (cell.state == State::kInside) {
          nodes.push_back(CellOctree::child(cell, k));
        } else if (kept_[cell.first_child + k]) {
          nodes.push_back(octree_.cells()[cell.first_child + k]);
        }
      }
      data_.child_count.push_back(static_cast<std::int32_t>(nodes.size() - before));
      if (nodes.size() > CellOctree::kMaxCells) {
        throw Error("octree", "more than " + std::to_string(CellOctree::kMaxCells) +
                                  " cubes; take a smaller depth or a larger max error");
      }
    }
    return std::move(data_);
  }

 private:
  // A refined cell may turn out to hold nothing: the surface was only possibly in it.
  void find_kept() {
    const std::vector<Cell>& cells = octree_.cells();
    kept_.resize(cells.size());
    for (std::size_t i = cells.size(); i-- > 0;) {
      const State state = cells[i].state;
      bool keep = state == State::kSurface || (state == State::kInside && inside_);
      for (std::uint32_t k = 0; k < 8 && state == State::kRefined && !keep; ++k) {
        keep = kept_[cells[i].first_child + k];
      }
      kept_[i] = keep;
    }
  }

  bool is_leaf(const Cell& cell, const Sphere& sphere) const {
    if (cell.level == octree_.levels()) return true;
    const bool inside = cell.state == State::kInside;
    if (!inside && whole_surface_) return false;
    const SurfaceDistance d = distance_(sphere.center);
    const double protrusion = inside || octree_.has_center_inside(cell)
                                  ? sub_up(sphere.radius, d.lower)
                                  : add_up(sphere.radius, d.upper);
    return protrusion <= max_error_;
  }

  void add_sphere(const Sphere& sphere) {
    data_.x.push_back(sphere.center.x());
    data_.y.push_back(sphere.center.y());
    data_.z.push_back(sphere.center.z());
    data_.radius.push_back(sphere.radius);
  }

  const CellOctree& octree_;
  const MeshDistance& distance_;
  bool whole_surface_;
  bool inside_;
  double max_error_;
  std::vector<bool> kept_;
  SphereTreeData data_;
};

}  // namespace

OctreeSpheres octree_spheres(const TriangleMesh& mesh, const OctreeSpheresOptions& options) {
  validate(mesh, "mesh");
  const MeshDistance distance(mesh);
  const double step = step_of(options, distance.box(), add_up(options.padding, mesh.vertex_error));
  const CellOctree octree(mesh, step, options.padding);
  return {SphereTree(TreeMaker(octree, distance, options).run()), step};
}

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
