// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/bodies.h"
#include "python/bindings/robots.h"
#include "python/bindings/scene.h"
#include "robot/pairs/link_pairs.h"

#include <pybind11/stl.h>
#include <tuple>

namespace spherule::python {
namespace {

py::object pairs_or_none(const std::shared_ptr<const LinkPairs>& pairs) {
  return pairs ? py::cast(unconst(pairs)) : py::object(py::none());
}

std::shared_ptr<const LinkPairs> given_pairs(const py::object& pairs) {
  return pairs.is_none() ? nullptr : pairs.cast<std::shared_ptr<LinkPairs>>();
}

py::object obstacle_shape_object(const ObstacleShape& shape) {
  if (const auto* tree = std::get_if<std::shared_ptr<const SphereTree>>(&shape)) {
    return py::cast(unconst(*tree));
  }
  if (const auto* solid = std::get_if<std::shared_ptr<const SolidMesh>>(&shape)) {
    return py::cast(unconst(*solid));
  }
  return object_of(std::get<Primitive>(shape));
}

// The bodies in the scene, by name.
py::tuple content_state(const RobotScene& scene) {
  py::list obstacles;
  for (const std::string& name : scene.obstacles()) {
    const RobotScene::Obstacle& obstacle = scene.obstacle(name);
    obstacles.append(
        py::make_tuple(name, obstacle_shape_object(obstacle.shape), obstacle.world_from_shape));
  }
  py::list attached;
  for (const std::string& name : scene.attached()) {
    const RobotScene::Attached& object = scene.attached(name);
    attached.append(py::make_tuple(name, object.link, unconst(object.tree), object.link_from_object,
                                   pairs_or_none(object.pairs)));
  }
  return py::make_tuple(obstacles, attached);
}

// What is told of their names.
py::tuple rules_state(const RobotScene& scene) {
  py::list regions;
  for (const auto& [names, spheres] : scene.regions()) {
    py::list all;
    for (const BodySphere& sphere : spheres) all.append(py::make_tuple(sphere.tree, sphere.sphere));
    regions.append(py::make_tuple(names.first, names.second, all));
  }
  py::list contacts;
  for (const RobotScene::Intended& contact : scene.intended_contacts()) {
    contacts.append(py::make_tuple(contact.body, contact.region, contact.other));
  }
  py::dict padding;
  for (const auto& [name, value] : scene.padding()) padding[py::str(name)] = value;
  return py::make_tuple(padding, py::cast(scene.pair_padding()), regions, contacts);
}

void add_content(RobotScene& scene, const py::tuple& state) {
  for (const py::handle entry : state[0]) {
    const auto parts = entry.cast<py::tuple>();
    scene.add(py::str(parts[0]), obstacle_of(parts[1]), parts[2].cast<const Pose&>());
  }
  for (const py::handle entry : state[1]) {
    const auto parts = entry.cast<py::tuple>();
    const std::string name = py::str(parts[0]);
    scene.attach(name, std::string(py::str(parts[1])), parts[2].cast<std::shared_ptr<SphereTree>>(),
                 parts[3].cast<const Pose&>());
    scene.set_attached_pairs(name, given_pairs(parts[4]));
  }
}

void add_rules(RobotScene& scene, const py::tuple& state) {
  for (const auto& [name, value] : py::dict(state[0])) {
    scene.set_padding(std::string(py::str(name)), value.cast<double>());
  }
  using PairPadding = std::map<std::pair<std::string, std::string>, double>;
  for (const auto& [names, value] : state[1].cast<PairPadding>()) {
    // One of the two is a body; which one, only the scene knows.
    const bool is_obstacle = scene.robot().find_link(names.first) < 0 && [&] {
      const auto attached = scene.attached();
      return std::find(attached.begin(), attached.end(), names.first) == attached.end();
    }();
    scene.set_padding(is_obstacle ? names.second : names.first,
                      is_obstacle ? names.first : names.second, value);
  }
  for (const py::handle entry : state[2]) {
    const auto parts = entry.cast<
        std::tuple<std::string, std::string, std::vector<std::pair<std::size_t, std::int32_t>>>>();
    std::vector<BodySphere> spheres;
    for (const auto& [tree, sphere] : std::get<2>(parts)) spheres.push_back({tree, sphere});
    scene.define_region({std::get<0>(parts), std::get<1>(parts)}, spheres);
  }
  for (const py::handle entry : state[3]) {
    const auto [body, region, other] =
        entry.cast<std::tuple<std::string, std::string, std::string>>();
    if (region.empty()) {
      scene.allow_contact(body, other);
    } else {
      scene.allow_contact(Region{body, region}, other);
    }
  }
}

}  // namespace

py::tuple scene_state(const RobotScene& scene) {
  return py::make_tuple(
      std::make_shared<RobotModel>(scene.robot()), scene.world_from_root(),
      std::make_shared<AllowedOfRobot>(AllowedOfRobot{scene.robot(), scene.allowed_collisions()}),
      pairs_or_none(scene.link_pairs()), content_state(scene), rules_state(scene));
}

std::shared_ptr<RobotScene> scene_from(const py::tuple& state) {
  auto scene = std::make_shared<RobotScene>(state[0].cast<const RobotModel&>(),
                                            state[1].cast<const Pose&>());
  scene->set_allowed_collisions(state[2].cast<const AllowedOfRobot&>().allowed);
  scene->set_link_pairs(given_pairs(state[3]));
  add_content(*scene, state[4]);
  add_rules(*scene, state[5]);
  return scene;
}

ObstacleShape obstacle_of(py::handle shape) {
  if (py::isinstance<SphereTree>(shape)) return shape.cast<std::shared_ptr<SphereTree>>();
  if (py::isinstance<SolidMesh>(shape)) return shape.cast<std::shared_ptr<SolidMesh>>();
  if (const auto primitive = primitive_of(shape)) return *primitive;
  return std::make_shared<const SolidMesh>(*mesh_of(
      shape, "shape", "SphereTree, SolidMesh, Box, SolidSphere, Cylinder, Capsule, HalfSpace, "));
}

}  // namespace spherule::python
