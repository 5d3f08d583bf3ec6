// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/robot_model.h"

#include "spheretree/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule {
namespace {

Eigen::Vector3d unit_axis(const Eigen::Vector3d& axis, const std::string& name) {
  const double scale = axis.cwiseAbs().maxCoeff();
  if (!axis.allFinite() || !(scale > 0.0)) {
    throw Error("joint " + name, "the axis is zero or not finite");
  }
  return (axis / scale).normalized();
}

}  // namespace

RobotModel::RobotModel(std::string root_link) {
  links_.push_back({std::move(root_link), -1, {}});
}

int RobotModel::add_link(std::string name, std::string_view parent_link, Joint joint) {
  if (find_link(name) >= 0) throw Error("link " + name, "the name is taken");
  if (!joint.name.empty() && std::any_of(joints_.begin(), joints_.end(), [&](const Joint& other) {
        return other.name == joint.name;
      })) {
    throw Error("joint " + joint.name, "the name is taken");
  }
  const int parent = find_link(parent_link);
  if (parent < 0) {
    throw Error("link " + name, "there is no parent link " + std::string(parent_link));
  }
  if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper) || joint.lower > joint.upper) {
    throw Error("joint " + joint.name, "the limits are not finite or reversed");
  }
  joint.axis = unit_axis(joint.axis, joint.name);
  joint.parent_from_joint = Pose(unit_rotation(joint.parent_from_joint.rotation()),
                                 joint.parent_from_joint.translation());
  joint.parent_link = parent;
  joint.child_link = static_cast<int>(links_.size());
  joint.variable = joint.type == JointType::kFixed ? -1 : variable_count_++;
  links_.push_back({std::move(name), static_cast<int>(joints_.size()), {}});
  joints_.push_back(std::move(joint));
  return static_cast<int>(links_.size()) - 1;
}

void RobotModel::attach(std::string_view link, std::shared_ptr<const SphereTree> tree) {
  const int index = find_link(link);
  if (index < 0) throw Error("link " + std::string(link), "there is no such link");
  if (!tree) throw Error("link " + std::string(link), "the tree to attach is null");
  links_[static_cast<std::size_t>(index)].trees.push_back(std::move(tree));
}

int RobotModel::find_link(std::string_view name) const {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace spherule
