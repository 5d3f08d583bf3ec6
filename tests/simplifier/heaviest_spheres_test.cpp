// SPDX-License-Identifier: BSD-3-Clause
// What is said of the spheres that may cover a solid, held against many of them taken at random.
#include "simplifier/stage2/bound/cover_bound.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace spherule::internal {
namespace {

using test::cube_mesh;
using test::diagonal_of;
using test::effort;
using test::l_bracket;

using Eigen::Vector3d;

void check(const TriangleMesh& mesh, double max_error, double diameter) {
  const Clearance clearance(
      place_external_spheres(mesh, {.min_external_diameter = diameter, .max_error = max_error}));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto point_in = [&](double inflated) -> Vector3d {
    const Vector3d by = Vector3d::Constant(inflated);
    const Vector3d share(unit(random), unit(random), unit(random));
    return clearance.box().min() - by +
           share.cwiseProduct(Vector3d(clearance.box().sizes() + 2.0 * by));
  };
  std::vector<Vector3d> points;
  std::vector<double> weights;
  while (points.size() < 800) {
    // Onto the boundary of S, along which what spheres hold differs most.
    Vector3d p = point_in(0.0);
    const ClearanceAt at = clearance(p);
    if (at.lower < 0.0) continue;
    p -= at.away * at.lower;
    points.push_back(p);
    weights.push_back(unit(random) < 0.7 ? 0.0 : 0.2 * unit(random));
  }
  const HeaviestSpheres spheres(clearance, max_error, points);
  const HeaviestSpheres::Found found =
      spheres.find({.weights = weights, .finest = 0.1 * max_error, .news = 1.05});
  double heaviest = 0.0;
  for (int i = 0; i < effort(8000, 500); ++i) {
    Vector3d center = point_in(max_error);
    ClearanceAt at = clearance(center);
    // Away from the contact spheres grow, up to the medial axis.
    for (int step = 0; step < i % 4; ++step) {
      center += unit(random) * max_error * at.away;
      at = clearance(center);
    }
    const double radius = at.lower + max_error;
    double weight = 0.0;
    double divided = 0.0;
    double about = 1e9;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if ((points[k] - center).norm() > radius) continue;
      weight += weights[k];
      divided += weights[k] / found.about[k];
      about = std::min(about, found.about[k]);
    }
    EXPECT_LE(weight, about * (1.0 + 1e-9));
    EXPECT_LE(divided, 1.0 + 1e-9);
    heaviest = std::max(heaviest, weight);
  }
  // The spheres tried are heavy, and what is said of them is not idle.
  EXPECT_GT(heaviest, 1.2);
  EXPECT_LT(*std::max_element(found.about.begin(), found.about.end()), 1.5 * heaviest);
  EXPECT_FALSE(found.held.empty());
}

TEST(HeaviestSpheres, NoneInACubeIsHeavierThanSaid) {
  check(cube_mesh(), 0.15, 1.0);
}

TEST(HeaviestSpheres, NoneInAConcavePartIsHeavierThanSaid) {
  const TriangleMesh mesh = l_bracket();
  const double diagonal = diagonal_of(mesh);
  check(mesh, 0.06 * diagonal, 0.2 * diagonal);
}

}  // namespace
}  // namespace spherule::internal
