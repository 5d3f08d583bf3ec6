// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/urdf.h"

#include "robot/files/internal/mesh_path.h"
#include "robot/files/internal/urdf_text.h"
#include "robot/files/internal/xml_file.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cmath>
#include <console_bridge/console.h>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>
#include <utility>

namespace spherule {
namespace {

// Gathers the errors of urdfdom, which would go to the console of the program; other threads'
// messages pass. There is one for all threads.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() : before_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::setLogLevel(std::min(level_, console_bridge::CONSOLE_BRIDGE_LOG_ERROR));
    console_bridge::useOutputHandler(this);
  }
  ~Messages() override {
    console_bridge::useOutputHandler(before_);
    console_bridge::setLogLevel(level_);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* file,
           int line) override {
    if (std::this_thread::get_id() != thread_) {
      if (before_ != nullptr && level >= level_) before_->log(text, level, file, line);
    } else if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      if (!errors_.empty()) errors_ += "; ";
      errors_ += text;
    }
  }

  const std::string& errors() const { return errors_; }

 private:
  std::thread::id thread_ = std::this_thread::get_id();
  console_bridge::OutputHandler* before_;
  console_bridge::LogLevel level_;
  std::string errors_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& file) {
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  const Messages messages;
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (!messages.errors().empty()) throw Error(file, messages.errors());
  if (!model) throw Error(file, "urdfdom cannot read it and does not say why");
  return model;
}

Pose pose_of(const urdf::Pose& pose) {
  const auto& [x, y, z, w] = pose.rotation;
  return Pose(Eigen::Quaterniond(w, x, y, z), {pose.position.x, pose.position.y, pose.position.z});
}

Joint joint_of(const urdf::Joint& joint) {
  Joint result{.name = joint.name,
               .parent_from_joint = pose_of(joint.parent_to_joint_origin_transform),
               .axis = {joint.axis.x, joint.axis.y, joint.axis.z}};
  switch (joint.type) {
    case urdf::Joint::FIXED:
      break;
    case urdf::Joint::REVOLUTE:
      result.type = JointType::kRevolute;
      break;
    case urdf::Joint::PRISMATIC:
      result.type = JointType::kPrismatic;
      break;
    case urdf::Joint::CONTINUOUS:
      result.type = JointType::kContinuous;
      break;
    default:
      throw Error("type", "planar and floating joints cannot be modelled");
  }
  if (result.type == JointType::kRevolute || result.type == JointType::kPrismatic) {
    result.lower = joint.limits->lower;
    result.upper = joint.limits->upper;
  }
  return result;
}

class Reader {
 public:
  Reader(const urdf::ModelInterface& model, const std::vector<std::string>& joints,
         const std::filesystem::path& path, const UrdfOptions& options)
      : model_(model),
        paths_(path, options),
        require_visual_meshes_(options.require_visual_meshes) {
    for (std::size_t i = 0; i < joints.size(); ++i) order_[joints[i]] = i;
  }

  RobotDescription read(std::size_t& shapes) {
    RobotDescription robot{.name = model_.getName(), .model = RobotModel(root().name)};
    add_links(robot.model);
    for (const auto& [joint, mimic] : mimics_) {
      robot.model.mimic(joint, mimic->joint_name, mimic->multiplier, mimic->offset);
    }
    for (const Link& link : robot.model.links()) {
      robot.links.push_back(link_of(*model_.links_.at(link.name)));
      shapes += robot.links.back().visual.size() + robot.links.back().collision.size();
    }
    return robot;
  }

 private:
  const urdf::Link& root() const { return *model_.getRoot(); }

  // Depth first; urdfdom has the joints below a link in the order of their names.
  void add_links(RobotModel& robot) {
    std::vector<urdf::JointSharedPtr> waiting;
    const auto wait = [&](const urdf::Link& link) {
      const auto first = static_cast<std::ptrdiff_t>(waiting.size());
      waiting.insert(waiting.end(), link.child_joints.begin(), link.child_joints.end());
      std::sort(waiting.begin() + first, waiting.end(), [&](const auto& a, const auto& b) {
        return order_.at(a->name) > order_.at(b->name);
      });
    };
    wait(root());
    while (!waiting.empty()) {
      const urdf::JointSharedPtr joint = std::move(waiting.back());
      waiting.pop_back();
      add_link(robot, *joint);
      if (joint->mimic && joint->type != urdf::Joint::FIXED) {
        mimics_.emplace_back(joint->name, joint->mimic);
      }
      wait(*model_.links_.at(joint->child_link_name));
    }
  }

  static void add_link(RobotModel& robot, const urdf::Joint& joint) {
    try {
      robot.add_link(joint.child_link_name, joint.parent_link_name, joint_of(joint));
    } catch (const Error& error) {
      throw Error("joint " + internal::name_in_quotes(joint.name), error.what());
    }
  }

  LinkDescription link_of(const urdf::Link& link) {
    LinkDescription result{.name = link.name};
    try {
      for (const auto& visual : link.visual_array) {
        result.visual.push_back(shape_of(*visual, require_visual_meshes_));
      }
      for (const auto& collision : link.collision_array) {
        result.collision.push_back(shape_of(*collision, true));
      }
    } catch (const Error& error) {
      throw Error("link " + internal::name_in_quotes(link.name), error.what());
    }
    return result;
  }

  template <class Shape>
  LinkShape shape_of(const Shape& shape, bool require_mesh) {
    return {shape.name, pose_of(shape.origin), geometry_of(*shape.geometry, require_mesh)};
  }

  std::variant<MeshFile, Primitive> geometry_of(const urdf::Geometry& geometry, bool require_mesh) {
    Primitive primitive;
    switch (geometry.type) {
      case urdf::Geometry::MESH:
        return mesh_of(static_cast<const urdf::Mesh&>(geometry), require_mesh);
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
        primitive = Box{{size.x, size.y, size.z}};
        break;
      }
      case urdf::Geometry::SPHERE:
        primitive = Ball{static_cast<const urdf::Sphere&>(geometry).radius};
        break;
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        primitive = Cylinder{cylinder.radius, cylinder.length};
        break;
      }
      default:
        throw Error("shape", "its type is not known");
    }
    require_primitive(primitive, "shape");
    return primitive;
  }

  MeshFile mesh_of(const urdf::Mesh& mesh, bool required) {
    const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
    if ((scale.array() == 0.0).any()) throw Error(mesh.filename, "its scale is zero");
    try {
      return {paths_.find(mesh.filename), scale};
    } catch (const Error&) {
      if (required) throw;
      return {mesh.filename, scale};
    }
  }

  const urdf::ModelInterface& model_;
  internal::MeshPaths paths_;
  bool require_visual_meshes_;
  std::map<std::string, std::size_t> order_{};
  std::vector<std::pair<std::string, urdf::JointMimicSharedPtr>> mimics_{};
};

}  // namespace

RobotDescription read_urdf(const std::filesystem::path& path, const UrdfOptions& options) {
  const std::string name = path.string();
  const internal::XmlFile file(path, "robot");
  const internal::UrdfText plain = internal::plain_urdf(file.root());
  const urdf::ModelInterfaceSharedPtr model = parse(plain.text, name);
  std::size_t shapes = 0;
  try {
    RobotDescription robot = Reader(*model, plain.joints, path, options).read(shapes);
    if (shapes != plain.shapes) throw Error("urdfdom", "it has lost shapes");
    return robot;
  } catch (const Error& error) {
    throw Error(name, error.what());
  }
}

}  // namespace spherule
