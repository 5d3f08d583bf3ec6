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

using Value = internal::JsonValue<Json>;

std::string name_of(const Value& value) {
  const std::string name = value.text();
  value.expect(!name.empty(), "is empty");
  return name;
}

double number_of(const Value& value) {
  const double number = value.number();
  value.expect(is_usable_coordinate(number), "is beyond 1e15");
  return number;
}

double positive(const Value& value) {
  const double number = number_of(value);
  value.expect(number > 0.0, "is not above 0");
  return number;
}

double not_negative(const Value& value) {
  const double number = number_of(value);
  value.expect(number >= 0.0, "is below 0");
  return number;
}

template <int kCount>
Eigen::Matrix<double, kCount, 1> numbers(const Value& value) {
  const auto list = value.numbers<kCount>("a list of " + std::to_string(kCount) + " numbers");
  const Eigen::Matrix<double, kCount, 1> result(list.data());
  value.expect(result.cwiseAbs().maxCoeff() <= kMaxCoordinate, "is beyond 1e15");
  return result;
}

Pose read_pose(const Value& object) {
  if (!object.has("pose")) return {};
  const Value pose = object.at("pose");
  pose.require_keys({"position", "quaternion", "rpy"});
  const Vector3d position =
      pose.has("position") ? numbers<3>(pose.at("position")) : Vector3d(Vector3d::Zero());
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  pose.unless(!(pose.has("quaternion") && pose.has("rpy")), "has both 'quaternion' and 'rpy'");
  if (pose.has("quaternion")) {
    const Eigen::Vector4d q = numbers<4>(pose.at("quaternion"));
    pose.at("quaternion").expect(q.norm() > 1e-9, "is zero");
    rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  } else if (pose.has("rpy")) {
    const Vector3d rpy = numbers<3>(pose.at("rpy"));
    rotation = Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
               Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
               Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX());
  }
  return Pose(rotation, position);
}

class SceneReader {
 public:
  SceneReader(const fs::path& path, const Json& document)
      : file_(path.string()), folder_(path.parent_path()), root_(document, file_) {}

  SceneDescription read() {
    root_.expect(root_.json().is_object(), "is not an object");
    root_.unless(root_.has("format") && root_.at("format").text() == kFormat,
                 "is no scene: 'format' is not 'spherule-scene'");
    const Value version = root_.at("version");
    version.expect(version.json().is_number_integer(), "is not a whole number");
    version.expect(version.json() == kVersion, "is not 1, the version that this program reads");
    root_.require_keys({"format", "version", "robot", "obstacles", "attached", "regions",
                        "allowed_contacts", "padding"});
    if (root_.has("robot")) read_robot(root_.at("robot"));
    using Read = void (SceneReader::*)(const Value&);
    const auto each = [this](const char* key, const char* what, Read one) {
      if (!root_.has(key)) return;
      root_.at(key).each(what, [&](const Value& value) { (this->*one)(value); });
    };
    each("obstacles", "obstacle ", &SceneReader::read_obstacle);
    each("attached", "attached object ", &SceneReader::read_attached);
    each("regions", "region ", &SceneReader::read_region);
    each("allowed_contacts", "allowed contact ", &SceneReader::read_contact);
    each("padding", "padding ", &SceneReader::read_padding);
    return std::move(scene_);
  }

 private:
  fs::path file_of(const Value& value) const { return folder_ / name_of(value.at("file")); }

  void read_robot(const Value& robot) {
    robot.require_keys({"pose", "srdf"});
    scene_.world_from_root = read_pose(robot);
    if (robot.has("srdf")) scene_.srdf = folder_ / name_of(robot.at("srdf"));
  }

  // The name, which no other body or obstacle has.
  std::string take_name(const Value& value) {
    const std::string name = name_of(value.at("name"));
    value.unless(names_.insert(name).second,
                 "the name " + internal::in_quotes(name) + " is there twice");
    return name;
  }

  // The same place with the name of what stands there.
  static Value named(const Value& value, const std::string& name) {
    return value.placed(value.place() + " " + internal::in_quotes(name));
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
    result.scale =
        scale.json().is_array() ? numbers<3>(scale) : Vector3d::Constant(number_of(scale));
    scale.expect((result.scale.array() != 0.0).all(), "is 0");
    return result;
  }

  PointsSource read_points(const Value& points) const {
    points.require_keys({"file", "radius", "voxel", "scale"});
    PointsSource result{file_of(points), positive(points.at("radius"))};
    if (points.has("voxel")) result.voxel = not_negative(points.at("voxel"));
    if (points.has("scale")) result.scale = positive(points.at("scale"));
    return result;
  }

  static Primitive read_primitive(const std::string& key, const Value& value) {
    if (key == "box") {
      value.require_keys({"size"});
      return Box{numbers<3>(value.at("size"))};
    }
    if (key == "ball") {
      value.require_keys({"radius"});
      return SolidSphere{number_of(value.at("radius"))};
    }
    if (key == "half_space") {
      value.require_keys({});
      return HalfSpace{};
    }
    value.require_keys({"radius", "length"});
    const double radius = number_of(value.at("radius"));
    const double length = number_of(value.at("length"));
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
    const Value value = named(unnamed, obstacle.name);
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
    const Value value = named(unnamed, object.name);
    object.link = name_of(value.at("link"));
    const std::string key = shape_key(value, {"mesh", "spheres", "tree"});
    const Value shape = value.at(key.c_str());
    if (key == "mesh") {
      object.shape = read_mesh_source(shape);
    } else {
      object.shape = read_spheres<decltype(object.shape)>(key, shape);
    }
    if (value.has("max_error")) {
      value.unless(key == "mesh", "'max_error' is for meshes");
      object.max_error = positive(value.at("max_error"));
    }
    object.link_from_object = read_pose(value);
    scene_.attached.push_back(std::move(object));
  }

  void read_region(const Value& value) {
    value.require_keys({"body", "name", "ball"});
    SceneRegion region{name_of(value.at("body")), name_of(value.at("name")), {}};
    const Value sphere = value.at("ball");
    sphere.require_keys({"center", "radius"});
    region.around = {numbers<3>(sphere.at("center")), positive(sphere.at("radius"))};
    value.unless(regions_.insert({region.body, region.name}).second,
                 "the region " + internal::in_quotes(region.name) + " of " +
                     internal::in_quotes(region.body) + " is there twice");
    scene_.regions.push_back(std::move(region));
  }

  void read_contact(const Value& value) {
    value.require_keys({"body", "region", "other"});
    SceneContact contact{name_of(value.at("body")), {}, name_of(value.at("other"))};
    if (value.has("region")) {
      contact.region = name_of(value.at("region"));
      value.unless(regions_.contains({contact.body, contact.region}),
                   internal::in_quotes(contact.body) + " has no region " +
                       internal::in_quotes(contact.region));
    }
    scene_.allowed_contacts.push_back(std::move(contact));
  }

  void read_padding(const Value& value) {
    value.require_keys({"body", "other", "distance"});
    ScenePadding padding{name_of(value.at("body")), {}, not_negative(value.at("distance"))};
    if (value.has("other")) padding.other = name_of(value.at("other"));
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

}  // namespace

SceneDescription read_scene(const fs::path& path) {
  const auto document = internal::parse_json<Json>(
      read_file(path), [&](const std::string& reason) { throw Error(path.string(), reason); });
  return SceneReader(path, document).read();
}

}  // namespace spherule
