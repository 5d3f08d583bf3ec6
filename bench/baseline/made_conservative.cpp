// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/sphere_methods.h"

#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/medial_spheres.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/solid/cells.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/paper/internal_spheres.h"

#include <algorithm>
#include <set>

namespace spherule {

ConservativeSpheres made_conservative(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                      double padding, int threads, const Progress& progress) {
  if (spheres.empty()) throw Error("spheres", "there is none that could grow");
  const CertifyOptions options{.padding = padding, .threads = threads, .progress = progress};
  ConservativeSpheres result;
  result.spheres.assign(spheres.begin(), spheres.end());
  result.certificate = certify(mesh, spheres, options);
  if (result.certificate.covered) return result;
  // A piece of the proof's finest size lies in one sphere only if it has room to spare there.
  const double piece = options.resolution * internal::box_of(mesh).diagonal().norm();
  result.inflation = add_up(result.certificate.uncovered_depth.upper, piece);
  for (Sphere& sphere : result.spheres) {
    sphere.radius = add_up(sphere.radius, result.inflation);
    if (!is_usable(sphere)) throw Error("spheres", "too far from the mesh to be grown over it");
  }
  result.certificate = certify(mesh, result.spheres, options);
  return result;
}

}  // namespace spherule

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Shares of E: half diagonal of cells; how far apart points on edges are, and how deep inside of S
// at most.
constexpr double kCells = 0.4;
constexpr double kEdgeSpacing = 0.4;
constexpr double kAtBoundary = 0.2;

constexpr double kMostEdgePoints = 1e6;

const TriangleMesh& checked(const TriangleMesh& mesh, const CoverOptions& options,
                            const std::string& method) {
  validate(mesh, "mesh");
  check_options(options);
  refuse_error_zones(options, method);
  return mesh;
}

const Clearance& checked(const Clearance& clearance, double max_error) {
  check_resolved(clearance, max_error, kErrorTolerance);
  return clearance;
}

}  // namespace

SimplifiedSolid::SimplifiedSolid(const TriangleMesh& mesh, const ExternalSpheres& external,
                                 const CoverOptions& options, const std::string& method)
    : max_error(options.max_error),
      distance(checked(mesh, options, method)),
      clearance(external),
      everywhere(max_error, {}),
      cells(checked(clearance, max_error), distance, everywhere, max_error, kCells) {}

std::vector<Vector3d> SimplifiedSolid::samples(const TriangleMesh& mesh) const {
  std::vector<Vector3d> points = cells.sample();
  const double spacing = kEdgeSpacing * max_error;
  const double count = std::clamp(total_area(mesh) / (spacing * spacing), 1.0, kMostEdgePoints);
  std::set<Cube> taken;
  for (const Vector3d& p : edge_samples(mesh, static_cast<std::size_t>(count))) {
    if (!taken.insert(cube_of(p, spacing)).second) continue;
    const ClearanceAt at = clearance(p, max_error);
    if (at.lower <= kAtBoundary * max_error) points.push_back(p);
  }
  if (points.empty()) {
    points.push_back(mesh.vertices[static_cast<std::size_t>(mesh.triangles.front()[0])]);
  }
  return points;
}

}  // namespace spherule::internal
