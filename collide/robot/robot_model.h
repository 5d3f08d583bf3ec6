// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/pose.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

enum class JointType { kFixed, kRevolute, kPrismatic };

// Joint between a parent link and its child: child frame = origin, then the motion about or along
// `axis`. Lengths in metres, angles in radians.
struct Joint {
  std::string name{};
  JointType type = JointType::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Pose parent_from_joint{};                         // at position zero; made unit when added
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit length is made when added
  double lower = 0.0;                               // limits of the position
  double upper = 0.0;
  int variable = -1;  // index into a configuration; -1 if fixed
};

// A link with the sphere trees that are rigidly attached to it, in the link's frame.
struct Link {
  std::string name;
  int parent_joint = -1;  // -1 for the root
  std::vector<std::shared_ptr<const SphereTree>> trees;
};

// A jointed mechanism: serial or branching chains of revolute and prismatic joints, with a root
// link. Links are stored so that a parent comes before its children.
class RobotModel {
 public:
  explicit RobotModel(std::string root_link = "base_link");

  // Adds a link below `parent_link` through `joint` (whose link indices and variable are set here)
  // and returns its index. Throws Error for a name that is taken, an unknown parent, an axis that
  // is zero or not finite, and limits that are not finite or reversed.
  int add_link(std::string name, std::string_view parent_link, Joint joint);

  // Attaches a tree to a link; throws Error for an unknown link or a null tree.
  void attach(std::string_view link, std::shared_ptr<const SphereTree> tree);

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  int variable_count() const { return variable_count_; }

  // Index of a link, or -1.
  int find_link(std::string_view name) const;

 private:
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  int variable_count_ = 0;
};

}  // namespace spherule
