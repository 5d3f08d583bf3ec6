// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What the tests of the simplifier share: both stages with lengths as shares of the model's size,
// for those that fit many models coarsely; refusals; hashes of spheres.

#include "base/crc64.h"
#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "tests/support/effort.h"

#include <Eigen/Geometry>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
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

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// As effort(), of numbers of samples.
constexpr std::size_t samples(int count, int under_sanitizers) {
  return static_cast<std::size_t>(effort(count, under_sanitizers));
}

// The subject of the Error that the call ends in.
template <class Call>
std::string refused(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.subject();
  }
  return "accepted";
}

// The whole of its message.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

// Of the bits of all numbers, the lowest byte first.
inline std::uint64_t hash_of(std::span<const Sphere> spheres) {
  std::string bytes;
  for (const Sphere& s : spheres) {
    for (const double x : {s.center.x(), s.center.y(), s.center.z(), s.radius}) {
      const auto bits = std::bit_cast<std::uint64_t>(x);
      for (int shift = 0; shift < 64; shift += 8) {
        bytes.push_back(static_cast<char>(static_cast<unsigned char>(bits >> shift)));
      }
    }
  }
  return crc64(bytes);
}

// A solid without external spheres: the box of the mesh.
inline ExternalSpheres box_of(const TriangleMesh& mesh) {
  return place_external_spheres(mesh, {.placement = ExternalPlacement::kNone});
}

// Of the box of the vertices.
inline double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  return box.diagonal().norm();
}

inline CoverOptions options_for(CoverMethod method) {
  return {.method = method, .effort = effort(4, 1)};
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
  const double max_error = shares.max_error * diagonal_of(mesh);
  return place_external_spheres(mesh, {.placement = shares.placement,
                                       .min_external_diameter = shares.diameter * max_error,
                                       .padding = shares.padding * max_error,
                                       .max_error = max_error,
                                       .limit = 3000});
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
  return certify(mesh, spheres,
                 {.external = &fitted.external,
                  .resolution = proof_resolution(fitted.max_error, diagonal_of(mesh)),
                  .protrusion_tolerance = 0.0,
                  .volume = false});
}

}  // namespace spherule::test
