// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/robot_scenes.h"

#include "base/rounding.h"
#include "collide/collide.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/exact/spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <variant>

namespace spherule::test {
namespace {

// Along an axis now and then.
Eigen::Vector3d any_direction(Random& random) {
  return random.chance(0.1)
             ? Eigen::Vector3d(random.sign() * Eigen::Vector3d::Unit(random.whole(0, 2)))
             : random.direction();
}

// Unit or of any length; now and then no turn at all.
Eigen::Quaterniond any_rotation(Random& random) {
  if (random.chance(0.05)) return Eigen::Quaterniond::Identity();
  return random.coin() ? random.quaternion() : random.rotation();
}

double random_size_of_scene(Random& random) {
  return random.chance(0.6) ? 1.0 : random.magnitude(1e-3, 1e3);
}

Pose random_root(Random& random, double size) {
  if (random.chance(0.4)) return Pose();
  const double far = random.chance(0.2) ? random.magnitude(1.0, 1e6) : 1.0;
  // A scene takes it with a unit rotation.
  return Pose(unit_rotation(any_rotation(random)), random.point(far * size));
}

std::shared_ptr<const SphereTree> body_tree(Random& random, double size) {
  const double kind = random.unit();
  const int count = kind < 0.3 ? 1 : kind < 0.95 ? random.whole(2, 12) : random.whole(20, 120);
  std::vector<Sphere> spheres;
  const Eigen::Vector3d along = 0.5 * size * any_direction(random);
  for (int i = 0; i < count; ++i) {
    const double radius = random.chance(0.1) ? 0.0 : size * random.between(0.01, 0.1);
    spheres.push_back({along * random.unit() + random.point(0.1 * size), radius});
  }
  if (random.chance(0.1)) spheres[0].center.setZero();
  return std::make_shared<const SphereTree>(
      build_tree(spheres, {.branching = random.whole(2, SphereTree::kMaxBranching)}));
}

TriangleMesh tetrahedron(Random& random, double size) {
  TriangleMesh mesh;
  const Eigen::Vector3d place = random.point(0.3 * size);
  mesh.vertices = {place, place + size * Eigen::Vector3d::UnitX(),
                   place + size * Eigen::Vector3d::UnitY(),
                   place + size * random.between(0.1, 1.0) * Eigen::Vector3d::UnitZ()};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

std::string numbered(const char* name, std::size_t i) {
  return name + std::to_string(i);
}

}  // namespace

CheckerScene::CheckerScene(Random& random)
    : size_(random_size_of_scene(random)),
      world_from_root_(random_root(random, size_)),
      scene_(make_robot(random), world_from_root_),
      carrier_(scene_.robot()) {
  make_bodies(random);
  make_obstacles(random);
  make_pairs(random);
}

RobotModel CheckerScene::make_robot(Random& random) {
  RobotModel robot("link_0");
  std::vector<std::string> moving;
  const int joints = random.whole(1, random.chance(0.1) ? 24 : 7);
  const bool is_chain = random.chance(0.5);
  if (random.chance(0.5)) robot.attach("link_0", body_tree(random, size_));
  for (int i = 1; i <= joints; ++i) {
    Joint joint;
    joint.name = numbered("joint_", static_cast<std::size_t>(i));
    const double kind = random.unit();
    joint.type = kind < 0.5    ? JointType::kRevolute
                 : kind < 0.7  ? JointType::kContinuous
                 : kind < 0.85 ? JointType::kPrismatic
                               : JointType::kFixed;
    if (i == joints && moving.empty()) joint.type = JointType::kRevolute;
    joint.axis = any_direction(random);
    joint.parent_from_joint =
        random.chance(0.1) ? Pose() : Pose(any_rotation(random), random.point(0.5 * size_));
    joint.lower = -kLargestJointPosition;
    joint.upper = kLargestJointPosition;
    if (joint.type != JointType::kFixed) moving.push_back(joint.name);
    const int parent = is_chain ? i - 1 : random.whole(0, i - 1);
    const std::string link = numbered("link_", static_cast<std::size_t>(i));
    robot.add_link(link, numbered("link_", static_cast<std::size_t>(parent)), joint);
    const int trees = i == joints ? random.whole(1, 2) : random.whole(0, 2);
    for (int t = 0; t < trees; ++t) robot.attach(link, body_tree(random, size_));
  }
  for (std::size_t i = 1; i < moving.size(); ++i) {
    if (!random.chance(0.15)) continue;
    const double multiplier =
        random.chance(0.2) ? random.magnitude(1e-6, 1e6) : random.between(-2.0, 2.0);
    double offset = random.chance(0.5) ? 0.0 : random.between(-3.0, 3.0);
    if (random.chance(0.1)) offset = std::clamp(-multiplier * random.between(-3.0, 3.0), -1e5, 1e5);
    robot.mimic(moving[i], moving[i - 1], multiplier, offset);
  }
  return robot;
}

void CheckerScene::make_bodies(Random& random) {
  for (std::size_t i = 0; i < robot().links().size(); ++i) {
    const Link& link = robot().links()[i];
    bodies_.push_back({link.name, true, static_cast<int>(i), link.trees});
  }
  for (int i = random.chance(0.3) ? random.whole(1, 2) : 0; i > 0; --i) {
    // In the order of the names.
    const std::string name = numbered("object_", static_cast<std::size_t>(3 - i));
    const std::string& link = robot().links().back().name;
    const Pose link_from_object(any_rotation(random), random.point(0.3 * size_));
    const Tree tree = body_tree(random, size_);
    scene_.attach(name, link, tree, link_from_object);
    Joint joint;
    joint.type = JointType::kFixed;
    joint.parent_from_joint = link_from_object;
    bodies_.push_back({name, false, carrier_.add_link(name, link, joint), {tree}});
  }
  for (Body& body : bodies_) {
    if (body.trees.empty()) continue;
    if (random.chance(0.1)) {
      body.padding = random.magnitude(1e-6, 0.1) * size_;
      scene_.set_padding(body.name, body.padding);
    }
    if (!random.chance(0.1)) continue;
    const auto tree =
        static_cast<std::size_t>(random.whole(0, static_cast<int>(body.trees.size()) - 1));
    for (std::size_t i = 0; i < body.trees[tree]->spheres().size(); ++i) {
      if (i == 0 || random.chance(0.4)) body.region.push_back({tree, static_cast<std::int32_t>(i)});
    }
    scene_.define_region({body.name, "part"}, body.region);
  }
}

ObstacleShape CheckerScene::make_shape(Random& random) const {
  const auto length = [&] {
    const double kind = random.unit();
    return size_ * (kind < 0.7    ? random.between(0.05, 0.8)
                    : kind < 0.85 ? random.magnitude(1e-8, 1e-2)
                                  : random.magnitude(1.0, 300.0));
  };
  switch (random.whole(0, 7)) {
    case 0:
    case 1:
      return Primitive(Box{{length(), length(), length()}});
    case 2:
      return Primitive(SolidSphere{length()});
    case 3:
      return Primitive(Cylinder{length(), length()});
    case 4:
      return Primitive(Capsule{length(), random.chance(0.1) ? 0.0 : length()});
    case 5:
      return Primitive(HalfSpace());
    case 6:
      return body_tree(random, size_);
    default:
      return std::make_shared<const SolidMesh>(tetrahedron(random, 0.5 * size_));
  }
}

void CheckerScene::make_obstacles(Random& random) {
  const double kind = random.unit();
  int count = kind < 0.2 ? 0 : kind < 0.9 ? random.whole(1, 6) : random.whole(8, 40);
  for (std::size_t i = 0; count > 0; ++i, --count) {
    const std::string name = numbered("thing_", i);
    const ObstacleShape shape = make_shape(random);
    // Large ones beside the robot.
    double radius = 0.0;
    if (const auto* const primitive = std::get_if<Primitive>(&shape)) {
      if (const auto* const box = std::get_if<Box>(primitive)) radius = 0.5 * box->size.minCoeff();
      if (const auto* const sphere = std::get_if<SolidSphere>(primitive)) radius = sphere->radius;
      if (const auto* const solid = std::get_if<Capsule>(primitive)) radius = solid->radius;
    }
    const Eigen::Vector3d at = (radius + size_ * random.between(0.3, 2.0)) * any_direction(random);
    const Pose world_from_shape =
        world_from_root_ *
        Pose(random.chance(0.2) ? Eigen::Quaterniond::Identity() : any_rotation(random), at);
    scene_.add(name, shape, world_from_shape);
    obstacles_.push_back({name, shape, world_from_shape});
  }
}

bool CheckerScene::is_moved(int first, int second) const {
  const auto path = [&](int link) {
    std::vector<int> joints;
    for (int j = carrier_.links()[static_cast<std::size_t>(link)].parent_joint; j >= 0;) {
      const Joint& joint = carrier_.joints()[static_cast<std::size_t>(j)];
      if (joint.moves()) joints.push_back(j);
      j = carrier_.links()[static_cast<std::size_t>(joint.parent_link)].parent_joint;
    }
    return joints;
  };
  return path(first) != path(second);
}

// The trees that a snapshot makes: within rounding of contact the answer depends on the tree.
std::vector<std::shared_ptr<const SphereTree>> CheckerScene::inflated(const Body& body,
                                                                      double padding,
                                                                      bool without_region) const {
  std::vector<Tree> result;
  for (std::size_t t = 0; t < body.trees.size(); ++t) {
    const Tree& tree = body.trees[t];
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < tree->spheres().size(); ++i) {
      const BodySphere here{t, static_cast<std::int32_t>(i)};
      if (without_region && std::count(body.region.begin(), body.region.end(), here) != 0) continue;
      spheres.push_back(tree->spheres()[i]);
      if (padding > 0.0) spheres.back().radius = add_up(spheres.back().radius, padding);
    }
    if (spheres.empty()) continue;
    if (spheres.size() < tree->spheres().size()) {
      result.push_back(std::make_shared<const SphereTree>(build_tree(spheres)));
    } else {
      result.push_back(padding > 0.0 ? std::make_shared<const SphereTree>(refit(*tree, spheres))
                                     : tree);
    }
  }
  return result;
}

// The padding of a pair goes to the first body, as in a snapshot.
void CheckerScene::make_pairs(Random& random) {
  for (std::size_t b = bodies_.size(); b-- > 0;) {
    const Body& body = bodies_[b];
    const auto settle = [&](const std::string& other, double& between, bool& region) {
      if (random.chance(0.05)) {
        between = random.magnitude(1e-6, 0.1) * size_;
        scene_.set_padding(body.name, other, between);
      }
      if (random.chance(0.1)) {
        region = !body.region.empty() && random.chance(0.7);
        if (region) {
          scene_.allow_contact(Region{body.name, "part"}, other);
        } else {
          scene_.allow_contact(body.name, other);
          return false;
        }
      }
      return true;
    };
    const std::size_t none = obstacles_.size();
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
      double between = 0.0;
      bool region = false;
      if (!settle(obstacles_[i].name, between, region)) continue;
      for (const Tree& tree : inflated(body, sum_up(body.padding, between), region)) {
        pairs_.push_back({tree, body.link, nullptr, 0, i});
      }
    }
    for (std::size_t o = b; o-- > 0;) {
      const Body& other = bodies_[o];
      double between = 0.0;
      bool region = false;
      if (!settle(other.name, between, region)) continue;
      const bool is_tested = body.is_link && other.is_link
                                 ? !scene_.allowed_collisions().allows(body.link, other.link)
                                 : is_moved(body.link, other.link);
      if (!is_tested) continue;
      const std::vector<Tree> others = inflated(other, other.padding, false);
      for (const Tree& tree : inflated(body, sum_up(body.padding, between), region)) {
        for (const Tree& second : others) {
          pairs_.push_back({tree, body.link, second, other.link, none});
        }
      }
    }
  }
}

std::vector<double> CheckerScene::anywhere(Random& random) const {
  std::vector<double> configuration;
  const double far = random.chance(0.05) ? 95.0 : std::numbers::pi;
  for (const int j : robot().variable_joints()) {
    const bool turns = robot().joints()[static_cast<std::size_t>(j)].turns();
    const double reach =
        turns ? far : std::min(kLargestJointPosition, random.between(0.2, 2.0) * size_);
    configuration.push_back(random.between(-reach, reach));
  }
  for (int i = 0; i < 60 && !in_filter_range(configuration); ++i) {
    for (double& variable : configuration) variable *= 0.5;
  }
  return configuration;
}

bool CheckerScene::in_filter_range(std::span<const double> configuration) const {
  return std::all_of(robot().joints().begin(), robot().joints().end(), [&](const Joint& joint) {
    return std::abs(joint.position(configuration)) <= kLargestJointPosition;
  });
}

template <class Use>
auto CheckerScene::with_shapes(const Pair& pair, const Use& use) const {
  const Pose& pose = pose_of(pair.link);
  if (pair.other) return use(*pair.tree, pose, *pair.other, pose_of(pair.other_link));
  const auto& [name, shape, world_from_shape] = obstacles_[pair.obstacle];
  if (const auto* const solid = std::get_if<Primitive>(&shape)) {
    return use(*pair.tree, pose, *solid, world_from_shape);
  }
  if (const auto* const tree = std::get_if<Tree>(&shape)) {
    return use(*pair.tree, pose, **tree, world_from_shape);
  }
  return use(*pair.tree, pose, *std::get<std::shared_ptr<const SolidMesh>>(shape),
             world_from_shape);
}

bool CheckerScene::touches(std::span<const double> configuration) {
  forward_kinematics(carrier_, configuration, world_from_link_, world_from_root_);
  const auto touches_pair = [&](const Pair& pair) {
    return with_shapes(pair, [](const auto&... shapes) { return collides(shapes...); });
  };
  if (last_ < pairs_.size() && touches_pair(pairs_[last_])) return true;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (i == last_ || !touches_pair(pairs_[i])) continue;
    last_ = i;
    return true;
  }
  return false;
}

double CheckerScene::gap(std::span<const double> configuration) {
  forward_kinematics(carrier_, configuration, world_from_link_, world_from_root_);
  double least = std::numeric_limits<double>::infinity();
  for (const Pair& pair : pairs_) {
    least = std::min(
        least, with_shapes(pair, [](const auto&... shapes) { return distance(shapes...).upper; }));
  }
  return least;
}

std::string CheckerScene::fault_of_trees(std::span<const double> configuration) {
  forward_kinematics(carrier_, configuration, world_from_link_, world_from_root_);
  std::string fault;
  for (const Pair& pair : pairs_) {
    with_shapes(pair, [&](const SphereTree& tree, const Pose& pose, const auto& other,
                          const Pose& its_pose) {
      if constexpr (std::is_same_v<decltype(other), const SphereTree&>) {
        const PlacedSet a{tree.spheres(), pose}, b{other.spheres(), its_pose};
        const bool hit = collides(tree, pose, other, its_pose);
        if (hit == touch_exactly(a, b)) return;
        if (!hit) fault = "missed";
        if (hit && exact_gap(a, b) > collision_slack(tree, pose, other, its_pose)) {
          fault = "beyond the slack";
        }
      }
    });
  }
  return fault;
}

std::optional<CheckerScene::Border> CheckerScene::find_border(Random& random) {
  std::optional<std::vector<double>> free, contact;
  for (int i = 0; i < 12 && !(free && contact); ++i) {
    std::vector<double> next = anywhere(random);
    (touches(next) ? contact : free) = std::move(next);
  }
  if (!free || !contact) return std::nullopt;
  Border border{*free, *contact};
  // Along one variable if that will do.
  const auto variable =
      static_cast<std::size_t>(random.whole(0, static_cast<int>(border.free.size()) - 1));
  std::vector<double> turned = border.free;
  turned[variable] = border.contact[variable];
  if (touches(turned)) {
    border.contact = turned;
  }
  for (int i = 0; i < 60; ++i) {
    std::vector<double> middle = border.free;
    for (std::size_t k = 0; k < middle.size(); ++k) {
      middle[k] = 0.5 * border.free[k] + 0.5 * border.contact[k];
    }
    if (middle == border.free || middle == border.contact) break;
    (touches(middle) ? border.contact : border.free) = middle;
  }
  return border;
}

}  // namespace spherule::test
