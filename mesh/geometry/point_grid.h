// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Points sorted into cubes, to find those in a sphere. Comparisons are plain double: this serves
// the search, never a proof.
class PointGrid {
 public:
  PointGrid(std::span<const Eigen::Vector3d> points, double edge) : edge_(edge) {
    for (const Eigen::Vector3d& p : points) box_.extend(p);
    if (points.empty()) return;
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
      const Column xy = {row / size_[1], row % size_[1]};
      if (rows_.empty() || rows_.back().xy != xy) rows_.push_back({xy, i});
    }
  }

  // Appends the indices of the points within `radius` of `center`, in a fixed order.
  void find(const Eigen::Vector3d& center, double radius, std::vector<std::uint32_t>& found) const {
    if (entries_.empty()) return;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
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
        const double left = squared - squared_gap(center, 0, x) - squared_gap(center, 1, y);
        if (left >= 0.0) find_in(row, center, squared, std::sqrt(left) + kSlack * edge_, found);
        ++row;
      }
    }
  }

 private:
  using Index = Eigen::Array<std::int64_t, 3, 1>;
  using Column = std::array<std::int64_t, 2>;
  struct Entry {
    std::int64_t cube;
    Eigen::Vector3d point;
    std::uint32_t index;
  };
  // Cubes with the same x and y that hold points.
  struct Row {
    Column xy;
    std::size_t first;  // of the entries
  };
  using Rows = std::vector<Row>;
  // Of the edge: far more than the roundings by which a point may lie outside of its cube.
  static constexpr double kSlack = 1e-6;

  Rows::const_iterator row_from(Rows::const_iterator begin, const Column& xy) const {
    return std::lower_bound(begin, rows_.end(), xy,
                            [](const Row& row, const Column& least) { return row.xy < least; });
  }

  // The points of a row in the sphere, whose chord there is at most twice `half`.
  void find_in(Rows::const_iterator row, const Eigen::Vector3d& center, double squared, double half,
               std::vector<std::uint32_t>& found) const {
    const Eigen::Vector3d chord(0.0, 0.0, half);
    const auto [x, y] = row->xy;
    const std::int64_t low = key({x, y, cube_of(center - chord)[2]});
    const std::int64_t high = key({x, y, cube_of(center + chord)[2]});
    const std::size_t next = row + 1 == rows_.end() ? entries_.size() : (row + 1)->first;
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(next);
    auto e =
        std::lower_bound(entries_.begin() + static_cast<std::ptrdiff_t>(row->first), end, low,
                         [](const Entry& entry, std::int64_t cube) { return entry.cube < cube; });
    for (; e != end && e->cube <= high; ++e) {
      if ((e->point - center).squaredNorm() <= squared) found.push_back(e->index);
    }
  }

  // From a place to the cubes with that index along an axis, at most.
  double squared_gap(const Eigen::Vector3d& center, int axis, std::int64_t index) const {
    const double from = center[axis] - box_.min()[axis] - static_cast<double>(index) * edge_;
    const double gap = std::max({-from, from - edge_, kSlack * edge_}) - kSlack * edge_;
    return gap * gap;
  }

  Index cube_of(const Eigen::Vector3d& p) const {
    const Eigen::Array3d cube = ((p - box_.min()) / edge_).array().floor();
    const Eigen::Array3d last = (size_ - 1).cast<double>();
    return cube.max(0.0).min(last).cast<std::int64_t>();
  }

  std::int64_t key(const Index& cube) const {
    return (cube[0] * size_[1] + cube[1]) * size_[2] + cube[2];
  }

  double edge_;
  Eigen::AlignedBox3d box_;
  Index size_ = Index::Zero();
  std::vector<Entry> entries_;  // by cube; those of a row follow each other
  Rows rows_;
};

}  // namespace spherule::internal
