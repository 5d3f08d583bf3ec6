// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/certificate.h"
#include "simplifier/cover.h"
#include "simplifier/external_spheres.h"
#include "simplifier/levels.h"
#include "simplifier/solid/clearance.h"

#include <cstddef>
#include <span>
#include <vector>

// The stages of simplify() over structures that they share: the public functions of the same names
// check the mesh and build them. `distance` is that of the mesh, which has passed validate(), and
// `clearance` that of its external spheres.

namespace spherule::internal {

ExternalSpheres place_external_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                       const ExternalOptions& options);

// The same where D is a default: if the grid would have too many cells, more than a quarter of what
// a D that was requested may take, D becomes larger until it has not, up to a tenth of the diagonal
// of the box. ExternalSpheres::min_external_diameter is the
// one that was used. With zones of their own D it stays as it is: their cells are not foreseen.
ExternalSpheres place_with_default_diameter(const TriangleMesh& mesh, const MeshDistance& distance,
                                            ExternalOptions options);

// A solid that is divided into more cells than this for kCover is covered in blocks
// (cover_blocks.h).
inline constexpr std::size_t kMostCells = 100000;

SphereCover cover(const TriangleMesh& mesh, const MeshDistance& distance,
                  const Clearance& clearance, const CoverOptions& options,
                  std::size_t most_cells = kMostCells);

std::vector<CoverLevel> fit_levels(const MeshDistance& distance, const Clearance& clearance,
                                   std::span<const Sphere> spheres,
                                   std::span<const double> max_errors, const CoverOptions& options);

// With external spheres given in the options.
Certificate certify(const TriangleMesh& mesh, const MeshDistance& distance,
                    const Clearance& clearance, std::span<const Sphere> spheres,
                    const CertifyOptions& options);

}  // namespace spherule::internal
