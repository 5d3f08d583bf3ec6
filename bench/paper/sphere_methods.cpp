// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/sphere_methods.h"

#include "bench/baseline/hubbard_spheres.h"
#include "bench/baseline/level_set_packing.h"
#include "bench/baseline/medial_axis.h"
#include "bench/baseline/octree_spheres.h"
#include "bench/baseline/sphere_packing.h"
#include "bench/baseline/voxelisation.h"
#include "geometry/mesh_report.h"
#include "simplifier/simplify.h"

#include <algorithm>
#include <cmath>

namespace spherule {
namespace {

constexpr double kAfterStage1 = 4.0;  // D over E
constexpr double kAsIs = 1.0;
constexpr int kEffort = 6;
// Hubbard's method is told a count: that of spheres of radius E side by side on the surface, at
// most.
constexpr double kMostSpheres = 5000.0;
constexpr double kLevelSetStep = 0.25;     // of E
constexpr double kCoverPointsApart = 0.2;  // of E
constexpr double kFewestCoverPoints = 10000.0;
constexpr double kMostCoverPoints = 30000.0;

std::vector<Sphere> bounding(const TriangleMesh& mesh, double error, CoverMethod method,
                             double diameter_over_error) {
  return simplify(mesh, {.max_error = error,
                         .min_external_diameter = diameter_over_error * error,
                         .method = method,
                         .effort = kEffort})
      .cover.spheres;
}

SphereMethod bounding_method(const char* name, CoverMethod method, double diameter_over_error) {
  return {name, [=](const TriangleMesh& mesh, double error) {
            return bounding(mesh, error, method, diameter_over_error);
          }};
}

double area_of(const TriangleMesh& mesh) {
  return mesh_report(mesh, {.self_intersections = false}).area;
}

// Between the points that have to be covered nothing is promised: many enough make it little.
std::vector<Sphere> medial(const TriangleMesh& mesh, double error) {
  MedialAxisOptions options{.max_protrusion = error};
  const double apart = kCoverPointsApart * error;
  options.sampling.cover_points = static_cast<std::size_t>(
      std::clamp(area_of(mesh) / (apart * apart), kFewestCoverPoints, kMostCoverPoints));
  return medial_axis(mesh, options).spheres;
}

std::vector<Sphere> hubbard(const TriangleMesh& mesh, double error) {
  const double spheres = std::clamp(area_of(mesh) / (error * error), 2.0, kMostSpheres);
  HubbardOptions options;
  options.counts = {static_cast<std::size_t>(spheres)};
  options.sites = std::max(options.sites, 2 * options.counts.front());
  return hubbard_spheres(mesh, options).levels.back();
}

}  // namespace

std::vector<SphereMethod> sphere_methods() {
  return {
      {"packing", [](const TriangleMesh& mesh,
                     double error) { return pack_spheres(mesh, {.max_error = error}).inflated; }},
      {"openvdb",
       [](const TriangleMesh& mesh, double error) {
         return level_set_packing(mesh, {.step = kLevelSetStep * error});
       }},
      {"voxels", [](const TriangleMesh& mesh,
                    double error) { return voxelise(mesh, {.max_error = error}).spheres; }},
      {"octree",
       [](const TriangleMesh& mesh, double error) {
         const SphereTree tree = octree_spheres(mesh, {.max_error = error}).tree;
         return std::vector<Sphere>(tree.spheres().begin(), tree.spheres().end());
       }},
      {"hubbard", hubbard},
      {"medial-axis", medial},
      bounding_method("paper", CoverMethod::kPaper, kAfterStage1),
      bounding_method("cover-as-is", CoverMethod::kCover, kAsIs),
      bounding_method("cover", CoverMethod::kCover, kAfterStage1),
  };
}

}  // namespace spherule
