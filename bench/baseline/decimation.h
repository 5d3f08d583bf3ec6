// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Decimation by quadric error: not conservative. It cuts off what stands out and fills what is
// hollow, both unbounded by its estimate of the error; measure_deviation() tells by how much.
//
// @code{.cpp}
// #include <spherule/bench/baseline/decimation.h>
// #include <cassert>
//
// const spherule::TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
//                                     {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
// const spherule::Decimation reduced = spherule::decimate(square, {.target_triangles = 2});
// assert(reduced.mesh.triangles.size() == 2 && reduced.deviation.loss.upper < 0.01);
// @endcode

#include "bench/baseline/mesh_deviation.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace spherule {

// How far a mesh is reduced.
struct DecimationOptions {
  // How many triangles are wanted; the result has more where no collapse of an edge is allowed or
  // the error would pass max_error.
  std::size_t target_triangles = 1;
  // Largest estimated error, in the unit of the mesh; infinite: no limit.
  double max_error = std::numeric_limits<double>::infinity();
  // How the deviation is measured; nothing: not at all.
  std::optional<DeviationOptions> measure = DeviationOptions{};
};

// The reduced mesh, and how far it is from the original.
struct Decimation {
  TriangleMesh mesh;  // its vertices are vertices of the original, bit for bit
  // meshoptimizer's estimate: root of the mean square distance to the planes that met in a vertex.
  // No bound, and often far below the deviation.
  double estimated_error = 0.0;
  MeshDeviation deviation;  // measured; zero if not requested
};

// Decimates by edge collapses in order of their quadric error (Garland and Heckbert 1997), by
// meshoptimizer. A closed mesh stays closed in the sense of MeshReport (a collapse joins vertices,
// which takes no boundary in), but edges used by more than two triangles may appear. meshoptimizer
// works in 32-bit floats, relative to the box: equal input gives equal results. Triangles that fall
// together are left out. Throws Error for a mesh that validate() refuses, a target of zero, a
// max_error that is negative or NaN, an extent of zero, and if nothing of the mesh is left.
Decimation decimate(const TriangleMesh& mesh, const DecimationOptions& options);

}  // namespace spherule
