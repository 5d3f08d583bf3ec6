// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/collide.h"

#include "base/error.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/sweep.h"
#include "geometry/point_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace spherule::fcl_api {
namespace {

constexpr std::intptr_t kNone = -1;

struct PlacedPart {
  const CoveredPart& part;
  Pose world_from_part;
};

// In double.
struct PartContact {
  // Two triangles that touch, or two spheres where no triangles are queried; kNone for a body that
  // lies inside the other without touching its triangles.
  std::intptr_t b1 = kNone;
  std::intptr_t b2 = kNone;
  // Only if details are requested.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double depth = 0.0;
};

struct PartDistance {
  spherule::DistanceResult bounds;
  Eigen::Vector3d points[2];  // of the two spheres that are nearest, nearest to each other
};

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
    const spherule::CollisionResult spheres =
        collide(*a.part.spheres, a.world_from_part, *b.part.spheres, b.world_from_part,
                {.max_pairs = limit});
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

// None exactly if the parts are free of each other; otherwise at least one and at most `most` (at
// least 1), of different pairs.
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

PartDistance part_distance(const PlacedPart& a, const PlacedPart& b, double tolerance) {
  PartDistance result;
  result.bounds = spherule::distance(*a.part.spheres, a.world_from_part, *b.part.spheres,
                                     b.world_from_part, {.tolerance = tolerance});
  const PlacedSpheres spheres(a, b, result.bounds.nearest);
  result.points[0] = spheres.first.center + spheres.first.radius * spheres.direction;
  result.points[1] = spheres.second.center - spheres.second.radius * spheres.direction;
  return result;
}

template <class S>
const CoveredPart& part_of(const fcl::CollisionGeometry<S>* geometry, const char* argument) {
  const auto* model = dynamic_cast<const SphereModel<S>*>(geometry);
  if (model) return model->part();
  throw Error(argument, geometry ? "this geometry has no spheres; sphere_model() makes them"
                                 : "there is no geometry");
}

template <class S>
Pose pose_of(const fcl::Transform3<S>& transform, const char* argument) {
  try {
    return from_fcl(transform);
  } catch (const Error& error) {
    throw Error(argument, error.reason());
  }
}

template <class S>
const fcl::CollisionObject<S>& object(const fcl::CollisionObject<S>* object, const char* argument) {
  if (!object) throw Error(argument, "there is no object");
  return *object;
}

// Not above `value`, if S is coarser.
template <class S>
S rounded_down(double value) {
  const S rounded = static_cast<S>(value);
  const S below = std::nextafter(rounded, -std::numeric_limits<S>::infinity());
  return static_cast<double>(rounded) <= value ? rounded : below;
}

// Adds to the result what is in contact, as long as fewer than `num_max_contacts` are there.
template <class S>
void add_contacts(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
                  const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
                  const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  if (request.num_max_contacts == 0) throw Error("num_max_contacts", "must not be 0");
  if (request.enable_cost) throw Error("enable_cost", "spheres have no cost");
  const PlacedPart a{part_of(o1, "o1"), pose_of<S>(tf1, "tf1")};
  const PlacedPart b{part_of(o2, "o2"), pose_of<S>(tf2, "tf2")};
  if (result.numContacts() >= request.num_max_contacts) return;
  const std::size_t most = request.num_max_contacts - result.numContacts();
  for (const PartContact& found : contacts(a, b, most, request.enable_contact)) {
    fcl::Contact<S> contact;
    contact.o1 = o1;
    contact.o2 = o2;
    contact.b1 = found.b1;
    contact.b2 = found.b2;
    contact.normal = found.normal.template cast<S>();
    contact.pos = found.point.template cast<S>();
    contact.penetration_depth = static_cast<S>(found.depth);
    result.addContact(contact);
  }
}

inline double sweep_resolution(double toc_err) {
  if (!(toc_err > 0.0)) throw Error("toc_err", "must be above zero");
  return std::clamp(toc_err, 0x1p-40, 1.0);
}

// FCL's motion from one transform to another. A turn under CCDM_TRANS, which FCL leaves out, would
// be one that is not checked.
template <class S>
Motion motion(const fcl::Transform3<S>& begin, const fcl::Transform3<S>& end,
              fcl::CCDMotionType type, const char* begin_name, const char* end_name) {
  const Pose first = pose_of<S>(begin, begin_name);
  const Pose last = pose_of<S>(end, end_name);
  if (type == fcl::CCDM_TRANS && !begin.linear().isApprox(end.linear())) {
    throw Error("ccd_motion_type", "CCDM_TRANS leaves out the rotation between " +
                                       std::string(begin_name) + " and " + end_name +
                                       "; CCDM_LINEAR does not");
  }
  if (type != fcl::CCDM_TRANS && type != fcl::CCDM_LINEAR) {
    throw Error("ccd_motion_type", "only CCDM_TRANS and CCDM_LINEAR are supported");
  }
  return Motion::between(first, last);
}

}  // namespace

template <class S>
std::size_t collide(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
                    const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  result.clear();
  add_contacts(o1, tf1, o2, tf2, request, result);
  return result.numContacts();
}

template <class S>
std::size_t collide(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  const auto& a = object(o1, "o1");
  const auto& b = object(o2, "o2");
  return fcl_api::collide(a.collisionGeometry().get(), a.getTransform(),
                          b.collisionGeometry().get(), b.getTransform(), request, result);
}

template <class S>
S distance(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1,
           const fcl::CollisionGeometry<S>* o2, const fcl::Transform3<S>& tf2,
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  if (request.enable_signed_distance) {
    throw Error("enable_signed_distance", "is not supported");
  }
  const auto tolerance = static_cast<double>(request.abs_err);
  if (!(tolerance >= 0.0) || !std::isfinite(tolerance)) {
    throw Error("abs_err", "must be finite and not negative");
  }
  const PlacedPart a{part_of(o1, "o1"), pose_of<S>(tf1, "tf1")};
  const PlacedPart b{part_of(o2, "o2"), pose_of<S>(tf2, "tf2")};
  const PartDistance found = part_distance(a, b, tolerance);
  result.clear();
  result.min_distance = found.bounds.lower > 0.0 ? rounded_down<S>(found.bounds.lower) : S(-1);
  result.o1 = o1;
  result.o2 = o2;
  result.b1 = found.bounds.nearest.a;
  result.b2 = found.bounds.nearest.b;
  for (int i = 0; i < 2; ++i) result.nearest_points[i] = found.points[i].template cast<S>();
  return result.min_distance;
}

template <class S>
S distance(const fcl::CollisionObject<S>* o1, const fcl::CollisionObject<S>* o2,
           const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  const auto& a = object(o1, "o1");
  const auto& b = object(o2, "o2");
  return fcl_api::distance(a.collisionGeometry().get(), a.getTransform(),
                           b.collisionGeometry().get(), b.getTransform(), request, result);
}

template <class S>
S continuousCollide(const fcl::CollisionGeometry<S>* o1, const fcl::Transform3<S>& tf1_beg,
                    const fcl::Transform3<S>& tf1_end, const fcl::CollisionGeometry<S>* o2,
                    const fcl::Transform3<S>& tf2_beg, const fcl::Transform3<S>& tf2_end,
                    const fcl::ContinuousCollisionRequest<S>& request,
                    fcl::ContinuousCollisionResult<S>& result) {
  const CoveredPart& a = part_of(o1, "o1");
  const CoveredPart& b = part_of(o2, "o2");
  const auto type = request.ccd_motion_type;
  const Motion motion_a = motion<S>(tf1_beg, tf1_end, type, "tf1_beg", "tf1_end");
  const Motion motion_b = motion<S>(tf2_beg, tf2_end, type, "tf2_beg", "tf2_end");
  const double resolution = sweep_resolution(static_cast<double>(request.toc_err));
  const SweepResult swept =
      sweep(*a.spheres, motion_a, *b.spheres, motion_b, {.resolution = resolution});
  const bool is_free = swept.verdict == Verdict::kFree;
  const double until = is_free ? 1.0 : swept.free_until;
  const double contact_at = swept.verdict == Verdict::kCollision ? swept.contact_at : until;
  result.is_collide = !is_free;
  result.time_of_contact = rounded_down<S>(until);
  result.contact_tf1 = to_fcl<S>(motion_a.pose_at(contact_at));
  result.contact_tf2 = to_fcl<S>(motion_b.pose_at(contact_at));
  return result.time_of_contact;
}

template <class S>
S continuousCollide(const fcl::CollisionObject<S>* o1, const fcl::Transform3<S>& tf1_end,
                    const fcl::CollisionObject<S>* o2, const fcl::Transform3<S>& tf2_end,
                    const fcl::ContinuousCollisionRequest<S>& request,
                    fcl::ContinuousCollisionResult<S>& result) {
  const auto& a = object(o1, "o1");
  const auto& b = object(o2, "o2");
  return fcl_api::continuousCollide(a.collisionGeometry().get(), a.getTransform(), tf1_end,
                                    b.collisionGeometry().get(), b.getTransform(), tf2_end, request,
                                    result);
}

template <class S>
bool DefaultCollisionFunction(fcl::CollisionObject<S>* o1, fcl::CollisionObject<S>* o2,
                              void* data) {
  auto& query = *static_cast<fcl::DefaultCollisionData<S>*>(data);
  if (query.done) return true;
  const auto& a = object<S>(o1, "o1");
  const auto& b = object<S>(o2, "o2");
  add_contacts(a.collisionGeometry().get(), a.getTransform(), b.collisionGeometry().get(),
               b.getTransform(), query.request, query.result);
  query.done = query.result.numContacts() >= query.request.num_max_contacts;
  return query.done;
}

template <class S>
bool DefaultDistanceFunction(fcl::CollisionObject<S>* o1, fcl::CollisionObject<S>* o2, void* data,
                             S& dist) {
  auto& query = *static_cast<fcl::DefaultDistanceData<S>*>(data);
  if (!query.done) {
    fcl::DistanceResult<S> pair;
    fcl_api::distance(o1, o2, query.request, pair);
    query.result.update(pair);
    query.done = query.result.min_distance <= S(0);
  }
  dist = query.result.min_distance;
  return query.done;
}

// The template for either precision of FCL.
#define SPHERULE_INSTANTIATE(S)                                                                   \
  template std::size_t collide<S>(const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&,    \
                                  const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&,    \
                                  const fcl::CollisionRequest<S>&, fcl::CollisionResult<S>&);     \
  template std::size_t collide<S>(const fcl::CollisionObject<S>*, const fcl::CollisionObject<S>*, \
                                  const fcl::CollisionRequest<S>&, fcl::CollisionResult<S>&);     \
  template S distance<S>(const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&,             \
                         const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&,             \
                         const fcl::DistanceRequest<S>&, fcl::DistanceResult<S>&);                \
  template S distance<S>(const fcl::CollisionObject<S>*, const fcl::CollisionObject<S>*,          \
                         const fcl::DistanceRequest<S>&, fcl::DistanceResult<S>&);                \
  template S continuousCollide<S>(                                                                \
      const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&, const fcl::Transform3<S>&,     \
      const fcl::CollisionGeometry<S>*, const fcl::Transform3<S>&, const fcl::Transform3<S>&,     \
      const fcl::ContinuousCollisionRequest<S>&, fcl::ContinuousCollisionResult<S>&);             \
  template S continuousCollide<S>(const fcl::CollisionObject<S>*, const fcl::Transform3<S>&,      \
                                  const fcl::CollisionObject<S>*, const fcl::Transform3<S>&,      \
                                  const fcl::ContinuousCollisionRequest<S>&,                      \
                                  fcl::ContinuousCollisionResult<S>&);                            \
  template bool DefaultCollisionFunction<S>(fcl::CollisionObject<S>*, fcl::CollisionObject<S>*,   \
                                            void*);                                               \
  template bool DefaultDistanceFunction<S>(fcl::CollisionObject<S>*, fcl::CollisionObject<S>*,    \
                                           void*, S&);
SPHERULE_INSTANTIATE(float)
SPHERULE_INSTANTIATE(double)
#undef SPHERULE_INSTANTIATE

}  // namespace spherule::fcl_api
