// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Points sorted into cubes, to find those in a sphere. Comparisons are plain double: this serves
// the search, never a proof.
class PointGrid {
 public:
  PointGrid(std::span<const Eigen::Vector3d> points, double edge)
      : points_(points.begin(), points.end()), edge_(edge) {
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
  }

  // Appends the indices of the points within `radius` of `center`, in a fixed order.
  void find(const Eigen::Vector3d& center, double radius, std::vector<std::uint32_t>& found) const {
    if (entries_.empty()) return;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
    const Index low = cube_of(center - reach);
    const Index high = cube_of(center + reach);
    const double squared = radius * radius;
    const Eigen::Array3d span = (high - low + 1).cast<double>();
    if (span.prod() > static_cast<double>(points_.size())) {
      for (std::uint32_t i = 0; i < points_.size(); ++i) {
        if ((points_[i] - center).squaredNorm() <= squared) found.push_back(i);
      }
      return;
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        const std::int64_t last = key({x, y, high[2]});
        auto e = std::lower_bound(
            entries_.begin(), entries_.end(), key({x, y, low[2]}),
            [](const Entry& entry, std::int64_t cube) { return entry.cube < cube; });
        for (; e != entries_.end() && e->cube <= last; ++e) {
          if ((e->point - center).squaredNorm() <= squared) found.push_back(e->index);
        }
      }
    }
  }

 private:
  using Index = Eigen::Array<std::int64_t, 3, 1>;
  struct Entry {
    std::int64_t cube;
    Eigen::Vector3d point;
    std::uint32_t index;
  };

  Index cube_of(const Eigen::Vector3d& p) const {
    const Eigen::Array3d cube = ((p - box_.min()) / edge_).array().floor();
    const Eigen::Array3d last = (size_ - 1).cast<double>();
    return cube.max(0.0).min(last).cast<std::int64_t>();
  }
  std::int64_t key(const Index& cube) const {
    return (cube[0] * size_[1] + cube[1]) * size_[2] + cube[2];
  }

  std::vector<Eigen::Vector3d> points_;
  double edge_;
  Eigen::AlignedBox3d box_;
  Index size_ = Index::Zero();
  std::vector<Entry> entries_;  // by cube; those of a row along z follow each other
};

}  // namespace spherule::internal
