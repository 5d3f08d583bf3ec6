// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/part_query.h"

#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "geometry/point_triangle.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace spherule::fcl_api::internal {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

// Two spheres in the world and the unit vector from the first centre to the second.
struct PlacedSpheres {
  PlacedSpheres(const PlacedPart& a, const PlacedPart& b, const SpherePair& pair) {
    const auto sphere = [](const PlacedPart& placed, std::int32_t index) {
      return placed.part.spheres->spheres()[static_cast<std::size_t>(index)];
    };
    first = sphere(a, pair.a);
    second = sphere(b, pair.b);
    first.center = a.world_from_part * first.center;
    second.center = b.world_from_part * second.center;
    const Eigen::Vector3d way = second.center - first.center;
    distance = way.norm();
    if (distance > 0.0) direction = way / distance;
  }

  Sphere first, second;
  double distance = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

PartContact contact_of_spheres(const PlacedPart& a, const PlacedPart& b, const SpherePair& pair,
                               bool details) {
  PartContact contact{.b1 = pair.a, .b2 = pair.b};
  if (!details) return contact;
  const PlacedSpheres spheres(a, b, pair);
  // Where on the way from centre to centre the two spheres begin and end.
  const double begin = std::max(-spheres.first.radius, spheres.distance - spheres.second.radius);
  const double end = std::min(spheres.first.radius, spheres.distance + spheres.second.radius);
  contact.normal = spheres.direction;
  contact.point = spheres.first.center + 0.5 * (begin + end) * spheres.direction;
  contact.depth = std::max(0.0, spheres.first.radius + spheres.second.radius - spheres.distance);
  return contact;
}

Triangle placed_triangle(const PlacedPart& placed, std::int32_t index) {
  Triangle triangle = placed.part.mesh->mesh().triangle(index);
  for (Eigen::Vector3d& corner : triangle) corner = placed.world_from_part * corner;
  return triangle;
}

// A point of two triangles that touch, up to rounding: where an edge of one intersects the plane of
// the other, or a corner, whichever is nearest to the other triangle. (Two in one plane that share
// no corner: a point between the two.)
Eigen::Vector3d common_point(const Triangle& a, const Triangle& b) {
  Eigen::Vector3d best = a[0];
  double least = std::numeric_limits<double>::infinity();
  const auto try_point = [&](const Eigen::Vector3d& point, const Triangle& other) {
    const TriangleDistance off = point_triangle_distance(point, other[0], other[1], other[2]);
    if (!(off.upper < least)) return;
    least = off.upper;
    best = 0.5 * (point + off.closest);
  };
  for (const auto& [from, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const Eigen::Vector3d origin = (*other)[0];
    const Eigen::Vector3d normal = ((*other)[1] - origin).cross((*other)[2] - origin);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& begin = (*from)[k];
      const Eigen::Vector3d& end = (*from)[(k + 1) % 3];
      try_point(begin, *other);
      const double above = normal.dot(begin - origin), below = -normal.dot(end - origin);
      if (above * below > 0.0) try_point(begin + (above / (above + below)) * (end - begin), *other);
    }
  }
  return best;
}

PartContact contact_of_triangles(const PlacedPart& a, const PlacedPart& b,
                                 const SpherePair& spheres, const TrianglePair& pair,
                                 bool details) {
  PartContact contact{.b1 = pair.a, .b2 = pair.b};
  if (!details) return contact;
  const Triangle first = placed_triangle(a, pair.a);
  const Eigen::Vector3d across = (first[1] - first[0]).cross(first[2] - first[0]);
  const double size = across.norm();
  contact.normal =
      size > 0.0 ? Eigen::Vector3d(across / size) : PlacedSpheres(a, b, spheres).direction;
  contact.point = common_point(first, placed_triangle(b, pair.b));
  contact.depth =
      contact_depth(*a.part.mesh, a.world_from_part, *b.part.mesh, b.world_from_part, pair);
  return contact;
}

// Of two meshes that have a point in common: pairs of triangles that touch, at most one for each
// two spheres. The search for spheres that touch is repeated for eight times as many until enough
// triangles are found, because the first will do as a rule and there may be very many.
std::vector<PartContact> triangle_contacts(const PlacedPart& a, const PlacedPart& b,
                                           std::size_t most, bool details) {
  const CoveredMesh& mesh_a = *a.part.mesh;
  const CoveredMesh& mesh_b = *b.part.mesh;
  std::vector<PartContact> found;
  std::set<SpherePair> queried;
  std::set<std::pair<std::int32_t, std::int32_t>> taken;
  for (std::size_t limit = 8;; limit *= 8) {
    const CollisionResult spheres = collide(*a.part.spheres, a.world_from_part, *b.part.spheres,
                                            b.world_from_part, {.max_pairs = limit});
    for (const SpherePair& pair : spheres.pairs) {
      if (!queried.insert(pair).second) continue;
      const std::optional<TrianglePair> triangles =
          touching_triangles(mesh_a, pair.a, a.world_from_part, mesh_b, pair.b, b.world_from_part);
      if (!triangles || !taken.emplace(triangles->a, triangles->b).second) continue;
      found.push_back(contact_of_triangles(a, b, pair, *triangles, details));
      if (found.size() == most) return found;
    }
    if (!spheres.complete) continue;
    // No triangles touch: one lies inside the other.
    if (found.empty() && !spheres.pairs.empty()) {
      found.push_back(contact_of_spheres(a, b, spheres.pairs.front(), details));
      found.back().b1 = found.back().b2 = kNone;
    }
    return found;
  }
}

}  // namespace

std::vector<PartContact> contacts(const PlacedPart& a, const PlacedPart& b, std::size_t most,
                                  bool details) {
  if (a.part.mesh && b.part.mesh) {
    if (!collides(*a.part.mesh, a.world_from_part, *b.part.mesh, b.world_from_part)) return {};
    return triangle_contacts(a, b, most, details);
  }
  const SphereTree& spheres_a = *a.part.spheres;
  const SphereTree& spheres_b = *b.part.spheres;
  if (!collides(spheres_a, a.world_from_part, spheres_b, b.world_from_part)) return {};
  std::vector<PartContact> found;
  for (const SpherePair& pair :
       collide(spheres_a, a.world_from_part, spheres_b, b.world_from_part, {.max_pairs = most})
           .pairs) {
    found.push_back(contact_of_spheres(a, b, pair, details));
  }
  return found;
}

PartDistance distance(const PlacedPart& a, const PlacedPart& b, double tolerance) {
  PartDistance result;
  result.bounds = spherule::distance(*a.part.spheres, a.world_from_part, *b.part.spheres,
                                     b.world_from_part, {.tolerance = tolerance});
  const PlacedSpheres spheres(a, b, result.bounds.nearest);
  result.points[0] = spheres.first.center + spheres.first.radius * spheres.direction;
  result.points[1] = spheres.second.center - spheres.second.radius * spheres.direction;
  return result;
}

}  // namespace spherule::fcl_api::internal
