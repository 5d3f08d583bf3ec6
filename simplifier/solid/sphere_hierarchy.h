// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/nearest_sphere.h"
#include "spheretree/sphere.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace spherule::internal {

// Branch and bound over a binary hierarchy. What bounds a node is made for spheres that touch a
// surface, as external spheres do: where it is flat they have a half-space in common, however far
// their centres are from it. Immutable and safe to share between threads.
class SphereHierarchy {
 public:
  SphereHierarchy() = default;
  // Of any spheres, built by several threads where these are many: split in centre and radius; the
  // wall that the spheres of a node touch is guessed by regression, as their radii are then an
  // affine function of their centres.
  explicit SphereHierarchy(std::span<const Sphere> spheres);

  // Only values below `limit` are searched for; without one, both bounds are the limit. Without a
  // tolerance, the bounds are those of LeastGap. The search may be content with a sphere that is up
  // to `tolerance` worse than the nearest: many spheres are nearly tied where they line a smooth
  // surface, and the bounds are then that far apart.
  NearestSphere nearest(const Eigen::Vector3d& point,
                        double limit = std::numeric_limits<double>::infinity(),
                        double tolerance = 0.0) const;

  // Whether the value of a sphere, as LeastGap computes it, is below `value`.
  bool is_any_nearer(const Eigen::Vector3d& point, double value) const;

  // Calls visit(index) for all spheres whose value at some point of the cell, as LeastGap computes
  // it, is at most `value` + slope . (point - centre of the cell), and some others, in a fixed
  // order, until it returns false. The slope is no longer than 1.
  void for_each_below(const BoxCell& cell, double value, const Eigen::Vector3d& slope,
                      const std::function<bool(std::int32_t)>& visit) const;

  // At least |p|, the largest norm of a centre and the largest radius in all; 0 for no spheres.
  double length_at(const Eigen::Vector3d& point) const;

  bool empty() const { return spheres_.empty(); }

 private:
  // The spheres [begin, end); the two children of an inner node stand side by side. In the frame of
  // a node (normal, axis, side) its centres lie in the box [low, high]; normal.x is at least
  // `offset` for every point x of its spheres.
  struct Node {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    Eigen::Vector3d low = Eigen::Vector3d::Zero();
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
    double offset = 0.0;
    double min_radius = 0.0;
    double max_radius = 0.0;
    std::int32_t children = -1;  // the first; negative for a leaf
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Entry {
    Sphere sphere;
    std::int32_t index;
  };

  // The subtree of the node `self`; its two children are stored at `children`, their descendants
  // from `children` + 2 on.
  void build(std::size_t self, std::size_t children);
  std::span<const Entry> spheres_of(const Node& node) const;
  void fit_box(Node& node, const Eigen::Vector3d& normal) const;
  // Branch and bound, nearer children first, until is_done() after a leaf.
  template <typename Done>
  void search(const Eigen::Vector3d& point, double tolerance, LeastGap& least,
              const Done& is_done) const;
  // True only if all values of the node are above the affine function of for_each_below() all over
  // the cell.
  bool is_above(const Node& node, const BoxCell& cell, double value,
                const Eigen::Vector3d& slope) const;
  double bound(const Node& node, const Eigen::Vector3d& point, double enough) const;

  std::vector<Entry> spheres_;
  std::vector<Node> nodes_;
  double magnitude_ = 0.0;  // largest norm of a centre
};

}  // namespace spherule::internal
