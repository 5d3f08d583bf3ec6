// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace spherule::internal {

// The least of |p - c| - r over a set of spheres: negative inside of the union, where its absolute
// value is the depth in the deepest sphere; outside, the distance to the union.
struct NearestSphere {
  double lower = std::numeric_limits<double>::infinity();  // bounds of the exact value
  double upper = std::numeric_limits<double>::infinity();
  std::int32_t index =
      -1;  // a sphere that attains it, up to rounding; -1 if none is nearer than requested
};

// Branch and bound over a binary hierarchy. What bounds a node is made for spheres that touch a
// surface, as external spheres do: where it is flat they have a half-space in common, however far
// their centres are from it, and where it turns about an axis, as along a rod or a rounded edge,
// they leave a cylinder free, whose axis is nearly as far from all of them. Immutable and safe to
// share between threads.
class SphereHierarchy {
 public:
  SphereHierarchy() = default;
  // Of any spheres: split in centre and radius; the wall that the spheres of a node touch is
  // guessed by regression, as their radii are then an affine function of their centres.
  explicit SphereHierarchy(std::span<const Sphere> spheres);
  // Of spheres that touch a surface, each in its point of `contacts` (which need not be exact:
  // wrong ones cost time only): split by contact and normal. Much faster where spheres are nearly
  // tied.
  SphereHierarchy(std::span<const Sphere> spheres, std::span<const Eigen::Vector3d> contacts);

  // Only values below `limit` are searched for; without one, both bounds are the limit. The search
  // may be content with a sphere that is up to `tolerance` worse than the nearest: many spheres are
  // nearly tied where they line a smooth surface, and the bounds are then that far apart.
  NearestSphere nearest(const Eigen::Vector3d& point,
                        double limit = std::numeric_limits<double>::infinity(),
                        double tolerance = 0.0) const;

  bool empty() const { return spheres_.empty(); }

 private:
  // The spheres [begin, end); the two children of an inner node stand side by side. In the frame of
  // a node (normal, axis, side) its centres lie in the box [low, high]; normal.x is at least
  // `offset`, and the distance of x from the line through `focus` along the axis at least `free`,
  // for every point x of its spheres.
  struct Node {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    Eigen::Vector3d low = Eigen::Vector3d::Zero();
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
    Eigen::Vector3d focus = Eigen::Vector3d::Zero();
    double offset = 0.0;
    double free = 0.0;
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
  // How a sphere intersects the surface.
  struct Touch {
    Eigen::Vector3d contact;
    Eigen::Vector3d normal;
  };

  void build(std::size_t self, const std::vector<Touch>& touches);
  std::span<const Entry> spheres_of(const Node& node) const;
  Eigen::Vector3d regressed_normal(const Node& node) const;
  void fit_cylinder(Node& node, const std::vector<Touch>& touches) const;
  void fit_box(Node& node, const Eigen::Vector3d& normal, const Eigen::Vector3d& axis) const;
  double bound(const Node& node, const Eigen::Vector3d& point, double enough) const;

  std::vector<Entry> spheres_;
  std::vector<Node> nodes_;
  double magnitude_ = 0.0;  // largest norm of a centre
};

}  // namespace spherule::internal
