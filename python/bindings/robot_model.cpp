// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/robot_model.h"

#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/long_run.h"
#include "python/bindings/robots.h"
#include "robot/model/kinematics.h"
#include "robot/model/link_spheres.h"
#include "spheretree/error.h"

#include <array>
#include <pybind11/stl.h>

namespace spherule::python {
namespace {

using ModelPointer = std::shared_ptr<RobotModel>;

constexpr std::array kJointTypes = {"fixed", "revolute", "prismatic", "continuous"};

Joint joint_of(const py::object& object) {
  Joint joint;
  joint.name = py::str(object.attr("name"));
  joint.type = static_cast<JointType>(
      choice(object.attr("type"), {"fixed", "revolute", "prismatic", "continuous"}, "type"));
  joint.parent_from_joint = pose_of(object.attr("parent_from_joint"), "parent_from_joint");
  joint.axis = vector3(object.attr("axis"), "axis");
  joint.lower = number_of(object, "lower");
  joint.upper = number_of(object, "upper");
  return joint;
}

py::object joint_object(const RobotModel& robot, const Joint& joint) {
  const auto name_of_link = [&](int link) {
    return robot.links()[static_cast<std::size_t>(link)].name;
  };
  const std::string mimics =
      joint.mimics < 0 ? "" : robot.joints()[static_cast<std::size_t>(joint.mimics)].name;
  return make_result("Joint", joint.name, kJointTypes[static_cast<std::size_t>(joint.type)],
                     joint.parent_from_joint,
                     py::make_tuple(joint.axis.x(), joint.axis.y(), joint.axis.z()), joint.lower,
                     joint.upper, name_of_link(joint.parent_link), name_of_link(joint.child_link),
                     joint.variable, joint.multiplier, joint.offset, mimics);
}

py::tuple joints_object(const RobotModel& robot) {
  py::list result;
  for (const Joint& joint : robot.joints()) result.append(joint_object(robot, joint));
  return py::tuple(result);
}

py::tuple trees_object(const Link& link) {
  py::list trees;
  for (const auto& tree : link.trees) trees.append(unconst(tree));
  return py::tuple(trees);
}

py::tuple links_object(const RobotModel& robot) {
  py::list result;
  for (const Link& link : robot.links()) {
    const std::string joint =
        link.parent_joint < 0 ? ""
                              : robot.joints()[static_cast<std::size_t>(link.parent_joint)].name;
    result.append(make_result("Link", link.name, joint, trees_object(link)));
  }
  return py::tuple(result);
}

// Limits of the variables, shape (dof, 2).
py::array limits_of(const RobotModel& robot) {
  std::vector<std::array<double, 2>> limits;
  for (const int index : robot.variable_joints()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    limits.push_back({joint.lower, joint.upper});
  }
  return owned<double>(std::move(limits), 2);
}

py::tuple variable_names(const RobotModel& robot) {
  py::list names;
  for (const int index : robot.variable_joints()) {
    names.append(robot.joints()[static_cast<std::size_t>(index)].name);
  }
  return py::tuple(names);
}

// The root's name and trees, the joints with their links, and the mimics, bit for bit.
py::tuple model_state(const RobotModel& robot) {
  py::list joints;
  for (std::size_t i = 0; i < robot.joints().size(); ++i) {
    const Joint& joint = robot.joints()[i];
    const RobotModel::Mimic& mimic = robot.mimics()[i];
    joints.append(py::make_tuple(joint_object(robot, joint), mimic.multiplier, mimic.offset));
  }
  py::list trees;
  for (const Link& link : robot.links()) trees.append(trees_object(link));
  return py::make_tuple(robot.links()[0].name, joints, trees);
}

ModelPointer model_from(const py::tuple& state) {
  auto robot = std::make_shared<RobotModel>(std::string(py::str(state[0])));
  for (const py::handle entry : state[1]) {
    const py::object joint = entry.cast<py::tuple>()[0];
    robot->add_copied_link(py::str(joint.attr("child_link")),
                           std::string(py::str(joint.attr("parent_link"))), joint_of(joint));
  }
  for (const py::handle entry : state[1]) {
    const auto parts = entry.cast<py::tuple>();
    const std::string leader = py::str(parts[0].attr("mimics"));
    if (leader.empty()) continue;
    robot->mimic(std::string(py::str(parts[0].attr("name"))), leader, parts[1].cast<double>(),
                 parts[2].cast<double>());
  }
  std::size_t link = 0;
  for (const py::handle trees : state[2]) {
    const std::string name = robot->links()[link++].name;
    for (const py::handle tree : trees) {
      robot->attach(name, tree.cast<std::shared_ptr<SphereTree>>());
    }
  }
  return robot;
}

std::size_t sphere_count(const RobotModel& robot) {
  std::size_t count = 0;
  for (const Link& link : robot.links()) {
    for (const auto& tree : link.trees) count += tree->spheres().size();
  }
  return count;
}

py::tuple poses_of_links(const py::object& robot, const py::object& configuration,
                         const py::object& world_from_root) {
  const RobotModel& model = model_of(robot);
  const Numbers positions =
      row(configuration, static_cast<std::size_t>(model.variable_count()), "configuration");
  std::vector<Pose> poses;
  forward_kinematics(model, {positions.data, positions.size}, poses,
                     pose_of(world_from_root, "world_from_root"));
  return py::tuple(py::cast(poses));
}

void bind_model_edits(py::class_<RobotModel, ModelPointer>& model) {
  model
      .def(
          "add_link",
          [](RobotModel& robot, std::string name, const std::string& parent,
             const py::object& joint) {
            return robot.add_link(std::move(name), parent, joint_of(joint));
          },
          py::arg("name"), py::arg("parent_link"), py::arg("joint"),
          Help("add_link(self, name, parent_link, joint)",
               "Adds a link below another through a Joint (its name, type, parent_from_joint, axis "
               "and limits count) and returns its index.")
              .c_str())
      .def("mimic", &RobotModel::mimic, py::arg("joint"), py::arg("other"),
           py::arg("multiplier") = 1.0, py::arg("offset") = 0.0,
           Help("mimic(self, joint, other, multiplier=1.0, offset=0.0)",
                "From now on `joint` stands at multiplier * (position of `other`) + offset.")
               .c_str())
      .def(
          "attach",
          [](RobotModel& robot, const std::string& link, const std::shared_ptr<SphereTree>& tree) {
            robot.attach(link, tree);
          },
          py::arg("link"), py::arg("tree"),
          Help("attach(self, link, tree)", "Attaches a SphereTree to a link, in its frame.")
              .c_str());
}

}  // namespace

const RobotModel& model_of(py::handle robot) {
  if (py::isinstance<RobotModel>(robot)) return robot.cast<const RobotModel&>();
  return description_of(robot)->model;
}

void bind_robot_model(py::module_& module) {
  py::class_<RobotModel, ModelPointer> model(
      module, "RobotModel",
      Help("RobotModel(root_link='base_link')",
           "A jointed mechanism of links and joints; metres and radians. A configuration has one "
           "number for each joint that moves and mimics no other: shape (dof,).")
          .c_str());
  model.def(py::init<std::string>(), py::arg("root_link") = "base_link");
  bind_model_edits(model);
  model.def_property_readonly("links", &links_object)
      .def_property_readonly("joints", &joints_object)
      .def_property_readonly("variable_count", &RobotModel::variable_count, "dof.")
      .def_property_readonly("variable_joints", &variable_names,
                             "The joint whose position each number of a configuration is.")
      .def_property_readonly("limits", &limits_of, "Of a configuration's numbers, shape (dof, 2).")
      .def_property_readonly("sphere_count", &sphere_count)
      .def(
          "find_link",
          [](const RobotModel& robot, const std::string& name) { return robot.find_link(name); },
          py::arg("name"), Help("find_link(self, name)", "Index of a link, or -1.").c_str())
      .def(
          "find_joint",
          [](const RobotModel& robot, const std::string& name) { return robot.find_joint(name); },
          py::arg("name"), Help("find_joint(self, name)", "Index of a joint, or -1.").c_str())
      .def("__repr__",
           [](const RobotModel& robot) {
             return "<spherule.RobotModel: " + std::to_string(robot.links().size()) + " links, " +
                    std::to_string(robot.variable_count()) + " variables, " +
                    std::to_string(sphere_count(robot)) + " spheres>";
           })
      .def(py::pickle(&model_state, &model_from));
  module.def(
      "with_spheres",
      [](const py::object& robot, const py::object& spheres) {
        return std::make_shared<RobotModel>(
            with_spheres(model_of(robot), link_spheres_of(spheres)));
      },
      py::arg("robot"), py::arg("spheres"),
      Help("with_spheres(robot, spheres)",
           "The RobotModel with a tree on every link that has spheres: what RobotScene takes. "
           "`spheres` is a dict of arrays of shape (n, 4) by link, or a RobotSpheres.")
          .c_str());
  module.def(
      "forward_kinematics", &poses_of_links, py::arg("robot"), py::arg("configuration"),
      py::arg("world_from_root") = py::none(),
      Help("forward_kinematics(robot, configuration, world_from_root=None)",
           "Poses world_from_link of all links, in their order, for a configuration of shape "
           "(dof,).")
          .c_str());
}

}  // namespace spherule::python
