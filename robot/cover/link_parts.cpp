// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_parts.h"

#include "base/bytes.h"
#include "base/rounding.h"
#include "collide/solids/primitive.h"
#include "collide/solids/solid_fields.h"
#include "geometry/pose.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace spherule::internal {
namespace {

// Chord error of the meshes around curved primitives.
constexpr double kChordError = LinkMeshOptions{}.chord_error;

// `first` are the first links of the same shapes.
void find_equal(std::vector<LinkParts>& parts, const std::vector<std::size_t>& first) {
  std::map<std::size_t, std::vector<std::size_t>> different;  // parts by their first link
  for (LinkParts& part : parts) {
    std::vector<std::size_t>& known = different[first[part.index]];
    const auto equal = std::ranges::find_if(
        known, [&](std::size_t other) { return parts[other].spheres == part.spheres; });
    if (equal != known.end()) {
      part.first_equal = *equal;
    } else {
      known.push_back(part.index);
    }
  }
}

}  // namespace

double largest_radius(std::span<const LinkShape> shapes) {
  const auto radius_of = [](const auto& solid) {
    if constexpr (requires { solid.radius; }) {
      return solid.radius;
    } else {
      return 0.0;
    }
  };
  double largest = 0.0;
  for (const LinkShape& shape : shapes) {
    const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
    if (primitive != nullptr) largest = std::max(largest, std::visit(radius_of, *primitive));
  }
  return largest;
}

std::vector<LinkParts> parts_of(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                                LinkGeometry geometry, std::vector<std::string>* unknown) {
  std::vector<LinkParts> parts;
  std::map<std::string, std::size_t> index;
  for (const LinkDescription& link : robot.links) {
    index[link.name] = parts.size();
    parts.push_back({link.name,
                     parts.size(),
                     parts.size(),
                     link_mesh(link, {.geometry = geometry, .chord_error = kChordError}),
                     largest_radius(link_shapes(link, geometry)) > 0.0 ? kChordError : 0.0,
                     {}});
  }
  if (std::none_of(parts.begin(), parts.end(), [](const auto& part) { return part.mesh; })) {
    throw Error("robot \"" + robot.name + "\"", geometry == LinkGeometry::kVisual
                                                    ? "has no visual geometry"
                                                    : "has no collision geometry");
  }
  std::set<std::string> seen;
  for (const LinkSpheres& link : spheres) {
    const std::string subject = "link \"" + link.link + "\"";
    if (!seen.insert(link.link).second) throw Error(subject, "has spheres twice");
    if (!std::all_of(link.spheres.begin(), link.spheres.end(), is_usable)) {
      throw Error(subject, "has a sphere that is not usable");
    }
    const auto found = index.find(link.link);
    if (found != index.end()) {
      parts[found->second].spheres = link.spheres;
    } else if (unknown && !link.spheres.empty()) {
      unknown->push_back(link.link);
    }
  }
  find_equal(parts, first_equal_links(robot, geometry));
  return parts;
}

namespace {

// Nobody wants the hundred million spheres that such a link requires.
constexpr double kMostErrorsAcross = 1e4;
// A link above the first length is probably in millimetres, as is one above the second that is
// also so many times its E across.
constexpr double kMostMetresAcross = 100.0;
constexpr double kUsualMetresAcross = 10.0;
constexpr double kUsualErrorsAcross = 1e3;
constexpr const char* kScaleOfMillimetres =
    "their scale has to be 0.001 (in a URDF: <mesh scale=\"0.001 0.001 0.001\" .../>)";

}  // namespace

std::string size_fault(double across, double max_error) {
  if (across <= kMostErrorsAcross * max_error) return "";
  std::ostringstream text;
  text << "is " << across << " m across, too much for a max error of " << max_error
       << " m: are its meshes in millimetres? Then " << kScaleOfMillimetres;
  return text.str();
}

std::string size_doubt(double across, double max_error) {
  const bool is_large = across > kUsualMetresAcross && across > kUsualErrorsAcross * max_error;
  if (!is_large && across <= kMostMetresAcross) return "";
  std::ostringstream text;
  text << "it is " << across << " m across: if its meshes are in millimetres, "
       << kScaleOfMillimetres;
  if (is_large) text << "; so many times the max error takes long";
  return text.str();
}

std::string link_diameter_warning(double min_external_diameter) {
  std::ostringstream text;
  text << "it is so large for its max error that D is " << min_external_diameter
       << " m instead of 4 E: narrower gaps are filled";
  return text.str();
}

LinkSolid::LinkSolid(const TriangleMesh& mesh, const SimplifyOptions& lengths,
                     std::size_t max_cells)
    : solid_(simplified_solid(mesh, lengths, max_cells)) {
  certify_options_ = {.external = &solid_.external,
                      .resolution = proof_resolution(solid_.options.max_error,
                                                     solid_.external.box.diagonal().norm()),
                      .protrusion_tolerance = 0.0,
                      .volume = false,
                      .threads = lengths.threads};
  if (solid_.larger_diameter) {
    warnings_.push_back(link_diameter_warning(solid_.options.min_external_diameter));
  }
}

std::string openness(const MeshReport& report) {
  return "its mesh is open (" + std::to_string(report.boundary_edges) +
         " edges with one triangle, " + std::to_string(report.non_manifold_edges) +
         " with more than two)";
}

namespace {

// The bytes of all that says what a shape is: equal shapes have equal ones, and none is the
// beginning of another's.
std::string bytes_of(const LinkShape& shape) {
  std::string bytes;
  const auto add = [&](const auto& vector) {
    for (const double x : vector) append_number(bytes, x);
  };
  append_number(bytes, shape.geometry.index());
  if (const auto* const file = std::get_if<MeshFile>(&shape.geometry)) {
    const std::string& path = file->path.native();
    append_number(bytes, path.size());
    bytes += path;
    add(file->scale);
  } else {
    const auto& primitive = std::get<Primitive>(shape.geometry);
    append_number(bytes, primitive.index());
    const auto add_sizes = [&](const auto& solid) {
      if constexpr (requires { solid.size; }) add(solid.size);
      if constexpr (requires { solid.radius; }) append_number(bytes, solid.radius);
      if constexpr (requires { solid.length; }) append_number(bytes, solid.length);
    };
    std::visit(add_sizes, primitive);
  }
  add(shape.link_from_shape.rotation().coeffs().eval());
  add(shape.link_from_shape.translation());
  return bytes;
}

}  // namespace

std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry) {
  std::vector<std::size_t> first(robot.links.size());
  std::unordered_map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::string key;
    for (const LinkShape& shape : link_shapes(robot.links[i], geometry)) key += bytes_of(shape);
    first[i] = key.empty() ? i : known.try_emplace(std::move(key), i).first->second;
  }
  return first;
}

namespace {

using Eigen::Vector3d;

// Of Pose::operator*, to first order 40 u.
double mapping_error(const Pose& pose, const Vector3d& point) {
  return mul_up(add_up(norm_upper(point), norm_upper(pose.translation())), 41.0 * kUnitRoundoff);
}

// Whether a primitive, placed by `link_from_shape`, is a subset of `sphere` in exact arithmetic.
// False also within a few units in the last place of the limit, except for a sphere about the same
// centre.
struct IsSubset {
  const Sphere& sphere;
  const Pose& link_from_shape;

  bool holds(const Vector3d& point, double reach) const {
    return certainly_contains(sphere, link_from_shape * point,
                              add_up(mapping_error(link_from_shape, point), reach));
  }

  // Convex: its corners decide.
  bool operator()(const Box& box) const {
    for (int k = 0; k < 8; ++k) {
      const Vector3d sign(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
      if (!holds(sign.cwiseProduct(box.size), 0.0)) return false;
    }
    return true;
  }
  bool operator()(const SolidSphere& inner) const {
    const Vector3d& center = link_from_shape.translation();  // exactly
    if (center == sphere.center) return inner.radius <= sphere.radius;
    return certainly_encloses(sphere, {center, inner.radius});
  }
  // The convex hull of two spheres.
  bool operator()(const Capsule& capsule) const {
    return std::ranges::all_of(std::array{0.5, -0.5}, [&](double side) {
      return holds({0.0, 0.0, side * capsule.length}, capsule.radius);
    });
  }
  // The convex hull of two circles. With d from the middle of one to the centre of the sphere, h
  // the part of d along the axis a and p the length of the rest, its farthest point is at the
  // distance sqrt(h^2 + (p + r)^2), which changes by no more than h and p do.
  //
  // Rounding, with s the sum of |d|, |t| and half the length: a is off by 35 u (pose.h), d by 41 u
  // s (mapping) and 1 u s; so h by (42 + 35 + 3) u s and d - h a by (42 + 80 + 35 + 3) u s, the sum
  // p + r by 1 u more of itself.
  bool operator()(const Cylinder& cylinder) const {
    const Vector3d axis = link_from_shape.matrix().col(2);
    return std::ranges::all_of(std::array{0.5, -0.5}, [&](double side) {
      const Vector3d middle = link_from_shape * Vector3d(0.0, 0.0, side * cylinder.length);
      const Vector3d d = sphere.center - middle;
      const double along = d.dot(axis);
      const double across = norm_upper(d - along * axis) + cylinder.radius;
      const double size = norm_upper(d) + norm_upper(link_from_shape.translation()) +
                          cylinder.length + cylinder.radius;
      return certainly_contains({Vector3d::Zero(), sphere.radius}, {along, across, 0.0},
                                mul_up(size, 256.0 * kUnitRoundoff));
    });
  }
  bool operator()(const HalfSpace&) const { return false; }
};

bool is_subset(const LinkShape& shape, const Sphere& sphere) {
  const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
  return primitive != nullptr && std::visit(IsSubset{sphere, shape.link_from_shape}, *primitive);
}

// The nerve of the spheres (one vertex for each, a simplex for those that have a point in common)
// has the homology of their union. Where no sphere overlaps more than two others its components are
// paths, cycles and single triangles. None of these encloses a cavity: that takes triangles which
// form a closed surface, each vertex of which has three neighbours at least.
bool overlap_two_others_at_most(std::span<const Sphere> spheres) {
  return std::ranges::all_of(spheres, [&](const Sphere& sphere) {
    const auto overlapping = std::ranges::count_if(
        spheres, [&](const Sphere& other) { return possibly_overlap(sphere, other); });
    return overlapping <= 3;  // itself included
  });
}

// Divides the box around the spheres into cells until each lies in one sphere or has a direction in
// which all of its points that are in no sphere can go straight on without end. A point gets away
// from the centre of a sphere all the way, and so never into it, if it does at first; and a sphere
// that far from the way does not meet it.
class WaysOut {
 public:
  explicit WaysOut(std::span<const Sphere> spheres) : spheres_(spheres), box_(box_of(spheres)) {
    const double size = box_.min().cwiseAbs().cwiseMax(box_.max().cwiseAbs()).maxCoeff();
    slack_ = kSlack * size;
    least_ = kLeastCell * box_.diagonal().norm();
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x != 0 || y != 0 || z != 0) directions_.push_back(Vector3d(x, y, z).normalized());
        }
      }
    }
  }

  bool lead_from_everywhere() {
    return spheres_.size() <= kMostSpheres && has_way_out(box_.center(), box_.sizes() / 2.0);
  }

 private:
  static constexpr double kSlack = 1e-12;  // far more than rounding, of the largest coordinate
  static constexpr double kLeastCell = 0x1p-14;
  static constexpr int kPasses = 3;
  static constexpr double kAside = 1.5;
  static constexpr std::size_t kMostSpheres = 1000;
  static constexpr std::size_t kMostTests = 100'000'000;  // of a sphere with a cell

  bool has_way_out(const Vector3d& middle, const Vector3d& half) {
    const double reach = half.norm() + slack_;
    tests_ += spheres_.size();
    Vector3d away = Vector3d::Zero();
    for (const Sphere& sphere : spheres_) {
      const Vector3d from = middle - sphere.center;
      const double distance = from.norm();
      if (distance + reach <= sphere.radius) return true;
      if (distance > 0.0 && distance - sphere.radius <= reach) away += from / distance;
    }
    if (away.norm() > 0.1 && leads_out(middle, reach, away.normalized())) return true;
    for (const Vector3d& direction : directions_) {
      if (leads_out(middle, reach, direction)) return true;
    }
    if (reach < least_ || tests_ > kMostTests) return false;
    for (int k = 0; k < 8; ++k) {
      const Vector3d sign(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
      if (!has_way_out(middle + sign.cwiseProduct(half), half / 2.0)) return false;
    }
    return true;
  }

  // A direction, or what is left of it beside the nearest spheres that it leads into.
  bool leads_out(const Vector3d& middle, double reach, Vector3d direction) {
    if (is_way_out(middle, reach, direction)) return true;
    for (int pass = 0; pass < kPasses; ++pass) {
      for (const Sphere& sphere : spheres_) {
        ++tests_;
        const Vector3d from = middle - sphere.center;
        const double distance = from.norm();
        if (!(distance > 0.0) || distance - sphere.radius > reach) continue;
        const double lacking = kAside * reach - from.dot(direction);
        if (lacking > 0.0) direction += lacking / (distance * distance) * from;
      }
    }
    return direction.norm() > 0.1 && is_way_out(middle, reach, direction.normalized());
  }

  bool is_way_out(const Vector3d& middle, double reach, const Vector3d& direction) {
    return std::ranges::all_of(spheres_, [&](const Sphere& sphere) {
      ++tests_;
      const Vector3d from = middle - sphere.center;
      const double along = from.dot(direction);
      if (along >= reach) return true;
      return (from - along * direction).norm() > sphere.radius + reach;
    });
  }

  std::span<const Sphere> spheres_;
  Eigen::AlignedBox3d box_;
  double slack_ = 0.0;
  double least_ = 0.0;
  std::vector<Vector3d> directions_;
  std::size_t tests_ = 0;
};

// If so, all of the space outside of the spheres is connected, and no point of it is inside of what
// they hold (G1).
bool enclose_no_cavity(std::span<const Sphere> spheres) {
  return overlap_two_others_at_most(spheres) || WaysOut(spheres).lead_from_everywhere();
}

// The field of a solid (collide/solids/solid_fields.h), for what `use` makes of it.
template <class Use>
auto of_field(const Primitive& primitive, const Use& use) {
  return std::visit([&](const auto& solid) { return use(internal::field_of(solid)); }, primitive);
}

double reach_of(const Primitive& primitive) {
  return of_field(primitive, [](const auto& field) { return field.reach(); });
}

}  // namespace

std::optional<std::vector<Sphere>> exact_spheres(const LinkDescription& link, LinkGeometry geometry,
                                                 double padding) {
  std::vector<Sphere> spheres;
  for (const LinkShape& shape : link_shapes(link, geometry)) {
    const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
    if (primitive == nullptr || !std::holds_alternative<SolidSphere>(*primitive)) return {};
    require_primitive(*primitive, subject_of(link.name));
    spheres.push_back({shape.link_from_shape.translation(),
                       sum_up(std::get<SolidSphere>(*primitive).radius, padding)});
    if (!is_usable(spheres.back())) return {};
  }
  std::ranges::stable_sort(spheres, std::ranges::greater{}, &Sphere::radius);
  std::vector<Sphere> kept;
  for (const Sphere& sphere : spheres) {
    const auto holds = [&](const Sphere& other) {
      return other == sphere || certainly_encloses(other, sphere);
    };
    if (std::ranges::none_of(kept, holds)) kept.push_back(sphere);
  }
  if (kept.empty() || !enclose_no_cavity(kept)) return {};
  return kept;
}

// What a sphere about a point at the signed distance d of a convex solid has furthest from it is at
// d + r. The point in the frame of the solid is off by 41 u of its distance from the frame's origin
// (pose.h), its signed distance by 8 u more (solid_fields.h).
std::optional<double> protrusion_over_primitives(std::span<const LinkShape> shapes,
                                                 std::span<const Sphere> spheres) {
  double result = 0.0;
  for (const Sphere& sphere : spheres) {
    double least = std::numeric_limits<double>::infinity();
    for (const LinkShape& shape : shapes) {
      const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
      if (primitive == nullptr) return {};
      const auto* const inner = std::get_if<SolidSphere>(primitive);
      const Vector3d& origin = shape.link_from_shape.translation();  // exactly
      if (inner != nullptr) {
        const double away = origin == sphere.center
                                ? sphere.radius
                                : add_up(distance_upper(origin, sphere.center), sphere.radius);
        least = std::min(least, away <= inner->radius ? 0.0 : sub_up(away, inner->radius));
        continue;
      }
      const Vector3d point = shape.link_from_shape.inverse() * sphere.center;
      const double size =
          norm_upper(sphere.center) + norm_upper(origin) + sphere.radius + reach_of(*primitive);
      const double distance =
          of_field(*primitive, [&](const auto& field) { return field.signed_distance(point); });
      least = std::min(least, distance + sphere.radius + 256.0 * kUnitRoundoff * size);
    }
    result = std::max(result, least);
  }
  return result;
}

PrimitiveLeak leak_of_primitives(std::span<const LinkShape> shapes, std::span<const Sphere> spheres,
                                 const Vector3d& near) {
  PrimitiveLeak result;
  for (const LinkShape& shape : shapes) {
    const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
    if (primitive == nullptr) continue;
    const Pose& pose = shape.link_from_shape;
    const Vector3d point = pose * of_field(*primitive, [&](const auto& field) {
                             return field.nearest(pose.inverse() * near);
                           });
    const double error = 256.0 * kUnitRoundoff *
                         (norm_upper(near) + norm_upper(pose.translation()) + reach_of(*primitive));
    double depth = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) {
      depth = std::min(
          depth, sub_down(sub_down(distance_lower(point, sphere.center), sphere.radius), error));
    }
    if (std::isfinite(depth) && depth > result.depth) result = {depth, point};
  }
  return result;
}

bool lie_in_single_spheres(std::span<const LinkShape> shapes, std::span<const Sphere> spheres) {
  std::vector<std::size_t> holders;
  for (const LinkShape& shape : shapes) {
    const auto holds = [&](std::size_t sphere) { return is_subset(shape, spheres[sphere]); };
    if (std::ranges::any_of(holders, holds)) continue;
    std::size_t holder = 0;
    while (holder < spheres.size() && !holds(holder)) ++holder;
    if (holder == spheres.size()) return false;
    holders.push_back(holder);
  }
  std::vector<Sphere> chosen;
  for (const std::size_t holder : holders) chosen.push_back(spheres[holder]);
  return enclose_no_cavity(chosen);
}

}  // namespace spherule::internal
