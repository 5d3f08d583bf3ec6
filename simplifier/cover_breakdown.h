// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where the count of a cover goes.

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/simplification.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// What a sphere of a cover is there for, by what it alone covers.
enum class SphereRole {
  kEdge,   // points of a sharp convex edge of M that lies on the boundary of S
  kThin,   // boundary of S where S is thin: the outside is within 2 E of the centre on both sides
  kFace,   // other boundary of S, flat or curved
  kInside  // no point of the boundary: the deep inside, or nothing
};

// What the spheres of a cover stand for, and how many of each.
struct CoverBreakdown {
  std::vector<SphereRole> roles;  // of each sphere: the first in the order above that fits
  std::size_t edges = 0;
  std::size_t thin = 0;
  std::size_t faces = 0;
  std::size_t inside = 0;
};

// Where the count of a cover of S goes, judged at sample points about E / 4 apart on edges and E /
// 2 elsewhere; no proof. An edge is sharp where its faces meet at 150 degrees or less, or where a
// sheet ends; convex where S does not go on beyond it. (Along such an edge the best sphere covers
// no more than a few E, so these spheres only become fewer with a larger E.) Deterministic. Throws
// Error for a mesh that validate() refuses, spheres that are not usable (external ones, too) and
// for a max_error that is not positive and finite.
CoverBreakdown cover_breakdown(const TriangleMesh& mesh, const ExternalSpheres& external,
                               std::span<const Sphere> spheres, double max_error, int threads = 0);

// How many spheres have their centre within E of the outside of S (up to the rounding of
// clearances): in a cover by cover() these are the spheres of walls thinner than 2 E, which are
// larger than the wall. Of these there are many: a plate of area A and thickness t takes A / (2.6
// (E^2 + E t)) even if discs cover it perfectly. "Sphere packing is not suited to models which are
// long, wide and narrow such as a thin plate" (the paper, section III). cover_breakdown() looks
// closer, at both sides of the wall. Throws Error for spheres that are not usable (external ones,
// too) and for a max_error that is not positive and finite.
std::size_t spheres_in_thin_parts(const ExternalSpheres& external, std::span<const Sphere> spheres,
                                  double max_error);

}  // namespace spherule
