// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/link_pieces.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/collide.h"
#include "collide/shapes.h"
#include "geometry/median_split.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kTrianglesOfPiece = 8;
// Meshes whose corners stand before their triangles by less are treated as convex, in metres.
constexpr double kConvexDefect = 0.001;
// How near the hull of few corners is to that of all, as a share of their box diagonal.
constexpr double kHullTolerance = 0.001;

// A triangle, or a sphere of which only the first corner counts.
struct Element {
  std::array<Vector3d, 3> corners;
  int corner_count;
  double radius;
  Vector3d middle;
};

bool before(const Vector3d& a, const Vector3d& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

void make_unique(std::vector<Vector3d>& points) {
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

double diagonal_of(std::span<const Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  return box.diagonal().norm();
}

std::vector<Element> elements_of(std::span<const LinkBody> bodies) {
  std::vector<Element> result;
  for (const LinkBody& body : bodies) {
    if (body.mesh != nullptr) {
      const MeshTree& mesh = body.mesh->mesh();
      const auto count = static_cast<std::int32_t>(mesh.tree().spheres().size());
      for (std::int32_t i = 0; i < count; ++i) {
        const auto& corners = mesh.triangle(i);
        result.push_back(
            {corners, 3, body.mesh->inflation(), (corners[0] + corners[1] + corners[2]) / 3.0});
      }
    } else {
      for (const Sphere& sphere : body.spheres->spheres()) {
        result.push_back(
            {{sphere.center, sphere.center, sphere.center}, 1, sphere.radius, sphere.center});
      }
    }
  }
  return result;
}

class Builder {
 public:
  Builder(std::vector<Element> elements, LinkPieces& pieces)
      : elements_(std::move(elements)), pieces_(pieces) {}

  void build() {
    pieces_.nodes.emplace_back();
    build(0, 0, elements_.size());
  }

 private:
  void build(std::size_t node, std::size_t first, std::size_t last) {
    Vector3d low = elements_[first].corners[0];
    Vector3d high = low;
    double radius = 0.0;
    bool all_triangles = true;
    for (std::size_t i = first; i < last; ++i) {
      for (int c = 0; c < elements_[i].corner_count; ++c) {
        const Vector3d& corner = elements_[i].corners[static_cast<std::size_t>(c)];
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
      radius = std::max(radius, elements_[i].radius);
      all_triangles &= elements_[i].corner_count == 3;
    }
    const bool is_one_sphere = last - first == 1 && !all_triangles;
    Sphere sphere{0.5 * (low + high), 0.0};
    for (std::size_t i = first; i < last; ++i) {
      for (int c = 0; c < elements_[i].corner_count; ++c) {
        const Vector3d& corner = elements_[i].corners[static_cast<std::size_t>(c)];
        sphere.radius = std::max(
            sphere.radius, add_up(distance_upper(sphere.center, corner), elements_[i].radius));
      }
    }
    pieces_.nodes[node].sphere = sphere;
    const std::size_t count = last - first;
    if (is_one_sphere || (all_triangles && count <= kTrianglesOfPiece)) {
      std::vector<Vector3d> points;
      for (std::size_t i = first; i < last; ++i) {
        points.insert(points.end(), elements_[i].corners.begin(),
                      elements_[i].corners.begin() + elements_[i].corner_count);
      }
      make_unique(points);
      pieces_.nodes[node].first_point = static_cast<std::int32_t>(pieces_.points.size());
      pieces_.nodes[node].point_count = static_cast<std::int32_t>(points.size());
      pieces_.nodes[node].radius = radius;
      pieces_.points.insert(pieces_.points.end(), points.begin(), points.end());
    }
    if (count == 1) return;
    const Eigen::Index axis = longest_axis({low, high});
    const std::size_t middle =
        first + split_at_median(std::span(elements_).subspan(first, count),
                                [axis](const Element& element) { return element.middle[axis]; });
    const std::size_t child = pieces_.nodes.size();
    pieces_.nodes[node].first_child = static_cast<std::int32_t>(child);
    pieces_.nodes.resize(child + 2);
    build(child, first, middle);
    build(child + 1, middle, last);
  }

  std::vector<Element> elements_;
  LinkPieces& pieces_;
};

// Whether no corner stands before the plane of a triangle by more than the defect.
bool seems_convex(const std::vector<Element>& elements, const std::vector<Vector3d>& hull,
                  double defect) {
  return std::all_of(elements.begin(), elements.end(), [&](const Element& element) {
    const Vector3d normal =
        (element.corners[1] - element.corners[0]).cross(element.corners[2] - element.corners[0]);
    const double length = normal.norm();
    if (element.corner_count == 1) return elements.size() == 1;
    return length < 1e-12 || std::all_of(hull.begin(), hull.end(), [&](const Vector3d& p) {
             return normal.dot(p - element.corners[0]) <= defect * length;
           });
  });
}

bool bodies_touch(const LinkBody& a, const Pose& world_from_a, const LinkBody& b,
                  const Pose& world_from_b, double clearance) {
  if (a.mesh != nullptr && b.mesh != nullptr) {
    return within(*a.mesh, world_from_a, *b.mesh, world_from_b, clearance);
  }
  if (b.mesh != nullptr) return within(*a.spheres, world_from_a, *b.mesh, world_from_b, clearance);
  if (a.mesh != nullptr) return within(*b.spheres, world_from_b, *a.mesh, world_from_a, clearance);
  return within(*a.spheres, world_from_a, *b.spheres, world_from_b, clearance);
}

}  // namespace

bool touches(std::span<const LinkBody> a, const Pose& world_from_a, std::span<const LinkBody> b,
             const Pose& world_from_b, double clearance) {
  return std::any_of(a.begin(), a.end(), [&](const LinkBody& of_a) {
    return std::any_of(b.begin(), b.end(), [&](const LinkBody& of_b) {
      return bodies_touch(of_a, world_from_a, of_b, world_from_b, clearance);
    });
  });
}

std::vector<std::vector<LinkBody>> bodies_by_link(const RobotModel& robot,
                                                  std::span<const LinkBody> bodies) {
  std::vector<std::vector<LinkBody>> result(robot.links().size());
  for (const LinkBody& body : bodies) {
    const auto link = static_cast<std::size_t>(body.link);
    if (body.link < 0 || link >= result.size()) {
      throw Error("body", "there is no link " + std::to_string(body.link));
    }
    if ((body.mesh == nullptr) == (body.spheres == nullptr)) {
      throw Error("body of link " + robot.links()[link].name, "must be a mesh or spheres");
    }
    result[link].push_back(body);
  }
  return result;
}

LinkPieces make_link_pieces(std::span<const LinkBody> bodies) {
  LinkPieces result;
  result.bodies.assign(bodies.begin(), bodies.end());
  std::vector<Element> elements = elements_of(bodies);
  for (const Element& element : elements) {
    result.hull.insert(result.hull.end(), element.corners.begin(),
                       element.corners.begin() + element.corner_count);
    result.hull_radius = std::max(result.hull_radius, element.radius);
    for (const Vector3d& corner : element.corners) {
      result.reach = std::max(result.reach, add_up(norm_upper(corner), element.radius));
    }
  }
  make_unique(result.hull);
  const double tolerance = std::min(kHullTolerance * diagonal_of(result.hull), kConvexDefect / 4.0);
  HullCorners few = hull_corners(result.hull, tolerance);
  result.hull = std::move(few.corners);
  result.hull_radius = add_up(result.hull_radius, few.radius);
  result.is_convex = seems_convex(elements, result.hull, kConvexDefect - 2.0 * few.radius);
  Builder(std::move(elements), result).build();
  return result;
}

bool touches(const LinkPieces& a, const Pose& world_from_a, const LinkPieces& b,
             const Pose& world_from_b, double clearance) {
  return touches(a.bodies, world_from_a, b.bodies, world_from_b, clearance);
}

namespace {

constexpr std::size_t kFew = 200;
// Each time that so many corners are kept the tolerance doubles, so that meshes that are very fine
// for their size do not take time in proportion to the square of their points.
constexpr std::size_t kMany = 2000;

// What HullDirection::distance may lack by rounding, of the largest norm of a point: it is the
// length of a combination of up to four corners whose weights add up to 1, none below -4 u, however
// they were found: less than 40 u.
constexpr double kRounding = 1e-14;

class Chooser {
 public:
  Chooser(std::span<const Vector3d> points, double tolerance)
      : points_(points), is_kept_(points.size(), false), tolerance_(tolerance) {}

  HullCorners run() {
    for (int face = 0; face < 27; ++face) {
      const Vector3d direction(face % 3 - 1, face / 3 % 3 - 1, face / 9 - 1);
      if (!direction.isZero()) keep(least_along(points_, -direction));
    }
    double radius = 0.0;
    double reach = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      reach = std::max(reach, points_[i].lpNorm<1>());
      radius = std::max(radius, keep_until_near(i));
    }
    return {std::move(corners_), radius + kRounding * reach};
  }

 private:
  // Keeps points until the hull of those that are kept is near to this one; how far it then is.
  double keep_until_near(std::size_t index) {
    while (!is_kept_[index]) {
      const HullDirection found =
          hull_direction(points_.subspan(index, 1), corners_, Eigen::Matrix3d::Identity(),
                         Vector3d::Zero(), points_[index] - corners_.front(), tolerance_);
      if (found.distance <= tolerance_) return found.distance;
      const std::size_t beyond = least_along(points_, -found.direction);
      keep(is_kept_[beyond] ? index : beyond);
    }
    return 0.0;
  }

  void keep(std::size_t index) {
    if (is_kept_[index]) return;
    is_kept_[index] = true;
    corners_.push_back(points_[index]);
    if (corners_.size() % kMany == 0) tolerance_ *= 2.0;
  }

  std::span<const Vector3d> points_;
  std::vector<bool> is_kept_;
  double tolerance_;
  std::vector<Vector3d> corners_;
};

}  // namespace

HullCorners hull_corners(std::span<const Vector3d> points, double tolerance) {
  if (points.size() <= kFew) return {{points.begin(), points.end()}, 0.0};
  return Chooser(points, tolerance).run();
}

namespace {

constexpr int kSteps = 24;

// Up to four corners of the difference of the two hulls.
struct Simplex {
  std::array<Vector3d, 4> corners;
  std::size_t size = 0;

  // Reduces it to the face that is nearest to the origin and returns the point of that.
  Vector3d nearest() {
    double least = std::numeric_limits<double>::infinity();
    Vector3d result = corners[0];
    unsigned kept = 1;
    for (unsigned face = 1; face < (1U << size); ++face) {
      std::array<Vector3d, 4> of;
      of.fill(Vector3d::Zero());
      int count = 0;
      for (std::size_t i = 0; i < size; ++i) {
        if ((face >> i & 1U) != 0) of[static_cast<std::size_t>(count++)] = corners[i];
      }
      Vector3d point = of[0];
      if (count > 1) {
        Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, count - 1);
        for (int i = 1; i < count; ++i) edges.col(i - 1) = of[static_cast<std::size_t>(i)] - of[0];
        using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
        using Parts = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
        const Gram gram = edges.transpose() * edges;
        const Parts right = edges.transpose() * -of[0];
        const Parts parts = gram.ldlt().solve(right);
        if (!parts.allFinite() || parts.minCoeff() < 0.0 || parts.sum() > 1.0) continue;
        point = of[0] + edges * parts;
      }
      if (point.squaredNorm() >= least) continue;
      least = point.squaredNorm();
      result = point;
      kept = face;
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < size; ++i) {
      if ((kept >> i & 1U) != 0) corners[left++] = corners[i];
    }
    size = left;
    return result;
  }
};

}  // namespace

std::size_t least_along(std::span<const Vector3d> points, const Vector3d& axis) {
  std::size_t least = 0;
  double value = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = axis.dot(points[i]);
    if (along >= value) continue;
    value = along;
    least = i;
  }
  return least;
}

HullDirection hull_direction(std::span<const Vector3d> first, std::span<const Vector3d> second,
                             const Eigen::Matrix3d& first_from_second,
                             const Vector3d& origin_of_second, const Vector3d& start,
                             double enough) {
  HullDirection best{.direction = start.stableNormalized(),
                     .gap = -std::numeric_limits<double>::infinity()};
  Vector3d way = best.direction;
  Simplex simplex;
  for (int step = 0; step < kSteps; ++step) {
    const double length = way.norm();
    if (simplex.size > 0) best.distance = std::min(best.distance, length);
    if (!(length > 1e-12) || best.distance <= enough) break;
    const Vector3d axis = way / length;
    const Vector3d corner =
        first[least_along(first, axis)] -
        (first_from_second * second[least_along(second, first_from_second.transpose() * -axis)] +
         origin_of_second);
    const double gap = axis.dot(corner);
    if (gap > best.gap) {
      best.direction = axis;
      best.gap = gap;
    }
    // As far as it gets: the hulls are not farther apart than `length`.
    if (simplex.size > 0 && gap > 0.0 && length - best.gap <= 1e-3 * length) break;
    for (std::size_t i = 0; i < simplex.size; ++i) {
      if (simplex.corners[i] == corner) return best;
    }
    if (simplex.size == 4) break;
    simplex.corners[simplex.size++] = corner;
    way = simplex.nearest();
  }
  return best;
}

}  // namespace spherule::internal
