// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/voronoi.h"

#include "tests/support/random.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::voronoi_vertices;
using internal::VoronoiVertex;
using Real = long double;
using Vector3l = Eigen::Matrix<Real, 3, 1>;

Eigen::AlignedBox3d unit_box() {
  return {Vector3d::Zero(), Vector3d::Ones()};
}

std::vector<Vector3d> random_sites(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector3d> sites;
  for (std::size_t i = 0; i < count; ++i) sites.push_back(random.in_box(unit_box()));
  return sites;
}

// By all distances, in extended precision: no site is inside, and at least four are on the
// boundary.
void expect_empty_and_touching(const std::vector<Vector3d>& sites, double tolerance) {
  for (const VoronoiVertex& v : voronoi_vertices(sites)) {
    int touching = 0;
    for (const Vector3d& site : sites) {
      const Real gap =
          (site.cast<Real>() - v.point.cast<Real>()).norm() - static_cast<Real>(v.radius);
      ASSERT_GE(gap, -tolerance);
      if (gap <= tolerance) ++touching;
    }
    EXPECT_GE(touching, 4);
  }
}

TEST(Voronoi, SpheresAreEmptyAndTouchFourSites) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const std::vector<Vector3d> sites = random_sites(300, seed);
    EXPECT_GT(voronoi_vertices(sites).size(), 1000U);
    expect_empty_and_touching(sites, 1e-8);
  }
}

// Every set of four sites in turn: those whose sphere is empty, and centre in the box of the sites.
std::vector<std::array<std::uint32_t, 4>> all_empty_spheres(const std::vector<Vector3d>& sites) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : sites) box.extend(p);
  std::vector<std::array<std::uint32_t, 4>> found;
  const auto count = static_cast<std::uint32_t>(sites.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      for (std::uint32_t c = b + 1; c < count; ++c) {
        for (std::uint32_t d = c + 1; d < count; ++d) {
          // The centre is equally far from a and each of the others.
          Eigen::Matrix<Real, 3, 3> rows;
          Vector3l right;
          const Vector3l first = sites[a].cast<Real>();
          int k = 0;
          for (const std::uint32_t other : {b, c, d}) {
            const Vector3l edge = sites[other].cast<Real>() - first;
            rows.row(k) = edge.transpose();
            right[k++] = edge.squaredNorm() / 2;
          }
          const Vector3l offset = rows.inverse() * right;
          const Vector3l center = first + offset;
          if (!box.contains(center.cast<double>())) continue;
          const bool empty = std::all_of(sites.begin(), sites.end(), [&](const Vector3d& p) {
            return (p.cast<Real>() - center).norm() >= offset.norm() * (1 - 1e-12L);
          });
          if (empty) found.push_back({a, b, c, d});
        }
      }
    }
  }
  return found;
}

TEST(Voronoi, FindsEveryEmptySphereInTheBox) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    const std::vector<Vector3d> sites = random_sites(24, seed);
    std::vector<std::array<std::uint32_t, 4>> found;
    for (const VoronoiVertex& v : voronoi_vertices(sites)) found.push_back(v.sites);
    EXPECT_EQ(found, all_empty_spheres(sites));
  }
}

TEST(Voronoi, BearsManySitesOnOneSphere) {
  std::vector<Vector3d> grid;
  for (int i = 0; i < 64; ++i) grid.emplace_back(i % 4, i / 4 % 4, i / 16);
  expect_empty_and_touching(grid, 1e-8);
  std::vector<VoronoiVertex> vertices = voronoi_vertices(grid);
  // The middles of the 27 cubes and nothing else.
  std::sort(vertices.begin(), vertices.end(), [](const VoronoiVertex& a, const VoronoiVertex& b) {
    return std::lexicographical_compare(a.point.begin(), a.point.end(), b.point.begin(),
                                        b.point.end());
  });
  std::vector<Vector3d> places;
  for (const VoronoiVertex& v : vertices) {
    const auto is_known = [&](const Vector3d& p) { return (p - v.point).norm() < 1e-6; };
    if (std::none_of(places.begin(), places.end(), is_known)) places.push_back(v.point);
  }
  EXPECT_EQ(places.size(), 27U);
}

TEST(Voronoi, BearsSitesThatOccurTwice) {
  std::vector<Vector3d> sites = random_sites(60, 8);
  const std::size_t count = voronoi_vertices(sites).size();
  sites.insert(sites.end(), sites.begin(), sites.begin() + 30);
  expect_empty_and_touching(sites, 1e-8);
  EXPECT_EQ(voronoi_vertices(sites).size(), count);
}

TEST(Voronoi, HasNothingToSayWithoutTetrahedra) {
  EXPECT_TRUE(voronoi_vertices({}).empty());
  EXPECT_TRUE(voronoi_vertices(std::vector<Vector3d>(9, Vector3d::Ones())).empty());
  std::vector<Vector3d> flat = random_sites(50, 9);
  for (Vector3d& p : flat) p.z() = 0.25;
  EXPECT_TRUE(voronoi_vertices(flat).empty());
  std::vector<Vector3d> line = random_sites(50, 10);
  for (Vector3d& p : line) p = Vector3d::Constant(p.x());
  EXPECT_TRUE(voronoi_vertices(line).empty());
}

TEST(Voronoi, BearsSitesFarFromTheOrigin) {
  std::vector<Vector3d> sites = random_sites(200, 11);
  const std::size_t count = voronoi_vertices(sites).size();
  for (Vector3d& p : sites) p += Vector3d(1e7, -2e7, 3e7);
  expect_empty_and_touching(sites, 1e-6);
  EXPECT_NEAR(static_cast<double>(voronoi_vertices(sites).size()), static_cast<double>(count),
              0.02 * static_cast<double>(count));
}

}  // namespace
}  // namespace spherule::test
