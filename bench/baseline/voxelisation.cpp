// SPDX-License-Identifier: BSD-3-Clause
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/cell_octree.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/stage2/cover_moves.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
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

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Index = std::array<std::uint32_t, 3>;

[[noreturn]] void refuse(double step, double size, const std::string& reason) {
  std::ostringstream text;
  text << step << " for a model of size " << size << ": " << reason;
  throw Error("step", text.str());
}

}  // namespace

CellOctree::CellOctree(const TriangleMesh& mesh, double step, double padding) : step_(step) {
  place(mesh, padding);
  std::vector<Triangle> triangles;
  double largest_area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Triangle corners = corners_of(mesh, t);
    triangles.push_back(corners);
    largest_area = std::max(largest_area,
                            0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm());
  }
  // No plane cuts more out of a cube than the square root of two times a face.
  if (largest_area / step_ / step_ > 1.5 * static_cast<double>(kMaxCells)) refuse_count();
  std::vector<std::uint32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  cells_.push_back({});
  refine(0, triangles, all);
  flood();
}

void CellOctree::place(const TriangleMesh& mesh, double padding) {
  const Eigen::AlignedBox3d box = box_of(mesh);
  padding = add_up(padding, mesh.vertex_error);
  size_ = box.sizes().maxCoeff() + 2.0 * padding;
  if (!(step_ > 0.0 && step_ <= kMaxCoordinate)) refuse(step_, size_, "must be positive, finite");
  if (!(size_ / step_ < std::ldexp(1.0, kMostLevels))) {
    refuse(step_, size_, "more than 2^" + std::to_string(kMostLevels) + " cells along an axis");
  }
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  // The octree's edge is at most twice the sum of size and step.
  largest_ = farthest + 3.0 * (size_ + step_);
  if (step_ < kLeastStep * largest_) {
    refuse(step_, size_, "lost in the rounding of coordinates this large");
  }
  const double margin = 64.0 * kUnitRoundoff * largest_;
  reach_ = padding + margin;
  double most = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double count = std::floor((box.sizes()[k] + 2.0 * reach_) / step_) + 1.0;
    origin_[k] = box.center()[k] - 0.5 * count * step_;
    most = std::max(most, count);
  }
  while (std::ldexp(1.0, levels_) < most) ++levels_;
}

CellOctree::Cell CellOctree::child(const Cell& parent, std::uint32_t k) {
  Cell cell = parent;
  ++cell.level;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    cell.index[axis] = 2 * parent.index[axis] + (k >> axis & 1U);
  }
  return cell;
}

double CellOctree::edge(int level) const {
  return std::ldexp(step_, levels_ - level);
}

Vector3d CellOctree::center(const Cell& cell) const {
  const Index& i = cell.index;
  return origin_ + edge(cell.level) * Vector3d(i[0] + 0.5, i[1] + 0.5, i[2] + 0.5);
}

double CellOctree::circumscribed(int level) const {
  // Above half the diagonal in proportion, so that the difference of the radii of a cell and its
  // halves is above the distance of their centres.
  const double reserve = 0x1p-40 + 64.0 * kUnitRoundoff * largest_ / step_;
  return 0.8660254037844388 * edge(level) * (1.0 + reserve);
}

void CellOctree::refuse_count() const {
  refuse(step_, size_, "more than " + std::to_string(kMaxCells) + " cells");
}

void CellOctree::refine(std::uint32_t cell, const std::vector<Triangle>& triangles,
                        const std::vector<std::uint32_t>& near) {
  if (cells_[cell].level == levels_) {
    cells_[cell].state = State::kSurface;
    return;
  }
  if (cells_.size() + 8 > kMaxCells) refuse_count();
  const Cell parent = cells_[cell];
  const auto first = static_cast<std::uint32_t>(cells_.size());
  for (std::uint32_t k = 0; k < 8; ++k) cells_.push_back(child(parent, k));
  cells_[cell].first_child = first;
  cells_[cell].state = State::kRefined;
  const double half = 0.5 * edge(parent.level + 1) + reach_;
  for (std::uint32_t part = first; part < first + 8; ++part) {
    const Vector3d middle = center(cells_[part]);
    std::vector<std::uint32_t> here;
    std::copy_if(near.begin(), near.end(), std::back_inserter(here),
                 [&](std::uint32_t t) { return may_intersect(triangles[t], middle, half); });
    if (!here.empty()) refine(part, triangles, here);
  }
}

std::uint32_t CellOctree::locate(int level, const Index& index) const {
  std::uint32_t cell = 0;
  for (int l = 0; l < level && cells_[cell].state == State::kRefined; ++l) {
    const int shift = level - l - 1;
    cell = cells_[cell].first_child + ((index[0] >> shift & 1U) | (index[1] >> shift & 1U) << 1 |
                                       (index[2] >> shift & 1U) << 2);
  }
  return cell;
}

bool CellOctree::has_center_inside(const Cell& cell) const {
  const int shift = levels_ - cell.level;
  Index index;
  for (std::size_t k = 0; k < 3; ++k) {
    index[k] = (cell.index[k] << shift) + (std::uint32_t{1} << shift >> 1);
  }
  return cells_[locate(levels_, index)].state == State::kInside;
}

void CellOctree::flood() {
  // A face is examined from the cell that is not the coarser one.
  const auto around = static_cast<std::uint32_t>(cells_.size());
  DisjointSets sets(cells_.size() + 1);
  for (std::uint32_t i = 0; i < around; ++i) {
    const Cell& cell = cells_[i];
    if (cell.state != State::kOutside) continue;
    const std::uint32_t last = (std::uint32_t{1} << cell.level) - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const bool up : {false, true}) {
        Index index = cell.index;
        if (index[axis] == (up ? last : 0U)) {
          sets.unite(i, around);
          continue;
        }
        index[axis] += up ? 1U : static_cast<std::uint32_t>(-1);
        const std::uint32_t neighbour = locate(cell.level, index);
        if (cells_[neighbour].state == State::kOutside) sets.unite(i, neighbour);
      }
    }
  }
  for (std::uint32_t i = 0; i < around; ++i) {
    if (cells_[i].state == State::kOutside && sets.find(i) != sets.find(around)) {
      cells_[i].state = State::kInside;
    }
  }
}

}  // namespace spherule::internal
