// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// How far some spheres have to grow, each up to a limit of its own, so that given points are
// covered, with a small sum of growths. Plain double: it serves a search, never a proof.
class SphereInflation {
 public:
  // `limits`: the largest radius of every sphere, not below its own.
  SphereInflation(std::span<const Sphere> spheres, std::vector<double> limits);

  // Requires a point to be covered with the sphere of radius `reserve` about it, or as much of
  // that as the spheres allow. False if the radii as they are do so already.
  bool require(const Eigen::Vector3d& point, double reserve);
  // Grows all spheres that could come within `reach` of the point to their limits, for good. False
  // if they are there already.
  bool grow_fully_about(const Eigen::Vector3d& point, double reach);

  // Finds new radii for all that was requested: a point goes to the sphere that has to grow least
  // for it, those first that are hardest to reach; then spheres shrink to what they alone cover,
  // the ones that grew most first.
  void solve();

  // The spheres with the radii found last.
  std::vector<Sphere> spheres() const;

 private:
  struct Offer {
    std::uint32_t sphere;
    double radius;  // that the sphere needs
  };
  using Demand = std::vector<Offer>;  // one of these has to be met

  bool is_met(const Demand& demand) const;
  double inflation(const Offer& offer) const { return offer.radius - least_[offer.sphere]; }
  void shrink();

  std::vector<Sphere> spheres_;
  std::vector<double> least_;
  std::vector<double> limits_;
  std::vector<double> radii_;
  std::vector<Demand> demands_;
};

}  // namespace spherule::internal
