// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/random_placement.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/median_split.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

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

namespace {

using Eigen::Vector3d;

// Of the step.
constexpr double kGain = 0.06;
constexpr double kFinest = 0.2;

}  // namespace

std::vector<Sphere> ConcaveFitSpheres::operator()(const FloodGrid::Frontier& frontier) const {
  std::vector<Sphere> found;
  const Sphere& node = frontier.neighbour;
  const double to_surface = node.radius + padding_ + (frontier.center - node.center).norm();
  sample(frontier, frontier.center, to_surface, 0.5 * frontier.step, found);
  return found;
}

void ConcaveFitSpheres::sample(const FloodGrid::Frontier& frontier, const Vector3d& start,
                               double to_surface, double apart, std::vector<Sphere>& found) const {
  const Pushed here = pushed(frontier, start, to_surface, found);
  const bool is_found = here.sphere.radius > 0.0;
  if (is_found) found.push_back(here.sphere);
  const bool is_first = apart == 0.5 * frontier.step;
  if (!(is_found || (is_first && !here.is_flat)) || apart < kFinest * frontier.step) return;
  for (int k = 0; k < 8; ++k) {
    const Vector3d aside((k & 1) != 0 ? apart : -apart, (k & 2) != 0 ? apart : -apart,
                         (k & 4) != 0 ? apart : -apart);
    sample(frontier, start + aside, here.to_surface + aside.norm(), 0.5 * apart, found);
  }
}

ConcaveFitSpheres::Pushed ConcaveFitSpheres::pushed(const FloodGrid::Frontier& frontier,
                                                    const Vector3d& start, double to_surface,
                                                    std::span<const Sphere> found) const {
  constexpr int kMaxPushes = 6;
  const Vector3d& from = frontier.neighbour.center;
  const double rho = diameter_.on_segment(frontier.center, from);
  const double wanted = rho + 0.02 * frontier.step;
  Vector3d x = start;
  Pushed result;
  for (int push = 0; push <= kMaxPushes; ++push) {
    const SurfaceDistance d = distance_(x, to_surface * SphereDisplacement::kLimitUp);
    if (push == 0) result.to_surface = d.upper;
    const double clearance = sub_down(d.lower, padding_);
    if (clearance >= rho) {
      const Sphere sphere{x, clearance};
      const Sphere& node = frontier.neighbour;
      const bool reached = push > 0 && takes_something(sphere, start, frontier.step, node, found) &&
                           diameter_.on_segment(from, x) <= rho &&
                           displacement_.is_free(node, sphere, rho);
      if (reached) result.sphere = sphere;
      result.is_flat = push < 2;
      break;
    }
    const Vector3d away = x - d.closest;
    const double norm = away.norm();
    if (d.triangle < 0 || !(norm > 0.0)) break;
    x += away * ((wanted - clearance) / norm);
    to_surface = d.upper + (wanted - clearance);
    if ((x - start).norm() > 2.0 * frontier.step) break;
  }
  return result;
}

bool ConcaveFitSpheres::takes_something(const Sphere& sphere, const Vector3d& start, double step,
                                        const Sphere& node, std::span<const Sphere> found) const {
  const double enough = kGain * step;
  const Vector3d tip = sphere.center + sphere.radius * (start - sphere.center).normalized();
  const auto holds = [&](const Sphere& other) {
    return (tip - other.center).norm() - other.radius < enough;
  };
  if (holds(node) || std::ranges::any_of(found, holds)) return false;
  return !(reached_.nearest(tip, enough, enough).upper < enough);
}

}  // namespace spherule::internal
