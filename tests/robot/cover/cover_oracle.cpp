// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/cover/cover_oracle.h"

#include <algorithm>
#include <cmath>
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

struct DistanceTo {
  const WidePoint& p;

  Wide operator()(const Box& box) const {
    const WidePoint half = box.size.cast<Wide>() / 2;
    return (p.cwiseAbs() - half).cwiseMax(WidePoint::Zero()).norm();
  }
  Wide operator()(const SolidSphere& sphere) const {
    return std::max(Wide(0), p.norm() - Wide(sphere.radius));
  }
  Wide operator()(const Cylinder& cylinder) const {
    const Wide side = std::max(Wide(0), p.head<2>().norm() - Wide(cylinder.radius));
    const Wide end = std::max(Wide(0), std::abs(p.z()) - Wide(cylinder.length) / 2);
    return std::hypot(side, end);
  }
  Wide operator()(const Capsule& capsule) const {
    const Wide half = Wide(capsule.length) / 2;
    const WidePoint axis(0, 0, std::clamp(p.z(), -half, half));
    return std::max(Wide(0), (p - axis).norm() - Wide(capsule.radius));
  }
  Wide operator()(const HalfSpace&) const { return 0; }
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
  return std::visit(DistanceTo{point}, primitive);
}

RobotDescription random_robot(Random& random, int links) {
  RobotDescription robot;
  robot.name = "chain";
  robot.model = RobotModel("link0");
  for (int i = 0; i < links; ++i) {
    LinkDescription link;
    link.name = "link" + std::to_string(i);
    if (i > 0) {
      Joint joint;
      joint.name = "joint" + std::to_string(i);
      joint.type = JointType::kRevolute;
      joint.parent_from_joint = Pose::from_translation({0, 0, 0.2});
      joint.lower = -1;
      joint.upper = 1;
      robot.model.add_link(link.name, "link" + std::to_string(i - 1), joint);
    }
    const std::size_t shapes = i % 3 == 1 ? 0 : 1 + random.index(2);
    for (std::size_t s = 0; s < shapes; ++s) {
      link.collision.push_back({.name = "",
                                .link_from_shape = random_pose(random, 0.1),
                                .geometry = random_primitive(random, 0.2)});
    }
    robot.links.push_back(link);
  }
  return robot;
}

}  // namespace spherule::test
