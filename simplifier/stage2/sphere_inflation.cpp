// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/sphere_inflation.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace spherule::internal {

using Eigen::Vector3d;

SphereInflation::SphereInflation(std::span<const Sphere> spheres, std::vector<double> limits)
    : spheres_(spheres.begin(), spheres.end()), limits_(std::move(limits)) {
  for (const Sphere& sphere : spheres_) least_.push_back(sphere.radius);
  radii_ = least_;
}

bool SphereInflation::require(const Vector3d& point, double reserve) {
  std::vector<double> distance(spheres_.size());
  double most = -std::numeric_limits<double>::infinity();  // of the point's depth
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    distance[i] = (spheres_[i].center - point).norm();
    most = std::max(most, limits_[i] - distance[i]);
  }
  reserve = std::min(reserve, most);
  Demand demand;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const double needed = distance[i] + reserve;
    // The sphere that sets `most` is meant to offer itself whatever the rounding.
    if (needed <= limits_[i] || limits_[i] - distance[i] == most) {
      demand.push_back({static_cast<std::uint32_t>(i), std::min(needed, limits_[i])});
    }
  }
  if (demand.empty() || is_met(demand)) return false;
  std::sort(demand.begin(), demand.end(), [&](const Offer& a, const Offer& b) {
    return std::pair(inflation(a), a.sphere) < std::pair(inflation(b), b.sphere);
  });
  demands_.push_back(std::move(demand));
  return true;
}

bool SphereInflation::grow_fully_about(const Vector3d& point, double reach) {
  bool any = false;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    if ((spheres_[i].center - point).norm() > limits_[i] + reach) continue;
    any = any || least_[i] < limits_[i];
    least_[i] = limits_[i];
  }
  return any;
}

bool SphereInflation::is_met(const Demand& demand) const {
  return std::ranges::any_of(demand, [&](const Offer& o) { return radii_[o.sphere] >= o.radius; });
}

void SphereInflation::solve() {
  radii_ = least_;
  std::vector<std::size_t> order(demands_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return inflation(demands_[a].front()) > inflation(demands_[b].front());
  });
  for (const std::size_t d : order) {
    if (is_met(demands_[d])) continue;
    const auto cheapest = std::ranges::min_element(
        demands_[d], {}, [&](const Offer& o) { return o.radius - radii_[o.sphere]; });
    radii_[cheapest->sphere] = cheapest->radius;
  }
  shrink();
}

void SphereInflation::shrink() {
  std::vector<std::vector<std::pair<std::uint32_t, double>>> offers_of(spheres_.size());
  std::vector<std::uint32_t> times(demands_.size(), 0);
  for (std::size_t d = 0; d < demands_.size(); ++d) {
    for (const Offer& o : demands_[d]) {
      offers_of[o.sphere].emplace_back(static_cast<std::uint32_t>(d), o.radius);
      if (radii_[o.sphere] >= o.radius) ++times[d];
    }
  }
  std::vector<std::size_t> order(spheres_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return radii_[a] - least_[a] > radii_[b] - least_[b];
  });
  for (const std::size_t i : order) {
    double needed = least_[i];
    for (const auto& [d, radius] : offers_of[i]) {
      if (radii_[i] >= radius && times[d] == 1) needed = std::max(needed, radius);
    }
    for (const auto& [d, radius] : offers_of[i]) {
      if (radii_[i] >= radius && needed < radius) --times[d];
    }
    radii_[i] = needed;
  }
}

std::vector<Sphere> SphereInflation::spheres() const {
  std::vector<Sphere> inflated(spheres_);
  for (std::size_t i = 0; i < inflated.size(); ++i) inflated[i].radius = radii_[i];
  return inflated;
}

}  // namespace spherule::internal
