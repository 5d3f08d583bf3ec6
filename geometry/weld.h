// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The same triangles over distinct vertices that are all used: vertices are one if their
// coordinates are equal bit for bit (zeros of both signs count as equal). In order of first use.
TriangleMesh weld(const TriangleMesh& mesh);

// Points sorted into cubes, to find those in a sphere. Comparisons are plain double: this serves
// the search, never a proof. Cubes have at least 2^-20 of the points' box diagonal, so that they
// can be counted.
class PointGrid {
 public:
  PointGrid(std::span<const Eigen::Vector3d> points, double edge) {
    for (const Eigen::Vector3d& p : points) box_.extend(p);
    if (points.empty()) return;
    edge_ = std::max(edge, 0x1p-20 * box_.diagonal().norm());
    largest_ = std::max(box_.min().lpNorm<Eigen::Infinity>(), box_.max().lpNorm<Eigen::Infinity>());
    const Eigen::Array3d extent = (box_.sizes() / edge_).array().floor();
    size_ = extent.cast<std::int64_t>() + 1;
    entries_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      entries_.push_back({key(cube_of(points[i])), points[i], i});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.cube != b.cube ? a.cube < b.cube : a.index < b.index;
    });
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const std::int64_t row = entries_[i].cube / size_[2];
      const Place xy = {row / size_[1], row % size_[1]};
      if (rows_.empty() || rows_.back().xy != xy) rows_.push_back({xy, i});
    }
  }

  // Appends the indices of the points within `radius` of `center`, in a fixed order.
  void find(const Eigen::Vector3d& center, double radius, std::vector<std::uint32_t>& found) const {
    if (entries_.empty()) return;
    // Far more than the roundings, by which a point may lie outside of its cube or the sphere.
    const double slack =
        1e-6 * edge_ + 1e-14 * (radius + largest_ + center.lpNorm<Eigen::Infinity>());
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius + slack);
    const Index low = cube_of(center - reach);
    const Index high = cube_of(center + reach);
    const double squared = radius * radius;
    for (auto row = row_from(rows_.begin(), {low[0], low[1]});
         row != rows_.end() && row->xy[0] <= high[0];) {
      const auto [x, y] = row->xy;
      if (y < low[1]) {
        row = row_from(row, {x, low[1]});
      } else if (y > high[1]) {
        row = row_from(row, {x + 1, low[1]});
      } else {
        const double left =
            squared - squared_gap(center, 0, x, slack) - squared_gap(center, 1, y, slack);
        if (left >= 0.0) find_in(row, center, squared, std::sqrt(left) + slack, found);
        ++row;
      }
    }
  }

 private:
  using Index = Eigen::Array<std::int64_t, 3, 1>;
  using Place = std::array<std::int64_t, 2>;
  struct Entry {
    std::int64_t cube;
    Eigen::Vector3d point;
    std::uint32_t index;
  };
  // Cubes with the same x and y that hold points.
  struct Row {
    Place xy;
    std::size_t first;  // of the entries
  };
  using Rows = std::vector<Row>;

  Rows::const_iterator row_from(Rows::const_iterator begin, const Place& xy) const {
    return std::lower_bound(begin, rows_.end(), xy,
                            [](const Row& row, const Place& least) { return row.xy < least; });
  }

  // The points of a row in the sphere, whose chord there is at most twice `half`.
  void find_in(Rows::const_iterator row, const Eigen::Vector3d& center, double squared, double half,
               std::vector<std::uint32_t>& found) const {
    const auto [x, y] = row->xy;
    const std::int64_t low = key({x, y, cube_along(2, center[2] - half)});
    const std::int64_t high = key({x, y, cube_along(2, center[2] + half)});
    const std::size_t next = row + 1 == rows_.end() ? entries_.size() : (row + 1)->first;
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(next);
    auto e =
        std::lower_bound(entries_.begin() + static_cast<std::ptrdiff_t>(row->first), end, low,
                         [](const Entry& entry, std::int64_t cube) { return entry.cube < cube; });
    for (; e != end && e->cube <= high; ++e) {
      if ((e->point - center).squaredNorm() <= squared) found.push_back(e->index);
    }
  }

  // A lower bound of the squared distance from a place to the cubes with that index along an axis.
  double squared_gap(const Eigen::Vector3d& center, int axis, std::int64_t index,
                     double slack) const {
    const double from = center[axis] - box_.min()[axis] - static_cast<double>(index) * edge_;
    const double gap = std::max({-from, from - edge_, slack}) - slack;
    return gap * gap;
  }

  Index cube_of(const Eigen::Vector3d& p) const {
    return {cube_along(0, p[0]), cube_along(1, p[1]), cube_along(2, p[2])};
  }
  std::int64_t cube_along(int axis, double coordinate) const {
    const double cube = std::floor((coordinate - box_.min()[axis]) / edge_);
    return static_cast<std::int64_t>(std::clamp(cube, 0.0, static_cast<double>(size_[axis] - 1)));
  }
  std::int64_t key(const Index& cube) const {
    return (cube[0] * size_[1] + cube[1]) * size_[2] + cube[2];
  }

  double edge_ = 0.0;
  double largest_ = 0.0;  // of the coordinates
  Eigen::AlignedBox3d box_;
  Index size_ = Index::Zero();
  std::vector<Entry> entries_;  // by cube; those of a row follow each other
  Rows rows_;
};

}  // namespace spherule::internal
