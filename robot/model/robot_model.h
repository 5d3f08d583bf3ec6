// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A jointed mechanism, the sphere trees on its links, and a robot as a file describes it.
//
// @code{.cpp}
// #include <spherule/robot/model/robot_model.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// robot.add_link("hand", "arm", {.name = "slide", .type = spherule::JointType::kPrismatic,
//                                .axis = {1, 0, 0}, .lower = 0.0, .upper = 0.2});
// const std::vector<spherule::Sphere> spheres{{{1, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// robot.attach("hand", sphere);
// assert(robot.variable_count() == 2 && robot.find_link("hand") == 2);
// @endcode

#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spherule {

namespace internal {
struct CheckCache;
}

// kContinuous is a revolute joint without limits.
enum class JointType { kFixed, kRevolute, kPrismatic, kContinuous };

// Joint between a parent link and its child: child frame = origin, then the motion about or along
// `axis`. Lengths in metres, angles in radians.
//
// The position of a joint is multiplier * variable + offset, of the variable of a configuration
// that moves it: 1 and 0, unless the joint mimics another. Only RobotModel sets these.
struct Joint {
  std::string name{};
  JointType type = JointType::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Pose parent_from_joint{};                         // at position zero; made unit when added
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit length is made when added
  double lower = 0.0;                               // limits of the position;
  double upper = 0.0;                               // -inf and inf where none are known
  int variable = -1;                                // index into a configuration; -1 if fixed
  double multiplier = 1.0;
  double offset = 0.0;
  int mimics = -1;  // the joint that it was told to follow, by its index; -1 if none

  // Whether a number of the configuration moves it, and whether it turns by that.
  bool moves() const { return variable >= 0; }
  bool turns() const { return type == JointType::kRevolute || type == JointType::kContinuous; }
  // In a configuration of variable_count() numbers, product and sum rounded; 0 if it is fixed.
  double position(std::span<const double> configuration) const {
    if (!moves()) return 0.0;
    const double value = configuration[static_cast<std::size_t>(variable)];
    return mimics < 0 ? value : multiplier * value + offset;
  }
};

// A link with the sphere trees that are rigidly attached to it, in the link's frame.
struct Link {
  std::string name;
  int parent_joint = -1;  // -1 for the root
  std::vector<std::shared_ptr<const SphereTree>> trees;
};

// A jointed mechanism: serial or branching chains of revolute and prismatic joints, with a root
// link. Links are stored so that a parent comes before its children. A configuration has one number
// for each joint that moves and mimics no other, in the order of these joints.
class RobotModel {
 public:
  // A robot of one link.
  explicit RobotModel(std::string root_link = "base_link");

  // Adds a link below `parent_link` through `joint` and returns its index. What is set here: the
  // joint's link indices and variable, no mimic, and for a continuous joint the limits, -pi and pi:
  // one turn, for whoever draws positions. Throws Error for a name that is taken, an unknown
  // parent, an axis that is zero or not finite (of a joint that moves: that of a fixed one is of no
  // use and replaced), and limits that are reversed, or not finite but for -inf and inf together.
  int add_link(std::string name, std::string_view parent_link, Joint joint);

  // Adds a link as add_link() does, with a joint of a RobotModel, whose axis and origin are unit:
  // they are taken bit for bit, so that a robot that is made again of its links, joints and mimics
  // is the same. Throws Error, too, where they are not unit.
  int add_copied_link(std::string name, std::string_view parent_link, Joint joint);

  // From now on `joint` stands at multiplier * (position of `other`) + offset. `other` may mimic a
  // third, and may come later; then the factors of the chain are multiplied out, rounded, and what
  // stands in Joint is what counts. Variables are numbered anew. Throws Error for a joint that does
  // not exist or is fixed, mimics one already, would mimic itself, and for numbers that are not
  // finite.
  void mimic(std::string_view joint, std::string_view other, double multiplier = 1.0,
             double offset = 0.0);

  // Attaches a tree to a link; throws Error for an unknown link or a null tree.
  void attach(std::string_view link, std::shared_ptr<const SphereTree> tree);

  // In the order in which they were added, the root link first.
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  // What mimic() was told of each joint, before chains are multiplied out; 1 and 0 of one that
  // mimics none.
  struct Mimic {
    double multiplier = 1.0;
    double offset = 0.0;
  };
  // Of each joint, in the order of joints().
  const std::vector<Mimic>& mimics() const { return follow_; }
  // How many numbers a configuration has.
  int variable_count() const { return static_cast<int>(variable_joints_.size()); }
  // The joint whose position each number of a configuration is, by its index.
  const std::vector<int>& variable_joints() const { return variable_joints_; }
  // Whether a joint mimics another.
  bool has_mimics() const { return has_mimics_; }

  // Index of a link or a joint, or -1; joints without a name are not found.
  int find_link(std::string_view name) const;
  int find_joint(std::string_view name) const;
  // The index of a link. Throws Error where there is none, with the name that may have been meant.
  int require_link(std::string_view name) const;

  // For checkers: what they compute from the robot. Copies of a model share it.
  internal::CheckCache& check_cache() const { return *check_cache_; }

 private:
  int insert(std::string name, std::string_view parent_link, Joint joint);
  std::size_t require_moving_joint(std::string_view name) const;
  bool follows(std::size_t joint, std::size_t other) const;
  void number_variables();

  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<Mimic> follow_;  // for each joint
  std::map<std::string, int, std::less<>> link_index_;
  std::map<std::string, int, std::less<>> joint_index_;  // of those with a name
  std::vector<int> variable_joints_;
  bool has_mimics_ = false;
  std::shared_ptr<internal::CheckCache> check_cache_;
};

// A robot as a file describes it: its mechanism, and the shapes of its links.
//
// @code{.cpp}
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 1.0}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// assert(robot.links.size() == robot.model.links().size());
// @endcode

// A mesh in a file. Times `scale`, coordinate by coordinate, it is in metres: of formats that state
// a unit (DAE, 3MF, glTF) what is scaled is in metres before, of others the file's own numbers are.
// A negative factor mirrors.
struct MeshFile {
  std::filesystem::path path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

// A shape that is rigidly attached to a link.
struct LinkShape {
  std::string name;  // often empty
  Pose link_from_shape{};
  std::variant<MeshFile, Primitive> geometry;
};

// What a link looks like and what stands for it in collision checks, in metres.
struct LinkDescription {
  std::string name;
  std::vector<LinkShape> visual{};
  std::vector<LinkShape> collision{};
};

// A robot as a file describes it. No mesh is read and no tree is built yet: `model` has no trees.
struct RobotDescription {
  std::string name;
  RobotModel model;
  std::vector<LinkDescription> links{};  // in the order of model.links()
  // Where the file has joints in another order than the model: the names of those whose positions
  // the numbers of a configuration are, in the order of the file.
  std::vector<std::string> other_joint_order{};
  std::vector<std::string> warnings{};  // what is odd in the file, with its line
};

// A robot with spheres on its links.
//
// @code{.cpp}
// const std::vector<spherule::LinkSpheres> spheres{
//     {.link = "base", .spheres = {{{0, 0, 0}, 0.1}}}};
// const auto robot = spherule::with_spheres(spherule::RobotModel("base"), spheres);
// assert(robot.links()[0].trees[0]->spheres()[0].radius == 0.1);
// @endcode

// The spheres of one link, in the frame of the link, in metres.
struct LinkSpheres {
  std::string link;
  std::vector<Sphere> spheres;
};

// The robot with a sphere tree on every link that has spheres: what RobotScene takes. Throws Error
// for spheres of a link that the robot does not have, or that build_tree() refuses.
RobotModel with_spheres(RobotModel robot, std::span<const LinkSpheres> spheres);

}  // namespace spherule
