// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/robots.h"
#include "python/bindings/support.h"
#include "robot/check/scene_setup.h"
#include "robot/files/scene_file.h"
#include "robot/pairs/link_pairs.h"

#include <pybind11/stl.h>
#include <tuple>

namespace spherule::python {
namespace {

using ScenePointer = std::shared_ptr<RobotScene>;
using SceneClass = py::class_<RobotScene, ScenePointer>;
using Name = const std::string&;

py::tuple prepared(const py::object& robot, const py::object& scene, double max_error,
                   std::uint64_t seed, int effort, int threads, const py::object& progress) {
  RobotCoverOptions cover;
  cover.max_error = max_error;
  cover.seed = seed;
  cover.effort = effort;
  cover.threads = threads;
  auto result = run_long(progress, [model = model_of(robot), file = path_of(scene, "scene"),
                                    cover](const LongRun& run) mutable {
    cover.progress = run.progress;
    cover.stop = run.stop;
    return prepare_scene(model, read_scene(file), cover);
  });
  return py::make_tuple(std::make_shared<RobotScene>(std::move(result.scene)),
                        py::tuple(py::cast(result.warnings)));
}

void bind_obstacles(SceneClass& scene) {
  scene
      .def(
          "add",
          [](RobotScene& self, Name name, const py::object& shape, const py::object& pose) {
            self.add(name, obstacle_of(shape), pose_of(pose, "world_from_shape"));
          },
          py::arg("name"), py::arg("shape"), py::arg("world_from_shape") = py::none(),
          Help("add(self, name, shape, world_from_shape=None)",
               "An obstacle: a SphereTree, SolidMesh, Box, SolidSphere, Cylinder, Capsule, "
               "HalfSpace, "
               "or a mesh, which counts with its inside.")
              .c_str())
      .def(
          "move",
          [](RobotScene& self, Name obstacle, const py::object& pose) {
            self.move(obstacle, pose_of(pose, "world_from_shape"));
          },
          py::arg("obstacle"), py::arg("world_from_shape"),
          Help("move(self, obstacle, world_from_shape)", "Places an obstacle elsewhere.").c_str())
      .def(
          "remove", [](RobotScene& self, Name obstacle) { self.remove(obstacle); },
          py::arg("obstacle"),
          Help("remove(self, obstacle)", "With the contacts and paddings that name it.").c_str())
      .def_property_readonly(
          "obstacles", [](const RobotScene& self) { return py::tuple(py::cast(self.obstacles())); },
          "Their names, in alphabetical order.")
      .def(
          "attach",
          [](RobotScene& self, Name name, Name link, const std::shared_ptr<SphereTree>& tree,
             const py::object& pose) {
            self.attach(name, link, tree, pose_of(pose, "link_from_object"));
          },
          py::arg("name"), py::arg("link"), py::arg("tree"),
          py::arg("link_from_object") = py::none(),
          Help("attach(self, name, link, tree, link_from_object=None)",
               "Spheres that move with a link.")
              .c_str())
      .def(
          "detach", [](RobotScene& self, Name object) { self.detach(object); }, py::arg("object"),
          Help("detach(self, object)", "With what names it.").c_str())
      .def_property_readonly(
          "attached",
          [](const RobotScene& self) {
            return py::tuple(py::cast(std::as_const(self).attached()));
          },
          "Their names, in alphabetical order.");
}

// The region is None for all of the body.
void allow(RobotScene& self, Name body, Name other, const std::optional<std::string>& region) {
  if (region) return self.allow_contact(Region{body, *region}, other);
  self.allow_contact(body, other);
}

void forbid(RobotScene& self, Name body, Name other, const std::optional<std::string>& region) {
  if (region) return self.forbid_contact(Region{body, *region}, other);
  self.forbid_contact(body, other);
}

void set_padding(RobotScene& self, Name body, double padding,
                 const std::optional<std::string>& other) {
  if (other) return self.set_padding(body, *other, padding);
  self.set_padding(body, padding);
}

void define_region(RobotScene& self, Name body, Name name, const py::object& around) {
  self.define_region(Region{body, name}, sphere(around, "around"));
}

void bind_rules(SceneClass& scene) {
  scene
      .def("set_padding", &set_padding, py::arg("body"), py::arg("padding"),
           py::arg("other") = py::none(),
           Help("set_padding(self, body, padding, other=None)",
                "Every sphere of the body grows by so much, in metres; with `other`, the two are "
                "kept "
                "apart by so much more.")
               .c_str())
      .def(
          "define_region", &define_region, py::arg("body"), py::arg("name"), py::arg("around"),
          Help(
              "define_region(self, body, name, around)",
              "Names the spheres of a body whose centre lies in `around`, shape (4,), in the frame "
              "of the link or object.")
              .c_str())
      .def("allow_contact", &allow, py::arg("body"), py::arg("other"),
           py::arg("region") = py::none(),
           Help("allow_contact(self, body, other, region=None)",
                "The two may touch, or only that region of the body.")
               .c_str())
      .def("forbid_contact", &forbid, py::arg("body"), py::arg("other"),
           py::arg("region") = py::none(),
           Help("forbid_contact(self, body, other, region=None)", "Takes that back.").c_str())
      .def(
          "set_allowed_collisions",
          [](RobotScene& self, const AllowedOfRobot& allowed) {
            self.set_allowed_collisions(allowed.allowed);
          },
          py::arg("allowed"),
          Help("set_allowed_collisions(self, allowed)", "Which links may touch each other.")
              .c_str())
      .def_property_readonly("allowed_collisions",
                             [](const RobotScene& self) {
                               return std::make_shared<AllowedOfRobot>(
                                   AllowedOfRobot{self.robot(), self.allowed_collisions()});
                             })
      .def(
          "set_link_pairs",
          [](RobotScene& self, const std::shared_ptr<LinkPairs>& pairs) {
            self.set_link_pairs(pairs);
          },
          py::arg("pairs"),
          Help("set_link_pairs(self, pairs)", "What is proved of the links (LinkPairs), or None.")
              .c_str())
      .def(
          "reason",
          [](const RobotScene& self, Name a, Name b) {
            return std::string(word_of(self.reason(a, b)));
          },
          py::arg("first"), py::arg("second"),
          Help("reason(self, first, second)",
               "Why two links are not tested against each other, or not everywhere.")
              .c_str());
}

}  // namespace

void bind_scene(py::module_& module) {
  SceneClass scene(
      module, "RobotScene",
      Help("RobotScene(robot, world_from_root=None)",
           "A robot that carries spheres (with_spheres()) and what is around it, to be "
           "edited; snapshot() makes what is queried. Metres. Links, attached objects and "
           "obstacles share one space of names.")
          .c_str());
  scene.def(py::init([](const py::object& robot, const py::object& world_from_root) {
              return std::make_shared<RobotScene>(model_of(robot),
                                                  pose_of(world_from_root, "world_from_root"));
            }),
            py::arg("robot"), py::arg("world_from_root") = py::none());
  bind_obstacles(scene);
  bind_rules(scene);
  scene
      .def_property_readonly(
          "robot",
          [](const RobotScene& self) { return std::make_shared<RobotModel>(self.robot()); })
      .def_property_readonly("world_from_root", &RobotScene::world_from_root)
      .def("snapshot", &snapshot, py::kw_only(), py::arg("enforce_limits") = false,
           py::arg("instructions") = py::none(), py::arg("meshes") = py::tuple(),
           Help("snapshot(self, *, enforce_limits=False, instructions=None, meshes=())",
                "What is queried, as of now: a RobotChecker. `enforce_limits`: a joint outside its "
                "limits counts as a collision. `meshes`: CoveredMesh whose `cover` is a tree of a "
                "body; its contacts are confirmed on triangles. `instructions` is 'portable', "
                "'avx2', "
                "'avx512' or None, the fastest; answers are equal.")
               .c_str())
      .def("__repr__",
           [](const RobotScene& self) {
             return "<spherule.RobotScene: robot of " +
                    std::to_string(self.robot().links().size()) + " links, " +
                    std::to_string(self.obstacles().size()) + " obstacles, " +
                    std::to_string(std::as_const(self).attached().size()) + " attached>";
           })
      .def(py::pickle(&scene_state, &scene_from));
  const RobotCoverOptions defaults;
  module.def(
      "prepare_scene", &prepared, py::arg("robot"), py::arg("scene"), py::kw_only(),
      py::arg("max_error") = defaults.max_error, py::arg("seed") = defaults.seed,
      py::arg("effort") = defaults.effort, py::arg("threads") = defaults.threads,
      py::arg("progress") = py::none(),
      Help("prepare_scene(robot, scene, *, max_error=0.01, seed=1, effort=60, threads=0, "
           "progress=None)",
           "Reads a scene file (docs/scene-file.md) and what it names, and puts everything in "
           "its place around a robot that carries spheres: a RobotScene, and warnings. Attached "
           "meshes are covered with spheres of `max_error`, unless the file gives another.")
          .c_str());
}

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
