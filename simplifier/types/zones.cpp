// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/types/zones.h"

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/point_triangle.h"

#include <algorithm>
#include <string>

namespace spherule {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// A segment is a triangle with two equal corners.
TriangleDistance to_axis(const ZoneCapsule& capsule, const Vector3d& point) {
  return point_triangle_distance(point, capsule.from, capsule.to, capsule.to);
}

struct DistanceLower {
  const Vector3d& point;

  double operator()(const Sphere& sphere) const {
    return std::max(0.0, sub_down(distance_lower(point, sphere.center), sphere.radius));
  }
  double operator()(const AlignedBox3d& box) const {
    Vector3d gap;
    for (int axis = 0; axis < 3; ++axis) {
      gap[axis] = std::max(
          {0.0, sub_down(box.min()[axis], point[axis]), sub_down(point[axis], box.max()[axis])});
    }
    return norm_lower(gap);
  }
  double operator()(const ZoneCapsule& capsule) const {
    return std::max(0.0, sub_down(to_axis(capsule, point).lower, capsule.radius));
  }
};

struct Contains {
  const Vector3d& point;
  double reach;

  bool operator()(const Sphere& sphere) const { return certainly_contains(sphere, point, reach); }
  bool operator()(const AlignedBox3d& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double low = reach == 0.0 ? point[axis] : sub_down(point[axis], reach);
      const double high = reach == 0.0 ? point[axis] : add_up(point[axis], reach);
      if (!(low >= box.min()[axis] && high <= box.max()[axis])) return false;
    }
    return true;
  }
  bool operator()(const ZoneCapsule& capsule) const {
    return add_up(to_axis(capsule, point).upper, reach) <= capsule.radius;
  }
};

struct Bounding {
  AlignedBox3d operator()(const Sphere& sphere) const {
    return about(sphere.center, sphere.radius);
  }
  AlignedBox3d operator()(const AlignedBox3d& box) const { return box; }
  AlignedBox3d operator()(const ZoneCapsule& capsule) const {
    return about(capsule.from, capsule.radius).merged(about(capsule.to, capsule.radius));
  }

  static AlignedBox3d about(const Vector3d& center, double radius) {
    AlignedBox3d box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min()[axis] = sub_down(center[axis], radius);
      box.max()[axis] = add_up(center[axis], radius);
    }
    return box;
  }
};

struct IsUsable {
  bool operator()(const Sphere& sphere) const { return is_usable(sphere); }
  bool operator()(const AlignedBox3d& box) const {
    return is_usable_point(box.min()) && is_usable_point(box.max()) &&
           (box.min().array() <= box.max().array()).all();
  }
  bool operator()(const ZoneCapsule& capsule) const {
    return is_usable(Sphere{capsule.from, capsule.radius}) && is_usable_point(capsule.to);
  }
};

bool equal_shapes(const ZoneShape& a, const ZoneShape& b) {
  if (a.index() != b.index()) return false;
  if (const auto* box = std::get_if<AlignedBox3d>(&a)) {
    const auto& other = std::get<AlignedBox3d>(b);
    return box->min() == other.min() && box->max() == other.max();
  }
  if (const auto* sphere = std::get_if<Sphere>(&a)) return *sphere == std::get<Sphere>(b);
  return std::get<ZoneCapsule>(a) == std::get<ZoneCapsule>(b);
}

}  // namespace

bool operator==(const Zone& a, const Zone& b) {
  return equal_shapes(a.shape, b.shape) && a.max_error == b.max_error &&
         a.min_external_diameter == b.min_external_diameter;
}

double distance_lower(const ZoneShape& shape, const Vector3d& point) {
  return std::visit(DistanceLower{point}, shape);
}

bool certainly_contains(const ZoneShape& shape, const Vector3d& point, double reach) {
  return std::visit(Contains{point, reach}, shape);
}

AlignedBox3d bounds(const ZoneShape& shape) {
  return std::visit(Bounding{}, shape);
}

void check_zones(std::span<const Zone> zones, double max_error, double min_external_diameter) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    const std::string subject = "zone " + std::to_string(i);
    if (!std::visit(IsUsable{}, zone.shape)) {
      throw Error(subject,
                  "the shape has a number beyond 1e15, a negative radius, or a least "
                  "corner above the greatest");
    }
    if (!zone.max_error && !zone.min_external_diameter) {
      throw Error(subject, "has neither a max error nor a min external diameter of its own");
    }
    const auto check = [&](const char* name, const std::optional<double>& value, double elsewhere) {
      if (!value) return;
      if (!(*value > 0.0 && *value <= kMaxCoordinate)) {
        throw Error(subject, std::string("the ") + name + " must be positive and finite");
      }
      if (*value > elsewhere) {
        throw Error(subject, std::string("the ") + name + " is above the one that holds elsewhere");
      }
    };
    check("max error", zone.max_error, max_error);
    check("min external diameter", zone.min_external_diameter, min_external_diameter);
  }
}

double tightest_error(std::span<const Zone> zones, double max_error) {
  for (const Zone& zone : zones) {
    if (zone.max_error) max_error = std::min(max_error, *zone.max_error);
  }
  return max_error;
}

}  // namespace spherule
