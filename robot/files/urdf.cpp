// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "robot/files/robot_description.h"
#include "robot/files/urdf_files.h"
#include "robot/files/xml_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;
using internal::XmlElement;

// Why a file of another name is refused that holds what only that program understands.
constexpr const char* kIsForXacro =
    "this is for xacro, which makes a URDF of it: rename the file, so that it ends in .xacro";

// The <link> and <joint> elements of a URDF file depth first: the root link, then for each joint
// below a link, in the order of the file, what hangs on it. Link i + 1 is the child of joint i.
struct UrdfTree {
  std::vector<XmlElement> links;
  std::vector<XmlElement> joints;
};

// The name of the link at an end of a joint, "parent" or "child".
std::string link_at(const XmlElement& joint, std::string_view end) {
  return joint.needed_child(end).needed("link");
}

// Throws Error for names that are missing or not unique, a joint between links that are not there,
// and links and joints that are no tree.
class TreeGatherer {
 public:
  explicit TreeGatherer(const XmlElement& robot) : robot_(robot) {
    for (const XmlElement& link : robot.children("link")) {
      const std::string name = link.needed("name");
      if (!links_.emplace(name, link).second) link.refuse("link '" + name + "' is not unique");
    }
    std::set<std::string> names;
    for (const XmlElement& joint : robot.children("joint")) {
      const std::string name = joint.needed("name");
      if (!names.insert(name).second) joint.refuse("joint '" + name + "' is not unique");
      add(joint);
    }
  }

  UrdfTree tree() const {
    UrdfTree result{.links = {root()}, .joints = {}};
    std::vector<XmlElement> waiting;
    for (;;) {
      const auto below = below_.find(result.links.back().needed("name"));
      if (below != below_.end()) {
        waiting.insert(waiting.end(), below->second.rbegin(), below->second.rend());
      }
      if (waiting.empty()) break;
      result.joints.push_back(waiting.back());
      waiting.pop_back();
      result.links.push_back(links_.at(link_at(result.joints.back(), "child")));
    }
    if (result.links.size() < links_.size()) refuse_ring(result.links);
    return result;
  }

 private:
  void add(const XmlElement& joint) {
    for (const std::string_view end : {"parent", "child"}) {
      const std::string link = link_at(joint, end);
      if (!links_.contains(link)) joint.needed_child(end).refuse("link '" + link + "' not found");
    }
    const std::string child = link_at(joint, "child");
    const auto [other, is_first] = above_.emplace(child, joint);
    if (!is_first) {
      joint.refuse("link '" + child + "' is below two joints, this one and '" +
                   other->second.needed("name") + "'");
    }
    below_[link_at(joint, "parent")].push_back(joint);
  }

  XmlElement root() const {
    std::vector<XmlElement> roots;
    for (const XmlElement& link : robot_.children("link")) {
      const std::string name = link.needed("name");
      if (above_.contains(name)) continue;
      if (!roots.empty()) {
        link.refuse("it is a root, below no joint, as is link '" + roots[0].needed("name") + "'");
      }
      roots.push_back(link);
    }
    if (links_.empty()) robot_.refuse("it has no <link>");
    if (roots.empty()) refuse_ring({});
    return roots[0];
  }

  // `reached` are the links at and below the root. Upwards from any other there is no end.
  [[noreturn]] void refuse_ring(const std::vector<XmlElement>& reached) const {
    std::map<std::string, XmlElement> others = links_;
    for (const XmlElement& link : reached) others.erase(link.needed("name"));
    std::string at = others.begin()->first;
    std::set<std::string> way;
    while (way.insert(at).second) at = link_at(above_.at(at), "parent");
    above_.at(at).refuse("link '" + at + "' is above itself");
  }

  XmlElement robot_;
  std::map<std::string, XmlElement> links_{};
  std::map<std::string, XmlElement> above_{};               // the joint above a link
  std::map<std::string, std::vector<XmlElement>> below_{};  // those below it
};

// What `make` returns; its errors get the place of the element.
template <class Make>
auto at(const XmlElement& element, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    element.refuse(error.what());
  }
}

// What is in such an element is unknown.
void refuse_xacro(const XmlElement& element) {
  if (element.tag().starts_with("xacro:")) {
    element.refuse(kIsForXacro);
  }
  for (const XmlElement& child : element.children()) refuse_xacro(child);
}

// Of URDF, 1.MINOR.
constexpr int kNewestMinor = 2;

int minor_version_of(const XmlElement& robot) {
  const std::string version = robot.attribute("version").value_or("1.0");
  for (int minor = 0; minor <= kNewestMinor; ++minor) {
    if (version == "1." + std::to_string(minor)) return minor;
  }
  robot.refuse("its version is " + internal::in_quotes(version) + ": versions 1.0 to 1." +
               std::to_string(kNewestMinor) + " of URDF can be read");
}

Pose pose_of_quaternion(const XmlElement& origin) {
  const auto xyzw = origin.numbers("quat_xyzw", 4);
  const Eigen::Quaterniond q((*xyzw)[3], (*xyzw)[0], (*xyzw)[1], (*xyzw)[2]);
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) origin.refuse("quat_xyzw is zero, which is no rotation");
  const Eigen::Vector4d scaled = q.coeffs() / largest;
  const Eigen::Vector3d xyz = origin.vector("xyz", Eigen::Vector3d::Zero());
  return at(origin, [&] { return Pose(Eigen::Quaterniond(scaled / scaled.norm()), xyz); });
}

// Roll, pitch and yaw turn about the fixed axes x, y and z in this order. The products and the norm
// are summed in the order of urdfdom, so that the pose is the same to the last bit.
Pose pose_of(const XmlElement& around, int minor_version) {
  const auto origin = around.child("origin");
  if (!origin) return {};
  if (origin->attribute("quat_xyzw")) {
    if (minor_version < 1) {
      origin->refuse(
          "quat_xyzw is of URDF 1.1, and this file is of 1.0, where other tools pass "
          "over it: write version=\"1.1\" in <robot>, or rpy");
    }
    if (origin->attribute("rpy")) origin->refuse("it has both rpy and quat_xyzw");
    origin->require_attributes({"xyz", "quat_xyzw"});
    return pose_of_quaternion(*origin);
  }
  origin->require_attributes({"xyz", "rpy"});
  const Eigen::Vector3d half = 0.5 * origin->vector("rpy", Eigen::Vector3d::Zero());
  const auto turn = [](double half_angle, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d v = std::sin(half_angle) * axis;
    return Eigen::Quaterniond(std::cos(half_angle), v.x(), v.y(), v.z());
  };
  const Eigen::Quaterniond q =
      turn(half.z(), Eigen::Vector3d::UnitZ()) *
      (turn(half.y(), Eigen::Vector3d::UnitY()) * turn(half.x(), Eigen::Vector3d::UnitX()));
  const double norm = std::sqrt(q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w());
  const Eigen::Vector3d xyz = origin->vector("xyz", Eigen::Vector3d::Zero());
  return at(*origin, [&] { return Pose(Eigen::Quaterniond(q.coeffs() / norm), xyz); });
}

// What becomes of the joint in the model: several joints of planar and floating ones.
enum class JointKind { kOne, kPlanar, kFloating };

JointKind kind_of(const XmlElement& joint) {
  const std::string type = joint.needed("type");
  return type == "planar"     ? JointKind::kPlanar
         : type == "floating" ? JointKind::kFloating
                              : JointKind::kOne;
}

// Of one joint.
JointType type_of(const XmlElement& joint) {
  const std::string type = joint.needed("type");
  if (type == "fixed") return JointType::kFixed;
  if (type == "revolute") return JointType::kRevolute;
  if (type == "prismatic") return JointType::kPrismatic;
  if (type == "continuous") return JointType::kContinuous;
  joint.refuse("it has no known type but " + internal::in_quotes(type));
}

// Of Gazebo's models some have an axis with rpy="0 0 0", which turns it nowhere.
Eigen::Vector3d axis_of(const XmlElement& joint) {
  const auto axis = joint.child("axis");
  if (!axis) return Eigen::Vector3d::UnitX();
  if (axis->vector("rpy", Eigen::Vector3d::Zero()) == Eigen::Vector3d::Zero()) {
    axis->require_attributes({"xyz", "rpy"});
  } else {
    axis->require_attributes({"xyz"});
  }
  return axis->needed_vector("xyz");
}

// Lengths of planar and floating joints, metres: beyond, nothing is proved of motions.
constexpr double kFarthest = 100.0;

// Why limits cannot be used; empty if they can, and then the joint has them.
std::string take_limits(const XmlElement& element, Joint& joint) {
  const auto limit = element.child("limit");
  if (!limit) return "it has no <limit>";
  for (const char* const name : {"lower", "upper"}) {
    const std::string text = limit->attribute(name).value_or("0");
    const std::vector<std::string_view> words = internal::words_of(text);
    const auto number = words.size() == 1 ? internal::finite_number(words[0]) : std::nullopt;
    if (!number) {
      return "the " + std::string(name) + " limit " + internal::in_quotes(text) +
             " is no finite number";
    }
    (name[0] == 'l' ? joint.lower : joint.upper) = *number;
  }
  if (joint.lower <= joint.upper) return {};
  return "its limits are reversed: " + internal::number_text(joint.lower) + " and " +
         internal::number_text(joint.upper);
}

// What a URDF joint is in the model, from the parent link to the child link: one joint, or several
// with links between them that are called as the joint above them.
std::vector<Joint> joints_of(const XmlElement& element, int minor_version,
                             std::vector<std::string>& warnings) {
  const std::string name = element.needed("name");
  const Pose origin = pose_of(element, minor_version);
  const auto part = [&](const char* end, JointType type, const Eigen::Vector3d& axis) {
    Joint joint{.name = name + "/" + end, .type = type, .axis = axis};
    if (type == JointType::kPrismatic) joint.lower = -kFarthest;
    if (type == JointType::kPrismatic) joint.upper = kFarthest;
    return joint;
  };
  constexpr JointType kSlides = JointType::kPrismatic;
  constexpr JointType kTurns = JointType::kContinuous;
  std::vector<Joint> joints;
  if (kind_of(element) == JointKind::kPlanar) {
    const Eigen::Vector3d axis =
        element.child("axis") ? axis_of(element) : Eigen::Vector3d::UnitZ();
    const double length = axis.norm();
    if (!(length > 0.0)) element.refuse("the axis is zero");
    const Eigen::Matrix3d plane =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
    joints = {part("x", kSlides, plane.col(0)), part("y", kSlides, plane.col(1)),
              part("theta", kTurns, axis)};
  } else if (kind_of(element) == JointKind::kFloating) {
    joints = {part("x", kSlides, Eigen::Vector3d::UnitX()),
              part("y", kSlides, Eigen::Vector3d::UnitY()),
              part("z", kSlides, Eigen::Vector3d::UnitZ()),
              part("yaw", kTurns, Eigen::Vector3d::UnitZ()),
              part("pitch", kTurns, Eigen::Vector3d::UnitY()),
              part("roll", kTurns, Eigen::Vector3d::UnitX())};
  } else {
    Joint joint{.name = name, .type = type_of(element)};
    if (joint.type != JointType::kFixed) joint.axis = axis_of(element);
    if (joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic) {
      const std::string fault = take_limits(element, joint);
      if (!fault.empty()) {
        joint.lower = -std::numeric_limits<double>::infinity();
        joint.upper = std::numeric_limits<double>::infinity();
        warnings.push_back(element.place() + fault + ": it is read as a joint without limits");
      }
    }
    joints = {joint};
  }
  joints.front().parent_from_joint = origin;
  return joints;
}

// Spheres of radius zero stand for points of contact, boxes of size zero for links that have no
// shape. What has no extent is widened, so that it is held by the shape that is read.
constexpr double kLeastSize = 1e-6;

double with_extent(double size) {
  return size == 0.0 ? kLeastSize : size;
}

bool is_point(const XmlElement& solid) {
  if (solid.tag() == "box") return solid.needed_vector("size") == Eigen::Vector3d::Zero();
  return solid.tag() == "sphere" && solid.needed_number("radius") == 0.0;
}

// The only shape of a visual or collision element. Drake marks meshes beside it
// (<drake:declare_convex/>), and materials stand there by mistake.
XmlElement solid_of(const XmlElement& element) {
  const XmlElement geometry = element.needed_child("geometry");
  std::vector<XmlElement> solids = geometry.children();
  std::erase_if(solids, [](const XmlElement& child) {
    return child.tag().find(':') != std::string_view::npos || child.tag() == "material";
  });
  if (solids.size() != 1) geometry.refuse("it has not one shape");
  return solids.front();
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// As the package.xml of the folder says; empty where there is none that can be read.
std::string package_name(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!is_file(manifest)) return {};
  try {
    const internal::XmlFile file(manifest, "package");
    const auto element = file.root().child("name");
    return element ? std::string(element->text()) : std::string();
  } catch (const Error&) {
    return {};
  }
}

// The file `rest` below a folder: of that name or, as in a URL, of the name that it escapes. A
// percent sign that begins no escape stays.
fs::path below(const fs::path& folder, std::string_view rest) {
  const fs::path path = folder / rest;
  const fs::path meant = folder / internal::percent_decoded(rest).text;
  return !is_file(path) && is_file(meant) ? meant : path;
}

// Where the files are that a URDF file names.
class MeshPaths {
 public:
  MeshPaths(const fs::path& urdf, const UrdfOptions& options)
      : folder_(absolute_path(urdf).parent_path()), packages_(options.packages) {}

  // Throws Error, whose subject is the name, for a file or package that cannot be found.
  fs::path find(const std::string& name) {
    const internal::MeshName given = internal::mesh_name(name);
    fs::path path;
    switch (given.kind) {
      case internal::MeshName::Kind::kPackage:
        path = in_package(name, given.rest);
        break;
      case internal::MeshName::Kind::kFile:
        path = below(folder_, given.rest);
        break;
      case internal::MeshName::Kind::kPath:
        path = folder_ / given.rest;
        break;
      case internal::MeshName::Kind::kOtherScheme:
        throw Error(name, "only package:// and file:// can be followed");
    }
    path = path.lexically_normal();
    if (is_file(path)) return path;
    if (name.find("$(") != name.npos || name.find("${") != name.npos)
      throw Error(name, kIsForXacro);
    throw Error(name, "there is no such file: " + path.string());
  }

 private:
  // Of `name`, what stands behind package://: a package and a file in it.
  fs::path in_package(const std::string& name, std::string_view rest) {
    const std::size_t begin = std::min(rest.find_first_not_of('/'), rest.size());
    const std::size_t slash = std::min(rest.find('/', begin), rest.size());
    const std::string package(rest.substr(begin, slash - begin));
    if (package.empty()) throw Error(name, "it names no package");
    auto root = packages_.find(package);
    if (root == packages_.end()) root = packages_.emplace(package, package_root(package)).first;
    return below(root->second, rest.substr(std::min(slash + 1, rest.size())));
  }

  fs::path package_root(const std::string& package) {
    if (!missing_.contains(package)) {
      std::size_t height = 0;
      for (fs::path at = folder_;; at = at.parent_path()) {
        if (height == above_.size()) above_.push_back(package_name(at));
        if (above_[height++] == package) return at;
        if (package_name(at / package) == package) return at / package;
        if (at == at.parent_path()) break;
      }
      const std::optional<fs::path> found = of_environment(package);
      if (found) return *found;
      for (fs::path at = folder_; at != at.parent_path(); at = at.parent_path()) {
        if (at.filename() == package && package_name(at).empty()) return at;
      }
      for (fs::path at = folder_; at != at.parent_path(); at = at.parent_path()) {
        std::error_code ignored;
        if (fs::is_directory(at / package, ignored) && package_name(at / package).empty()) {
          return at / package;
        }
      }
      missing_.insert(package);
    }
    throw Error("package://" + package,
                "no folder above the URDF file is this package or has it beside it (by its name, "
                "or that in a package.xml), and neither ROS_PACKAGE_PATH nor AMENT_PREFIX_PATH "
                "leads to it; --package " +
                    package + "=FOLDER says where it is");
  }

  // Where ROS has the package.
  static std::optional<fs::path> of_environment(const std::string& package) {
    constexpr std::array<std::pair<const char*, const char*>, 2> kVariables = {
        {{"ROS_PACKAGE_PATH", ""}, {"AMENT_PREFIX_PATH", "share"}}};
    for (const auto& [variable, below] : kVariables) {
      const char* const value = std::getenv(variable);
      std::string_view rest = value == nullptr ? "" : value;
      while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const fs::path folder = fs::path(rest.substr(0, end)) / below;
        rest.remove_prefix(std::min(end + 1, rest.size()));
        std::error_code ignored;
        if (fs::is_directory(folder / package, ignored)) return folder / package;
        if (folder.filename() == package && fs::is_directory(folder, ignored)) return folder;
      }
    }
    return std::nullopt;
  }

  fs::path folder_;
  // The packages that the folder of the file and those above it are, often none, as far as known.
  std::vector<std::string> above_;
  std::set<std::string> missing_;
  std::map<std::string, fs::path> packages_;  // given, and found since
};

class ShapeReader {
 public:
  ShapeReader(const std::filesystem::path& path, const UrdfOptions& options, int minor_version)
      : paths_(path, options), options_(options), minor_version_(minor_version) {}

  LinkDescription link_of(const XmlElement& link) {
    LinkDescription result{.name = link.needed("name")};
    for (const XmlElement& visual : link.children("visual")) {
      LinkShape shape = shape_of(visual, options_.require_visual_meshes);
      if (!is_point(solid_of(visual))) result.visual.push_back(std::move(shape));
    }
    for (const XmlElement& collision : link.children("collision")) {
      result.collision.push_back(shape_of(collision, options_.require_collision_meshes));
    }
    return result;
  }

 private:
  LinkShape shape_of(const XmlElement& element, bool require_mesh) {
    const XmlElement solid = solid_of(element);
    LinkShape shape{element.attribute("name").value_or(""), pose_of(element, minor_version_), {}};
    if (solid.tag() == "mesh") {
      shape.geometry = mesh_of(solid, require_mesh);
    } else {
      shape.geometry = primitive_of(solid);
    }
    return shape;
  }

  static Primitive primitive_of(const XmlElement& solid) {
    Primitive primitive;
    if (solid.tag() == "box") {
      solid.require_attributes({"size"});
      const Eigen::Vector3d size = solid.needed_vector("size");
      primitive = Box{size.unaryExpr(&with_extent)};
    } else if (solid.tag() == "sphere") {
      solid.require_attributes({"radius"});
      primitive = SolidSphere{with_extent(solid.needed_number("radius"))};
    } else if (solid.tag() == "capsule") {
      solid.require_attributes({"radius", "length"});
      primitive =
          Capsule{with_extent(solid.needed_number("radius")), solid.needed_number("length")};
    } else if (solid.tag() == "cylinder") {
      solid.require_attributes({"radius", "length"});
      primitive = Cylinder{with_extent(solid.needed_number("radius")),
                           with_extent(solid.needed_number("length"))};
    } else {
      solid.refuse(
          "it is none of the shapes that can be read: box, capsule, cylinder, mesh, sphere");
    }
    at(solid, [&] { require_primitive(primitive, "shape"); });
    return primitive;
  }

  MeshFile mesh_of(const XmlElement& mesh, bool required) {
    const std::string name = mesh.needed("filename");
    const Eigen::Vector3d scale = mesh.vector("scale", Eigen::Vector3d::Ones());
    if ((scale.array() == 0.0).any()) mesh.refuse(name + ": its scale is zero");
    try {
      return {paths_.find(name), scale};
    } catch (const Error& error) {
      if (required) mesh.refuse(error.what());
      return {name, scale};
    }
  }

  MeshPaths paths_;
  const UrdfOptions& options_;
  int minor_version_;
};

// A fixed joint mimics nothing, whatever the element says.
void add_mimic(RobotModel& robot, const XmlElement& joint) {
  const auto mimic = joint.child("mimic");
  if (!mimic) return;
  mimic->require_attributes({"joint", "multiplier", "offset"});
  const std::string other = mimic->needed("joint");
  const double multiplier = mimic->number("multiplier", 1.0);
  const double offset = mimic->number("offset", 0.0);
  if (kind_of(joint) != JointKind::kOne) mimic->refuse("a planar or floating joint mimics none");
  if (type_of(joint) == JointType::kFixed) return;
  at(*mimic, [&] { robot.mimic(joint.needed("name"), other, multiplier, offset); });
}

// The names of the joints whose positions are the numbers of a configuration, as the file has them;
// nothing where that is the order of the model. `parts` names what became of each joint.
std::vector<std::string> other_order(const XmlElement& robot,
                                     const std::map<std::string, std::vector<std::string>>& parts,
                                     const RobotModel& model) {
  std::vector<std::string> names;
  for (const XmlElement& element : robot.children("joint")) {
    for (const std::string& name : parts.at(element.needed("name"))) {
      const Joint& joint = model.joints()[static_cast<std::size_t>(model.find_joint(name))];
      if (joint.moves() && joint.mimics < 0) names.push_back(name);
    }
  }
  const bool is_same =
      std::ranges::equal(names, model.variable_joints(), [&](const std::string& name, int index) {
        return name == model.joints()[static_cast<std::size_t>(index)].name;
      });
  return is_same ? std::vector<std::string>() : names;
}

}  // namespace

std::string internal::urdf_text(const fs::path& path) {
  if (path.extension() != ".xacro") return read_file(path);
  const std::string file = path.string();
  // So that a name that begins with a dash is no option.
  const std::array<std::string, 1> arguments = {path.is_relative() ? "./" + file : file};
  ProgramOutput output = run_program("xacro", arguments, STDOUT_FILENO);
  if (!output.not_started.empty()) {
    throw Error(file, "needs the program xacro, which makes a URDF of it and cannot be run: " +
                          output.not_started);
  }
  if (WIFSIGNALED(output.status)) throw Error(file, "xacro was ended by a signal");
  if (WEXITSTATUS(output.status) != 0) {
    throw Error(file, "xacro makes no URDF of it (exit code " +
                          std::to_string(WEXITSTATUS(output.status)) + ")");
  }
  return std::move(output.bytes);
}

RobotDescription read_urdf(const std::filesystem::path& path, const UrdfOptions& options) {
  const internal::XmlFile file(path.string(), internal::urdf_text(path), "robot");
  const XmlElement robot = file.root();
  const int minor_version = minor_version_of(robot);
  refuse_xacro(robot);
  const UrdfTree tree = TreeGatherer(robot).tree();
  RobotDescription result{.name = robot.needed("name"),
                          .model = RobotModel(tree.links.front().needed("name"))};
  RobotModel& model = result.model;
  ShapeReader shapes(path, options, minor_version);
  result.links.emplace_back();
  std::map<std::string, std::vector<std::string>> parts;  // of each joint of the file
  for (const XmlElement& element : tree.joints) {
    std::string parent = link_at(element, "parent");
    std::vector<std::string>& names = parts[element.needed("name")];
    const std::vector<Joint> joints = joints_of(element, minor_version, result.warnings);
    for (const Joint& joint : joints) {
      const bool is_last = &joint == &joints.back();
      const std::string link = is_last ? link_at(element, "child") : joint.name;
      at(element, [&] { model.add_link(link, parent, joint); });
      if (!is_last) result.links.push_back({.name = link});
      names.push_back(joint.name);
      parent = link;
    }
    result.links.emplace_back();
  }
  for (const XmlElement& joint : tree.joints) add_mimic(model, joint);
  for (const XmlElement& link : tree.links) {
    const auto index = static_cast<std::size_t>(model.find_link(link.needed("name")));
    result.links[index] = shapes.link_of(link);
  }
  result.other_joint_order = other_order(robot, parts, model);
  return result;
}

}  // namespace spherule
