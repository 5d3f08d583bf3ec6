// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/voxelisation.h"

#include "base/error.h"
#include "bench/baseline/internal/cell_octree.h"
#include "bench/baseline/internal/cell_options.h"
#include "simplifier/stage2/cover_moves.h"

#include <cstdint>
#include <sstream>

namespace spherule {
namespace {

using internal::CellOctree;

// Half a GiB.
constexpr std::size_t kMaxSpheres = std::size_t{1} << 24;

double step_of(const VoxelisationOptions& options) {
  internal::check_padding(options.padding);
  if (options.step != 0.0) {
    if (options.max_error != 0.0) throw Error("step", "leaves nothing to a max error");
    return options.step;
  }
  internal::check_max_error(options.max_error);
  return internal::edge_for_error(options.max_error);
}

// Along an axis of a cell.
std::uint32_t voxels_along(const CellOctree& octree, const CellOctree::Cell& cell) {
  return std::uint32_t{1} << (octree.levels() - cell.level);
}

void count(const CellOctree& octree, Filling filling, Voxelisation& result) {
  for (const CellOctree::Cell& cell : octree.cells()) {
    if (cell.state == CellOctree::State::kSurface) ++result.surface;
    if (cell.state == CellOctree::State::kInside && filling == Filling::kSolid) {
      const std::size_t along = voxels_along(octree, cell);
      result.inside += along * along * along;
    }
  }
  if (result.surface + result.inside > kMaxSpheres) {
    std::ostringstream text;
    text << result.step << " makes " << result.surface + result.inside
         << " voxels; at most 2^24 are made";
    throw Error("step", text.str());
  }
}

// Appends the spheres of the voxels below a cell.
class Filler {
 public:
  Filler(const CellOctree& octree, Filling filling, double radius, std::vector<Sphere>& spheres)
      : octree_(octree), filling_(filling), radius_(radius), spheres_(spheres) {}

  void fill(const CellOctree::Cell& cell) {
    const bool inside = cell.state == CellOctree::State::kInside;
    if (cell.state == CellOctree::State::kOutside) return;
    if (inside && filling_ == Filling::kSurface) return;
    if (cell.level == octree_.levels()) {
      spheres_.push_back({octree_.center(cell), radius_});
      return;
    }
    for (std::uint32_t k = 0; k < 8; ++k) {
      fill(inside ? CellOctree::child(cell, k) : octree_.cells()[cell.first_child + k]);
    }
  }

 private:
  const CellOctree& octree_;
  Filling filling_;
  double radius_;
  std::vector<Sphere>& spheres_;
};

}  // namespace

Voxelisation voxelise(const TriangleMesh& mesh, const VoxelisationOptions& options) {
  validate(mesh, "mesh");
  Voxelisation result;
  result.step = step_of(options);
  const CellOctree octree(mesh, result.step, options.padding);
  count(octree, options.filling, result);
  result.spheres.reserve(result.surface + result.inside);
  const double radius = options.sphere == VoxelSphere::kCircumscribed
                            ? octree.circumscribed(octree.levels())
                            : 0.5 * result.step;
  Filler(octree, options.filling, radius, result.spheres).fill(octree.cells().front());
  return result;
}

}  // namespace spherule
