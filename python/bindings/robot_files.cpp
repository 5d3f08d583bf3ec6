// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/bodies.h"
#include "python/bindings/long_run.h"
#include "python/bindings/robots.h"
#include "robot/files/trajectory_file.h"
#include "robot/files/urdf.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

using DescriptionPointer = std::shared_ptr<RobotDescription>;

py::object shape_object(const LinkShape& shape) {
  py::object geometry;
  if (const auto* file = std::get_if<MeshFile>(&shape.geometry)) {
    const Eigen::Vector3d& scale = file->scale;
    geometry = make_result("MeshFile", path_object(file->path.string()),
                           py::make_tuple(scale.x(), scale.y(), scale.z()));
  } else {
    geometry = object_of(std::get<Primitive>(shape.geometry));
  }
  return make_result("LinkShape", shape.name, shape.link_from_shape, geometry);
}

LinkShape shape_of_link(py::handle shape) {
  LinkShape result;
  result.name = py::str(shape.attr("name"));
  result.link_from_shape = pose_of(shape.attr("link_from_shape"), "link_from_shape");
  const py::object geometry = shape.attr("geometry");
  if (const auto primitive = primitive_of(geometry)) {
    result.geometry = *primitive;
  } else {
    result.geometry =
        MeshFile{path_of(geometry.attr("path"), "path"), vector3(geometry.attr("scale"), "scale")};
  }
  return result;
}

py::tuple shapes_object(const std::vector<LinkShape>& shapes) {
  py::list result;
  for (const LinkShape& shape : shapes) result.append(shape_object(shape));
  return py::tuple(result);
}

std::vector<LinkShape> shapes_of(const py::object& shapes) {
  std::vector<LinkShape> result;
  for (const py::handle shape : shapes) result.push_back(shape_of_link(shape));
  return result;
}

py::tuple described_links(const RobotDescription& robot) {
  py::list result;
  for (const LinkDescription& link : robot.links) {
    result.append(make_result("LinkDescription", link.name, shapes_object(link.visual),
                              shapes_object(link.collision)));
  }
  return py::tuple(result);
}

DescriptionPointer made_description(std::string name, const RobotModel& model,
                                    const py::object& links) {
  auto robot =
      std::make_shared<RobotDescription>(RobotDescription{.name = std::move(name), .model = model});
  for (const py::handle link : links) {
    robot->links.push_back({.name = py::str(link.attr("name")),
                            .visual = shapes_of(link.attr("visual")),
                            .collision = shapes_of(link.attr("collision"))});
  }
  return robot;
}

DescriptionPointer read_urdf_file(const py::object& path, const py::dict& packages,
                                  bool require_visual, bool require_collision) {
  UrdfOptions options;
  for (const auto& [name, root] : packages) {
    options.packages.emplace(py::str(name), path_of(root, "packages"));
  }
  options.require_visual_meshes = require_visual;
  options.require_collision_meshes = require_collision;
  const std::string file = path_of(path, "path");
  const WithoutLock unlocked;
  return std::make_shared<RobotDescription>(read_urdf(file, options));
}

py::object group_object(const JointGroup& group) {
  py::list chains;
  for (const LinkChain& chain : group.chains) {
    chains.append(py::make_tuple(chain.base_link, chain.tip_link));
  }
  const auto names = [](const std::vector<std::string>& all) { return py::tuple(py::cast(all)); };
  return make_result("JointGroup", group.name, names(group.links), names(group.joints),
                     py::tuple(chains), names(group.subgroups));
}

py::object semantics_object(const SemanticDescription& semantics) {
  py::list groups;
  for (const JointGroup& group : semantics.groups) groups.append(group_object(group));
  py::list states;
  for (const GroupState& state : semantics.group_states) {
    py::dict joints;
    for (const JointState& joint : state.joints) {
      joints[py::str(joint.joint)] = py::tuple(py::cast(joint.position));
    }
    states.append(make_result("GroupState", state.name, state.group, joints));
  }
  py::list effectors;
  for (const EndEffector& tool : semantics.end_effectors) {
    effectors.append(
        make_result("EndEffector", tool.name, tool.group, tool.parent_link, tool.parent_group));
  }
  return make_result("SemanticDescription", semantics.robot_name, py::tuple(groups),
                     py::tuple(states), py::tuple(effectors),
                     pairs_object(semantics.disabled_pairs),
                     spheres_object(semantics.sphere_approximations));
}

py::array trajectory(const py::object& path, const py::object& robot, const py::object& angles) {
  const auto unit = static_cast<AngleUnit>(choice(angles, {"radians", "degrees"}, "angles"));
  Trajectory read = read_trajectory(path_of(path, "path"), model_of(robot), unit);
  const auto width = static_cast<py::ssize_t>(read.width);
  return array_of(std::move(read.positions)).reshape({py::ssize_t{-1}, width});
}

void bind_description(py::module_& module) {
  py::class_<RobotDescription, DescriptionPointer>(
      module, "RobotDescription",
      Help("RobotDescription(name, model, links=())",
           "A robot as a file describes it: `model` has no trees yet, `links` are LinkDescription "
           "in "
           "the order of the model's.")
          .c_str())
      .def(py::init(&made_description), py::arg("name"), py::arg("model"),
           py::arg("links") = py::tuple())
      .def_readonly("name", &RobotDescription::name)
      .def_property_readonly(
          "model",
          [](const RobotDescription& robot) { return std::make_shared<RobotModel>(robot.model); },
          "A copy of the mechanism.")
      .def_property_readonly("links", &described_links)
      .def("__repr__",
           [](const RobotDescription& robot) {
             return "<spherule.RobotDescription: " + robot.name + ", " +
                    std::to_string(robot.links.size()) + " links, " +
                    std::to_string(robot.model.variable_count()) + " variables>";
           })
      .def(py::pickle(
          [](const RobotDescription& robot) {
            return py::make_tuple(robot.name, std::make_shared<RobotModel>(robot.model),
                                  described_links(robot));
          },
          [](const py::tuple& state) {
            return made_description(py::str(state[0]), state[1].cast<const RobotModel&>(),
                                    state[2]);
          }));
}

}  // namespace

std::shared_ptr<const RobotDescription> description_of(py::handle robot) {
  if (!py::isinstance<RobotDescription>(robot)) {
    throw py::type_error("robot: its type is " +
                         std::string(py::str(py::type::handle_of(robot).attr("__name__"))));
  }
  return robot.cast<DescriptionPointer>();
}

py::tuple pairs_object(std::span<const DisabledPair> pairs) {
  py::list result;
  for (const DisabledPair& pair : pairs) {
    result.append(make_result("DisabledPair", pair.link_a, pair.link_b, pair.reason));
  }
  return py::tuple(result);
}

std::vector<DisabledPair> pairs_of(const py::object& pairs) {
  std::vector<DisabledPair> result;
  for (const py::handle pair : pairs) {
    result.push_back({.link_a = py::str(pair.attr("link_a")),
                      .link_b = py::str(pair.attr("link_b")),
                      .reason = py::str(pair.attr("reason"))});
  }
  return result;
}

void bind_robot_files(py::module_& module) {
  bind_description(module);
  module.def("read_urdf", &read_urdf_file, py::arg("path"), py::kw_only(),
             py::arg("packages") = py::dict(), py::arg("require_visual_meshes") = true,
             py::arg("require_collision_meshes") = true,
             Help("read_urdf(path, *, packages={}, require_visual_meshes=True, "
                  "require_collision_meshes=True)",
                  "Reads a robot from a URDF file, or from a .xacro file by the program xacro: a "
                  "RobotDescription. `packages` are the roots of "
                  "package://NAME/... by name.")
                 .c_str());
  module.def(
      "read_srdf",
      [](const py::object& path) { return semantics_object(read_srdf(path_of(path, "path"))); },
      py::arg("path"), Help("read_srdf(path)", "Reads an SRDF: a SemanticDescription.").c_str());
  module.def("read_trajectory", &trajectory, py::arg("path"), py::arg("robot"), py::kw_only(),
             py::arg("angles") = "radians",
             Help("read_trajectory(path, robot, *, angles='radians')",
                  "Reads configurations from a text file: shape (n, dof), radians and metres. "
                  "`angles` says in what the file has angles, 'radians' or 'degrees'.")
                 .c_str());
}

}  // namespace spherule::python
