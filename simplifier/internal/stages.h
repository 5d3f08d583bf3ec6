// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/types/simplification.h"

#include <cstddef>
#include <span>
#include <vector>

// The stages of simplify() over structures that they share: the public functions of the same names
// check the mesh and build them. `distance` is that of the mesh, which has passed validate(), and
// `clearance` that of its external spheres.

namespace spherule::internal {

// The grid is made with at most `most_grid_cells`, and made tight with at most options.max_cells.
ExternalSpheres place_external_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                       const ExternalOptions& options,
                                       std::size_t most_grid_cells = ExternalOptions::kMostCells);

// Stage 1 where D is a default: if the grid would have more than a quarter of the cells that it may
// have at most, D becomes larger until it has not. ExternalSpheres::min_external_diameter is the
// one that was used. Where D would be above a tenth of the diagonal of the box, or there are zones,
// whose cells are not foreseen, it stays as it is, and the grid may have as many cells as ever.
ExternalSpheres place_with_default_diameter(const TriangleMesh& mesh, const MeshDistance& distance,
                                            const ExternalOptions& options);

// simplified_solid(); the options have passed the checks of simplify().
SimplifiedSolid simplified_solid(const TriangleMesh& mesh, const MeshDistance& distance,
                                 const SimplifyOptions& options, std::size_t max_cells);

// simplify(), whose grid has at most `max_cells` (ExternalOptions::max_cells).
Simplification simplify(const TriangleMesh& mesh, const SimplifyOptions& options,
                        std::size_t max_cells);

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
