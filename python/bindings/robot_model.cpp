// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/robot_model.h"

#include "base/error.h"
#include "python/bindings/robots.h"
#include "python/bindings/support.h"
#include "robot/files/robot_description.h"
#include "robot/files/trajectory_file.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/kinematics.h"

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
  py::list enabled;
  for (const auto& [first, second] : semantics.enabled_pairs) {
    enabled.append(py::make_tuple(first, second));
  }
  return make_result("SemanticDescription", semantics.robot_name, py::tuple(groups),
                     py::tuple(states), py::tuple(effectors),
                     pairs_object(semantics.disabled_pairs),
                     spheres_object(semantics.sphere_approximations),
                     py::tuple(py::cast(semantics.links_disabled_by_default)), py::tuple(enabled),
                     py::tuple(py::cast(semantics.warnings)));
}

py::array trajectory(const py::object& path, const py::object& robot, const py::object& angles,
                     const py::object& otherwise) {
  const auto unit = static_cast<AngleUnit>(choice(angles, {"radians", "degrees"}, "angles"));
  const auto others =
      otherwise.is_none() ? std::vector<double>() : otherwise.cast<std::vector<double>>();
  Trajectory read = read_trajectory(path_of(path, "path"), model_of(robot), unit, others);
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
      .def_property_readonly(
          "warnings",
          [](const RobotDescription& robot) { return py::tuple(py::cast(robot.warnings)); },
          "What is odd in the file, with its line.")
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
             py::arg("angles") = "radians", py::arg("otherwise") = py::none(),
             Help("read_trajectory(path, robot, *, angles='radians', otherwise=None)",
                  "Reads configurations from a text file: shape (n, dof), radians and metres. "
                  "`angles` says in what the file has angles, 'radians' or 'degrees'. Joints that "
                  "it does not name stand as in the configuration `otherwise`; without it all have "
                  "to be named.")
                 .c_str());
}

namespace {

// What has no such attribute has the default.
template <class Value>
Value attribute(const py::object& object, const char* name, Value otherwise) {
  return py::hasattr(object, name) ? object.attr(name).cast<Value>() : otherwise;
}

py::object read_spheres(const py::object& path, const std::string& link,
                        const std::optional<std::size_t>& level) {
  const SphereFormatFile file =
      read_robot_spheres(path_of(path, "path"), {.link = link, .level = level});
  return robot_spheres_object(file.spheres, name_of(file.format));
}

RobotSpheres robot_spheres_of(const py::object& spheres) {
  using Buffers = std::map<std::string, double>;
  RobotSpheres result;
  result.links = link_spheres_of(spheres);
  result.robot = attribute<std::string>(spheres, "robot", "");
  if (py::hasattr(spheres, "self_collision_ignore")) {
    result.self_collision_ignore = pairs_of(spheres.attr("self_collision_ignore"));
  }
  result.self_collision_buffer = attribute<Buffers>(spheres, "self_collision_buffer", {});
  result.collision_buffer = attribute(spheres, "collision_buffer", 0.0);
  result.collision_buffers = attribute<Buffers>(spheres, "collision_buffers", {});
  result.interrupted = attribute(spheres, "interrupted", false);
  return result;
}

void write_spheres(const py::object& spheres, const std::string& format, const py::object& path,
                   const py::object& urdf, const py::object& original, const std::string& base_link,
                   const std::string& tool_link, const std::vector<std::string>& joint_names,
                   const std::vector<double>& joint_positions) {
  const auto kind = sphere_format_named(format);
  if (!kind)
    throw Error("format", "\"" + format + "\" is none of urdf, srdf, curobo, xrdf, foam, json");
  SphereFileContext context;
  if (!urdf.is_none()) context.urdf = path_of(urdf, "urdf");
  if (!original.is_none()) context.original = path_of(original, "original");
  context.base_link = base_link;
  context.tool_link = tool_link;
  context.joint_names = joint_names;
  context.joint_positions = joint_positions;
  write_robot_spheres(robot_spheres_of(spheres), *kind, context, path_of(path, "path"));
}

}  // namespace

std::vector<LinkSpheres> link_spheres_of(const py::object& given) {
  const py::object all = py::hasattr(given, "links") ? py::object(given.attr("links")) : given;
  if (!py::isinstance<py::dict>(all)) {
    throw py::type_error("spheres: it is neither a dict of arrays by link nor RobotSpheres");
  }
  std::vector<LinkSpheres> result;
  for (const auto& [name, array] : py::dict(all)) {
    const std::string link = py::str(name);
    const std::string argument = "spheres of " + link;
    result.push_back({.link = link, .spheres = spheres(array, argument.c_str()).copy()});
  }
  return result;
}

py::dict spheres_object(std::span<const LinkSpheres> all) {
  py::dict result;
  for (const LinkSpheres& link : all) {
    result[py::str(link.link)] = array_of(std::vector<Sphere>(link.spheres));
  }
  return result;
}

py::object robot_spheres_object(const RobotSpheres& spheres, std::string_view format) {
  return make_result("RobotSpheres", spheres_object(spheres.links), spheres.robot,
                     pairs_object(spheres.self_collision_ignore),
                     py::cast(spheres.self_collision_buffer), spheres.collision_buffer,
                     py::cast(spheres.collision_buffers), spheres.switched_off,
                     spheres.other_shapes, std::string(format), spheres.interrupted);
}

void bind_robot_formats(py::module_& module) {
  module.def(
      "read_robot_spheres", &read_spheres, py::arg("path"), py::kw_only(), py::arg("link") = "",
      py::arg("level") = py::none(),
      Help("read_robot_spheres(path, *, link='', level=None)",
           "Reads the spheres of a robot from spherized URDF, SRDF, cuRobo yml, XRDF, foam, "
           "MorphIt, ballpark, Bradshaw's .sph and our own files, told apart by what they "
           "hold: a RobotSpheres. `link` is that of formats of one mesh, `level` one of formats "
           "with levels, 0 the coarsest.")
          .c_str());
  module.def(
      "write_robot_spheres", &write_spheres, py::arg("spheres"), py::arg("format"), py::arg("path"),
      py::kw_only(), py::arg("urdf") = py::none(), py::arg("original") = py::none(),
      py::arg("base_link") = "", py::arg("tool_link") = "", py::arg("joint_names") = py::tuple(),
      py::arg("joint_positions") = py::tuple(),
      Help("write_robot_spheres(spheres, format, path, *, urdf=None, original=None, "
           "base_link='', tool_link='', joint_names=(), joint_positions=())",
           "Writes a file of format 'urdf', 'srdf', 'curobo', 'xrdf', 'foam' or 'json'. "
           "`spheres` is RobotSpheres, or a dict of arrays by link. `urdf` is the robot's own, "
           "`original` a file of the format that is kept but for the spheres.")
          .c_str());
}

}  // namespace spherule::python
