// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/solid_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace spherule::test {
namespace {

using Wide2 = Eigen::Matrix<Wide, 2, 1>;

// On the rim or within, and often in a direction in which tessellations have their corners.
Wide2 point_of_disc(Wide radius, Random& random) {
  const Wide turn = random.index(2) == 0 ? Wide(random.unit()) : Wide(random.index(96)) / 96;
  const Wide angle = 2 * std::numbers::pi_v<Wide> * turn;
  const Wide share = random.index(3) == 0 ? std::sqrt(Wide(random.unit())) : Wide(1);
  return Wide2(std::cos(angle), std::sin(angle)) * radius * share;
}

WidePoint point_of_sphere(Wide radius, Random& random) {
  const Wide share = random.index(3) == 0 ? Wide(random.unit()) : Wide(1);
  WidePoint direction = random.direction().cast<Wide>();
  if (random.index(4) == 0) direction = WidePoint::Unit(static_cast<int>(random.index(3)));
  return direction.normalized() * radius * share * (random.index(2) == 0 ? 1 : -1);
}

// From -half to half, often an end.
Wide along(Wide half, Random& random) {
  const std::size_t kind = random.index(4);
  return kind == 0 ? half : kind == 1 ? -half : Wide(random.between(-1, 1)) * half;
}

struct PointOf {
  Random& random;

  WidePoint operator()(const Box& box) const {
    WidePoint p;
    for (int k = 0; k < 3; ++k) p[k] = along(Wide(box.size[k]) / 2, random);
    return p;
  }
  WidePoint operator()(const SolidSphere& sphere) const {
    return point_of_sphere(sphere.radius, random);
  }
  WidePoint operator()(const Cylinder& cylinder) const {
    const Wide2 p = point_of_disc(cylinder.radius, random);
    return {p.x(), p.y(), along(Wide(cylinder.length) / 2, random)};
  }
  WidePoint operator()(const Capsule& capsule) const {
    WidePoint p = point_of_sphere(capsule.radius, random);
    p.z() += along(Wide(capsule.length) / 2, random);
    return p;
  }
  WidePoint operator()(const HalfSpace&) const { return WidePoint::Zero(); }
};

// The nearest point of a solid to one in its frame.
template <class Real>
struct Nearest {
  using Point = Eigen::Matrix<Real, 3, 1>;
  const Point& p;

  Point operator()(const Box& box) const {
    const Point half = box.size.cast<Real>() / 2;
    return p.cwiseMin(half).cwiseMax(-half);
  }
  Point operator()(const SolidSphere& sphere) const { return within(p, sphere.radius); }
  Point operator()(const Cylinder& cylinder) const {
    const Point side = within({p.x(), p.y(), 0}, cylinder.radius);
    return {side.x(), side.y(), along_axis(cylinder.length)};
  }
  Point operator()(const Capsule& capsule) const {
    const Point axis(0, 0, along_axis(capsule.length));
    return axis + within(p - axis, capsule.radius);
  }
  Point operator()(const HalfSpace&) const { return {p.x(), p.y(), std::min(p.z(), Real(0))}; }

 private:
  static Point within(const Point& point, Real radius) {
    const Real length = point.norm();
    return length > radius ? Point(radius / length * point) : point;
  }
  Real along_axis(Real length) const { return std::clamp(p.z(), -length / 2, length / 2); }
};

}  // namespace

WidePoint move(const Pose& pose, const WidePoint& point) {
  const Eigen::Quaterniond q = pose.rotation();
  const Eigen::Quaternion<Wide> wide(q.w(), q.x(), q.y(), q.z());
  return wide.normalized() * point + pose.translation().cast<Wide>();
}

WidePoint unmove(const Pose& pose, const WidePoint& point) {
  const Eigen::Quaterniond q = pose.rotation();
  const Eigen::Quaternion<Wide> wide(q.w(), q.x(), q.y(), q.z());
  return wide.normalized().conjugate() * (point - pose.translation().cast<Wide>());
}

Primitive random_primitive(Random& random, double size) {
  const auto length = [&] { return size * random.between(0.2, 1.0); };
  switch (random.index(4)) {
    case 0:
      return Box{{length(), length(), length()}};
    case 1:
      return SolidSphere{0.5 * length()};
    case 2:
      return Cylinder{0.5 * length(), length()};
    default:
      return Capsule{0.5 * length(), random.index(4) == 0 ? 0.0 : length()};
  }
}

Pose random_pose(Random& random, double size) {
  return Pose(random.rotation(), size * random.unit() * random.direction());
}

WidePoint point_of(const Primitive& primitive, Random& random) {
  return std::visit(PointOf{random}, primitive);
}

Wide distance_to(const Primitive& primitive, const WidePoint& point) {
  return (point - std::visit(Nearest<Wide>{point}, primitive)).norm();
}

// The ways between the points, one of each solid, get shorter with every round.
double distance_between(const Primitive& a, const Pose& world_from_a, const Primitive& b,
                        const Pose& world_from_b) {
  const Pose b_from_a = world_from_b.inverse() * world_from_a;
  const Pose a_from_b = b_from_a.inverse();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // of a, in its frame
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3000; ++round) {
    const Eigen::Vector3d of_a = b_from_a * at;
    const Eigen::Vector3d of_b = a_from_b * std::visit(Nearest<double>{of_a}, b);
    at = std::visit(Nearest<double>{of_b}, a);
    const double distance = (at - of_b).norm();
    if (distance < 1e-9 || last - distance < 1e-13) return distance;
    last = distance;
  }
  return last;
}

}  // namespace spherule::test
