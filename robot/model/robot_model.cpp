// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/robot_model.h"

#include "base/error.h"
#include "base/text.h"
#include "collide/kernels/plan_trees.h"
#include "spheretree/sphere_tree.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
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

RobotModel::RobotModel(std::string root_link)
    : check_cache_(std::make_shared<internal::CheckCache>()) {
  link_index_[root_link] = 0;
  links_.push_back({std::move(root_link), -1, {}});
}

int RobotModel::add_link(std::string name, std::string_view parent_link, Joint joint) {
  joint.axis = joint.type == JointType::kFixed ? Eigen::Vector3d::UnitZ()
                                               : unit_axis(joint.axis, joint.name);
  joint.parent_from_joint = Pose(unit_rotation(joint.parent_from_joint.rotation()),
                                 joint.parent_from_joint.translation());
  return insert(std::move(name), parent_link, std::move(joint));
}

int RobotModel::add_copied_link(std::string name, std::string_view parent_link, Joint joint) {
  const Eigen::Quaterniond rotation = joint.parent_from_joint.rotation();
  if (!(std::abs(joint.axis.squaredNorm() - 1.0) <= 0x1p-49) ||
      unit_rotation(rotation).coeffs() != rotation.coeffs()) {
    throw Error("joint " + joint.name, "its axis or origin is not unit");
  }
  return insert(std::move(name), parent_link, std::move(joint));
}

// With an axis and an origin that are unit.
int RobotModel::insert(std::string name, std::string_view parent_link, Joint joint) {
  if (find_link(name) >= 0) throw Error("link " + name, "the name is taken");
  if (find_joint(joint.name) >= 0) throw Error("joint " + joint.name, "the name is taken");
  const int parent = find_link(parent_link);
  if (parent < 0) {
    throw Error("link " + name, "there is no parent link " + std::string(parent_link));
  }
  if (joint.type == JointType::kContinuous) {
    joint.lower = -std::numbers::pi;
    joint.upper = std::numbers::pi;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool are_unknown = joint.lower == -kInfinity && joint.upper == kInfinity;
  const bool are_finite = std::isfinite(joint.lower) && std::isfinite(joint.upper);
  if (!are_unknown && (!are_finite || joint.lower > joint.upper)) {
    std::ostringstream limits;
    limits << joint.lower << " and " << joint.upper;
    throw Error("joint " + joint.name, "the limits are not finite or reversed: " + limits.str());
  }
  joint.parent_link = parent;
  joint.child_link = static_cast<int>(links_.size());
  joint.mimics = -1;
  joint.multiplier = 1.0;
  joint.offset = 0.0;
  const int index = static_cast<int>(joints_.size());
  joint.variable = joint.type == JointType::kFixed ? -1 : variable_count();
  if (joint.moves()) variable_joints_.push_back(index);
  if (!joint.name.empty()) joint_index_[joint.name] = index;
  link_index_[name] = joint.child_link;
  links_.push_back({std::move(name), index, {}});
  joints_.push_back(std::move(joint));
  follow_.emplace_back();
  return static_cast<int>(links_.size()) - 1;
}

std::size_t RobotModel::require_moving_joint(std::string_view name) const {
  const int index = find_joint(name);
  const std::string subject = "joint " + std::string(name);
  if (index < 0) throw Error(subject, "there is no such joint");
  if (joints_[static_cast<std::size_t>(index)].type == JointType::kFixed) {
    throw Error(subject, "it is fixed, so that it neither mimics nor is mimicked");
  }
  return static_cast<std::size_t>(index);
}

// Whether the joint is the other, or mimics it directly or through others.
bool RobotModel::follows(std::size_t joint, std::size_t other) const {
  while (joint != other && joints_[joint].mimics >= 0) {
    joint = static_cast<std::size_t>(joints_[joint].mimics);
  }
  return joint == other;
}

void RobotModel::mimic(std::string_view joint, std::string_view other, double multiplier,
                       double offset) {
  const std::size_t follower = require_moving_joint(joint);
  const std::size_t leader = require_moving_joint(other);
  const std::string subject = "joint " + std::string(joint);
  if (joints_[follower].mimics >= 0) throw Error(subject, "it mimics a joint already");
  if (follows(leader, follower)) throw Error(subject, "it would mimic itself");
  if (!std::isfinite(multiplier) || !std::isfinite(offset)) {
    throw Error(subject, "the multiplier or offset of its mimic is not finite");
  }
  joints_[follower].mimics = static_cast<int>(leader);
  follow_[follower] = {multiplier, offset};
  try {
    number_variables();
  } catch (const Error&) {
    joints_[follower].mimics = -1;
    number_variables();
    throw;
  }
}

void RobotModel::number_variables() {
  variable_joints_.clear();
  has_mimics_ = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    joint.variable = -1;
    joint.multiplier = 1.0;
    joint.offset = 0.0;
    if (joint.type == JointType::kFixed || joint.mimics >= 0) continue;
    joint.variable = variable_count();
    variable_joints_.push_back(static_cast<int>(i));
  }
  // Along each chain from the joint that is not resolved yet and is nearest to the leader.
  std::vector<bool> is_resolved(joints_.size());
  std::vector<std::size_t> chain;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    for (std::size_t at = i; joints_[at].mimics >= 0 && !is_resolved[at];) {
      has_mimics_ = true;
      chain.push_back(at);
      at = static_cast<std::size_t>(joints_[at].mimics);
    }
    for (; !chain.empty(); chain.pop_back()) {
      Joint& joint = joints_[chain.back()];
      const Joint& leader = joints_[static_cast<std::size_t>(joint.mimics)];
      const Mimic& factors = follow_[chain.back()];
      joint.multiplier = factors.multiplier * leader.multiplier;
      joint.offset = factors.multiplier * leader.offset + factors.offset;
      joint.variable = leader.variable;
      is_resolved[chain.back()] = true;
      if (!std::isfinite(joint.multiplier) || !std::isfinite(joint.offset)) {
        throw Error("joint " + joint.name, "the multipliers of what it mimics are too large");
      }
    }
  }
}

void RobotModel::attach(std::string_view link, std::shared_ptr<const SphereTree> tree) {
  const int index = require_link(link);
  if (!tree) throw Error("link " + std::string(link), "the tree to attach is null");
  links_[static_cast<std::size_t>(index)].trees.push_back(std::move(tree));
}

int RobotModel::find_link(std::string_view name) const {
  const auto found = link_index_.find(name);
  return found == link_index_.end() ? -1 : found->second;
}

int RobotModel::require_link(std::string_view name) const {
  const int index = find_link(name);
  if (index >= 0) return index;
  throw Error("link " + std::string(name),
              "the robot has no such link" + internal::did_you_mean(name, links_, &Link::name));
}

int RobotModel::find_joint(std::string_view name) const {
  const auto found = joint_index_.find(name);
  return found == joint_index_.end() ? -1 : found->second;
}

RobotModel with_spheres(RobotModel robot, std::span<const LinkSpheres> spheres) {
  for (const LinkSpheres& link : spheres) {
    robot.require_link(link.link);
    if (!link.spheres.empty()) {
      robot.attach(link.link, std::make_shared<const SphereTree>(build_tree(link.spheres)));
    }
  }
  return robot;
}

}  // namespace spherule
