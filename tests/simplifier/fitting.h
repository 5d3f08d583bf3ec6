// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Both stages of the simplifier with lengths as shares of the model's size, for tests that fit many
// models coarsely.

#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "tests/support/effort.h"

#include <Eigen/Geometry>

#include <ostream>
#include <span>
#include <string>

namespace spherule {

inline std::string name_of(CoverMethod method) {
  return method == CoverMethod::kPaper ? "paper" : "cover";
}

inline void PrintTo(CoverMethod method, std::ostream* out) {
  *out << name_of(method);
}

}  // namespace spherule

namespace spherule::test {

// Of the box of the vertices.
inline double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  return box.diagonal().norm();
}

inline CoverOptions options_for(CoverMethod method) {
  CoverOptions options;
  options.method = method;
  options.effort = effort(4, 1);
  return options;
}

struct Fit {
  ExternalSpheres external;
  SphereCover cover;
  double max_error = 0.0;
};

struct FitShares {
  double max_error = kSanitized ? 0.12 : 0.07;  // of the box diagonal
  double diameter = 4.0;                        // D, of E
  double padding = 0.0;                         // of E
  ExternalPlacement placement = ExternalPlacement::kReachable;
  int effort = test::effort(4, 1);
};

inline ExternalSpheres externals_of(const TriangleMesh& mesh, const FitShares& shares) {
  ExternalOptions options;
  options.placement = shares.placement;
  options.max_error = shares.max_error * diagonal_of(mesh);
  options.min_external_diameter = shares.diameter * options.max_error;
  options.padding = shares.padding * options.max_error;
  options.limit = 3000;
  return place_external_spheres(mesh, options);
}

// Fills in the error of `options` from the shares.
inline Fit fit(const TriangleMesh& mesh, CoverOptions options, const FitShares& shares = {}) {
  Fit result;
  result.external = externals_of(mesh, shares);
  result.max_error = options.max_error = shares.max_error * diagonal_of(mesh);
  options.effort = shares.effort;
  result.cover = cover(mesh, result.external, options);
  return result;
}

// Against the solid that was fitted, as closely as simplify() looks, and nothing but the proof.
inline Certificate certificate_of(const TriangleMesh& mesh, const Fit& fitted,
                                  std::span<const Sphere> spheres) {
  CertifyOptions options;
  options.external = &fitted.external;
  options.resolution = proof_resolution(fitted.max_error, diagonal_of(mesh));
  options.protrusion_tolerance = 0.0;
  options.volume = false;
  return certify(mesh, spheres, options);
}

}  // namespace spherule::test
