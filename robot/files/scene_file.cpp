// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/scene_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "base/text.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

constexpr std::string_view kFormat = "spherule-scene";
constexpr std::int64_t kVersion = 1;

// A value with the place where it stands, for messages.
class Value {
 public:
  Value(const Json& json, std::string place, const std::string& file)
      : json_(json), place_(std::move(place)), file_(file) {}

  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(file_, place_.empty() ? reason : place_ + ": " + reason);
  }
  void unless(bool good, const std::string& reason) const {
    if (!good) refuse(reason);
  }

  // An object with no keys but these.
  void require_keys(std::initializer_list<std::string_view> keys) const {
    unless(json_.is_object(), "is not an object");
    for (const auto& [key, value] : json_.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      const std::vector<std::string> known(keys.begin(), keys.end());
      refuse("the key " + internal::in_quotes(key) + " is not known here" +
             internal::did_you_mean(key, known));
    }
  }
  bool has(const char* key) const { return json_.contains(key); }
  Value at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) refuse(internal::in_quotes(key) + " is missing");
    return Value(*found, place_.empty() ? key : place_ + ", " + key, file_);
  }
  // The elements of a list, of which each is called `what` and its number; none if it is not there.
  template <class Take>
  void each(const char* key, const std::string& what, const Take& take) const {
    if (!has(key)) return;
    const Value list = at(key);
    list.unless(list.json_.is_array(), "is not a list");
    for (std::size_t i = 0; i < list.json_.size(); ++i) {
      take(Value(list.json_[i], what + " " + std::to_string(i), file_));
    }
  }
  // The same place with the name of what stands there.
  Value named(const std::string& name) const {
    return Value(json_, place_ + " " + internal::in_quotes(name), file_);
  }

  std::string text() const {
    unless(json_.is_string(), "is not a text");
    return json_.get<std::string>();
  }
  std::string name() const {
    const std::string name = text();
    unless(!name.empty(), "is empty");
    return name;
  }
  double number() const {
    unless(json_.is_number(), "is not a number");
    const double value = json_.get<double>();
    unless(is_usable_coordinate(value), "is beyond 1e15");
    return value;
  }
  double positive() const {
    const double value = number();
    unless(value > 0.0, "is not above 0");
    return value;
  }
  double not_negative() const {
    const double value = number();
    unless(value >= 0.0, "is below 0");
    return value;
  }
  std::int64_t whole() const {
    unless(json_.is_number_integer(), "is not a whole number");
    return json_.get<std::int64_t>();
  }
  template <int kCount>
  Eigen::Matrix<double, kCount, 1> numbers() const {
    unless(json_.is_array() && json_.size() == kCount,
           "is not a list of " + std::to_string(kCount) + " numbers");
    Eigen::Matrix<double, kCount, 1> result;
    for (std::size_t i = 0; i < kCount; ++i) {
      result[static_cast<Eigen::Index>(i)] = Value(json_[i], place_, file_).number();
    }
    return result;
  }
  bool is_list() const { return json_.is_array(); }

 private:
  const Json& json_;
  std::string place_;
  const std::string& file_;
};

Pose read_pose(const Value& object) {
  if (!object.has("pose")) return {};
  const Value pose = object.at("pose");
  pose.require_keys({"position", "quaternion", "rpy"});
  const Vector3d position =
      pose.has("position") ? pose.at("position").numbers<3>() : Vector3d(Vector3d::Zero());
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  pose.unless(!(pose.has("quaternion") && pose.has("rpy")), "has both 'quaternion' and 'rpy'");
  if (pose.has("quaternion")) {
    const Eigen::Vector4d q = pose.at("quaternion").numbers<4>();
    pose.at("quaternion").unless(q.norm() > 1e-9, "is zero");
    rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  } else if (pose.has("rpy")) {
    const Vector3d rpy = pose.at("rpy").numbers<3>();
    rotation = Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
               Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
               Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX());
  }
  return Pose(rotation, position);
}

class SceneReader {
 public:
  SceneReader(const fs::path& path, const Json& document)
      : file_(path.string()), folder_(path.parent_path()), root_(document, {}, file_) {}

  SceneDescription read() {
    root_.unless(root_.has("format") && root_.at("format").text() == kFormat,
                 "is no scene: 'format' is not 'spherule-scene'");
    root_.at("version").unless(root_.at("version").whole() == kVersion,
                               "is not 1, the version that this program reads");
    root_.require_keys({"format", "version", "robot", "obstacles", "attached", "regions",
                        "allowed_contacts", "padding"});
    if (root_.has("robot")) read_robot(root_.at("robot"));
    root_.each("obstacles", "obstacle", [this](const Value& value) { read_obstacle(value); });
    root_.each("attached", "attached object", [this](const Value& value) { read_attached(value); });
    root_.each("regions", "region", [this](const Value& value) { read_region(value); });
    root_.each("allowed_contacts", "allowed contact",
               [this](const Value& value) { read_contact(value); });
    root_.each("padding", "padding", [this](const Value& value) { read_padding(value); });
    return std::move(scene_);
  }

 private:
  fs::path file_of(const Value& value) const { return folder_ / value.at("file").name(); }

  void read_robot(const Value& robot) {
    robot.require_keys({"pose", "srdf"});
    scene_.world_from_root = read_pose(robot);
    if (robot.has("srdf")) scene_.srdf = folder_ / robot.at("srdf").name();
  }

  // The name, which no other body or obstacle has.
  std::string take_name(const Value& value) {
    value.unless(value.has("name"), "'name' is missing");
    const std::string name = value.at("name").name();
    value.unless(names_.insert(name).second,
                 "the name " + internal::in_quotes(name) + " is there twice");
    return name;
  }

  // The one key among those of shapes.
  std::string shape_key(const Value& object, std::initializer_list<const char*> keys) const {
    std::string found;
    std::string all;
    for (const char* key : keys) {
      all += (all.empty() ? "" : ", ") + std::string(key);
      if (!object.has(key)) continue;
      object.unless(found.empty(),
                    "has both " + internal::in_quotes(found) + " and " + internal::in_quotes(key));
      found = key;
    }
    object.unless(!found.empty(), "has no shape: one of " + all);
    return found;
  }

  MeshFile read_mesh_source(const Value& mesh) const {
    mesh.require_keys({"file", "scale"});
    MeshFile result{file_of(mesh)};
    if (!mesh.has("scale")) return result;
    const Value scale = mesh.at("scale");
    result.scale = scale.is_list() ? scale.numbers<3>() : Vector3d::Constant(scale.number());
    scale.unless((result.scale.array() != 0.0).all(), "is 0");
    return result;
  }

  PointsSource read_points(const Value& points) const {
    points.require_keys({"file", "radius", "voxel", "scale"});
    PointsSource result{file_of(points), points.at("radius").positive()};
    if (points.has("voxel")) result.voxel = points.at("voxel").not_negative();
    if (points.has("scale")) result.scale = points.at("scale").positive();
    return result;
  }

  static Primitive read_primitive(const std::string& key, const Value& value) {
    if (key == "box") {
      value.require_keys({"size"});
      return Box{value.at("size").numbers<3>()};
    }
    if (key == "ball") {
      value.require_keys({"radius"});
      return SolidSphere{value.at("radius").number()};
    }
    if (key == "half_space") {
      value.require_keys({});
      return HalfSpace{};
    }
    value.require_keys({"radius", "length"});
    const double radius = value.at("radius").number();
    const double length = value.at("length").number();
    if (key == "cylinder") return Cylinder{radius, length};
    return Capsule{radius, length};
  }

  // Spheres or a tree.
  template <class Shape>
  Shape read_spheres(const std::string& key, const Value& value) const {
    value.require_keys({"file"});
    if (key == "tree") return TreeSource{file_of(value)};
    return SpheresSource{file_of(value)};
  }

  void read_obstacle(const Value& unnamed) {
    unnamed.require_keys({"name", "pose", "mesh", "spheres", "tree", "points", "box", "ball",
                          "cylinder", "capsule", "half_space"});
    SceneObstacle obstacle{take_name(unnamed), Primitive()};
    const Value value = unnamed.named(obstacle.name);
    const std::string key = shape_key(value, {"mesh", "spheres", "tree", "points", "box", "ball",
                                              "cylinder", "capsule", "half_space"});
    const Value shape = value.at(key.c_str());
    if (key == "mesh") {
      obstacle.shape = read_mesh_source(shape);
    } else if (key == "points") {
      obstacle.shape = read_points(shape);
    } else if (key == "spheres" || key == "tree") {
      obstacle.shape = read_spheres<decltype(obstacle.shape)>(key, shape);
    } else {
      const Primitive primitive = read_primitive(key, shape);
      try {
        require_primitive(primitive, key);
      } catch (const Error& error) {
        shape.refuse(error.reason());
      }
      obstacle.shape = primitive;
    }
    obstacle.world_from_shape = read_pose(value);
    scene_.obstacles.push_back(std::move(obstacle));
  }

  void read_attached(const Value& unnamed) {
    unnamed.require_keys({"name", "link", "pose", "mesh", "spheres", "tree", "max_error"});
    SceneAttachment object{take_name(unnamed), {}, MeshFile()};
    const Value value = unnamed.named(object.name);
    object.link = value.at("link").name();
    const std::string key = shape_key(value, {"mesh", "spheres", "tree"});
    const Value shape = value.at(key.c_str());
    if (key == "mesh") {
      object.shape = read_mesh_source(shape);
    } else {
      object.shape = read_spheres<decltype(object.shape)>(key, shape);
    }
    if (value.has("max_error")) {
      value.unless(key == "mesh", "'max_error' is for meshes");
      object.max_error = value.at("max_error").positive();
    }
    object.link_from_object = read_pose(value);
    scene_.attached.push_back(std::move(object));
  }

  void read_region(const Value& value) {
    value.require_keys({"body", "name", "ball"});
    SceneRegion region{value.at("body").name(), value.at("name").name(), {}};
    const Value sphere = value.at("ball");
    sphere.require_keys({"center", "radius"});
    region.around = {sphere.at("center").numbers<3>(), sphere.at("radius").positive()};
    value.unless(regions_.insert({region.body, region.name}).second,
                 "the region " + internal::in_quotes(region.name) + " of " +
                     internal::in_quotes(region.body) + " is there twice");
    scene_.regions.push_back(std::move(region));
  }

  void read_contact(const Value& value) {
    value.require_keys({"body", "region", "other"});
    SceneContact contact{value.at("body").name(), {}, value.at("other").name()};
    if (value.has("region")) {
      contact.region = value.at("region").name();
      value.unless(regions_.contains({contact.body, contact.region}),
                   internal::in_quotes(contact.body) + " has no region " +
                       internal::in_quotes(contact.region));
    }
    scene_.allowed_contacts.push_back(std::move(contact));
  }

  void read_padding(const Value& value) {
    value.require_keys({"body", "other", "distance"});
    ScenePadding padding{value.at("body").name(), {}, value.at("distance").not_negative()};
    if (value.has("other")) padding.other = value.at("other").name();
    value.unless(padded_.insert(std::minmax(padding.body, padding.other)).second,
                 "the padding of " + internal::in_quotes(padding.body) + " is given twice");
    scene_.padding.push_back(std::move(padding));
  }

  const std::string file_;
  const fs::path folder_;
  const Value root_;
  std::set<std::string> names_;
  std::set<std::pair<std::string, std::string>> regions_;
  std::set<std::pair<std::string, std::string>> padded_;  // in order; one body: with an empty name
  SceneDescription scene_;
};

Json parsed(const std::string& text, const std::string& file) {
  Json document = internal::parse_json<Json>(
      text, [&](const std::string& reason) { throw Error(file, reason); });
  if (!document.is_object()) throw Error(file, "is not an object");
  return document;
}

}  // namespace

SceneDescription read_scene(const fs::path& path) {
  const Json document = parsed(read_file(path), path.string());
  return SceneReader(path, document).read();
}

}  // namespace spherule
