// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/random_placement.h"

#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"
#include "spheretree/median_split.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// True only if a sphere of radius rho provably passes from one free sphere's centre to the other's.
bool passes(const Sphere& a, const Sphere& b, double rho) {
  return sub_down(add_down(a.radius, b.radius), distance_upper(a.center, b.center)) >= 2.0 * rho;
}

// Spheres that are not reached yet, in a binary hierarchy from which they can be taken out.
class Waiting {
 public:
  explicit Waiting(std::vector<Sphere> spheres)
      : spheres_(std::move(spheres)), taken_(spheres_.size()) {
    if (!spheres_.empty()) build(0, spheres_.size());
  }

  // Takes out every sphere that `sphere` passes to, and hands it to `visit`.
  template <typename Visit>
  void take(const Sphere& sphere, double rho, Visit visit) {
    if (!nodes_.empty()) take(0, sphere, rho, visit);
  }

 private:
  struct Node {
    Eigen::AlignedBox3d centers;
    double max_radius = 0.0;
    std::size_t begin = 0, end = 0;
    std::size_t right = 0;  // 0 marks a leaf
    std::size_t left_over = 0;
  };

  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    nodes_[self].begin = begin;
    nodes_[self].end = end;
    nodes_[self].left_over = end - begin;
    for (std::size_t i = begin; i < end; ++i) {
      nodes_[self].centers.extend(spheres_[i].center);
      nodes_[self].max_radius = std::max(nodes_[self].max_radius, spheres_[i].radius);
    }
    if (end - begin <= 8) return self;
    const Eigen::Index axis = internal::longest_axis(nodes_[self].centers);
    const std::size_t middle =
        begin + internal::split_at_median(std::span(spheres_).subspan(begin, end - begin),
                                          [axis](const Sphere& s) { return s.center[axis]; });
    build(begin, middle);
    const std::size_t right = build(middle, end);
    nodes_[self].right = right;
    return self;
  }

  template <typename Visit>
  void take(std::size_t index, const Sphere& sphere, double rho, Visit visit) {
    Node& node = nodes_[index];
    if (node.left_over == 0) return;
    // A bound with a margin far above the rounding: it only saves work.
    const double gap = node.centers.exteriorDistance(sphere.center);
    if (gap * (1.0 - 1e-12) > sphere.radius + node.max_radius - 2.0 * rho) return;
    if (node.right == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i) {
        if (taken_[i] || !passes(sphere, spheres_[i], rho)) continue;
        taken_[i] = true;
        --node.left_over;
        visit(spheres_[i]);
      }
      return;
    }
    take(index + 1, sphere, rho, visit);
    take(node.right, sphere, rho, visit);
    node.left_over = nodes_[index + 1].left_over + nodes_[node.right].left_over;
  }

  std::vector<Sphere> spheres_;
  std::vector<bool> taken_;
  std::vector<Node> nodes_;
};

}  // namespace

RandomPlacement place_random(const MeshDistance& distance, double padding, double rho,
                             const Eigen::AlignedBox3d& box, const ExternalOptions& options) {
  const auto report = [&](double share) {
    if (options.progress) options.progress(share, "placing external spheres");
  };
  const auto clearance = [&](const Vector3d& p) {
    return std::max(0.0, sub_down(distance(p).lower, padding));
  };
  const Vector3d margin = Vector3d::Constant(rho);
  const Eigen::AlignedBox3d field(box.min() - margin, box.max() + margin);
  Random random(options.seed);
  std::vector<Sphere> tried(options.limit);
  for (Sphere& s : tried) s.center = random.in(field);
  parallel_for(0, tried.size(),
               [&](std::size_t i) { tried[i].radius = clearance(tried[i].center); });
  std::erase_if(tried, [&](const Sphere& s) { return s.radius < rho; });
  report(0.6);

  // A sphere leaves the box if it passes straight on to the nearest face of the field, where a
  // sphere of radius rho is outside of the box.
  const auto leaves = [&](const Sphere& s) {
    int axis = 0;
    const double low = (s.center - field.min()).minCoeff(&axis);
    int high_axis = 0;
    const double high = (field.max() - s.center).minCoeff(&high_axis);
    Sphere exit = s;
    if (low <= high) {
      exit.center[axis] = field.min()[axis];
    } else {
      axis = high_axis;
      exit.center[axis] = field.max()[axis];
    }
    exit.radius = clearance(exit.center);
    return passes(s, exit, rho);
  };
  std::vector<char> first(tried.size());
  parallel_for(0, tried.size(), [&](std::size_t i) { first[i] = leaves(tried[i]) ? 1 : 0; });
  report(0.9);

  RandomPlacement result;
  result.attempts = options.limit;
  std::vector<Sphere> others;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    (first[i] != 0 ? result.spheres : others).push_back(tried[i]);
  }
  Waiting waiting(std::move(others));
  for (std::size_t i = 0; i < result.spheres.size(); ++i) {
    const Sphere sphere = result.spheres[i];
    waiting.take(sphere, rho, [&](const Sphere& reached) { result.spheres.push_back(reached); });
  }
  report(1.0);
  return result;
}

}  // namespace spherule::internal
