// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What is around a robot, from a file (docs/scene-file.md), and points from files.
//
// @code{.cpp}
// #include <spherule/robot/files/scene_file.h>
// #include <cassert>
// #include <fstream>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.scene.json";
// std::ofstream(path) << R"({"format": "spherule-scene", "version": 1,
//   "obstacles": [{"name": "floor", "half_space": {}}]})";
// const spherule::SceneDescription scene = spherule::read_scene(path);
// assert(scene.obstacles[0].name == "floor");
// @endcode

#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "robot/model/robot_model.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace spherule {

// SPHERES.json (io/sphere_file.h).
struct SpheresSource {
  std::filesystem::path path;
};

// A sphere tree (spheretree/tree_file.h).
struct TreeSource {
  std::filesystem::path path;
};

// A cloud of points (read_point_cloud()), in the file's own unit, which `scale` turns
// into metres; radius and voxel as point_cloud_tree() takes them, in metres.
struct PointsSource {
  std::filesystem::path path;
  double radius = 0.0;
  double voxel = 0.0;
  double scale = 1.0;
};

// An obstacle as the file describes it.
struct SceneObstacle {
  std::string name;
  std::variant<Primitive, MeshFile, SpheresSource, TreeSource, PointsSource> shape;
  Pose world_from_shape{};
};

// A tool or a part that moves with a link.
struct SceneAttachment {
  std::string name;
  std::string link;
  std::variant<MeshFile, SpheresSource, TreeSource> shape;
  // E of the spheres that cover a mesh; 0: as those of the robot.
  double max_error = 0.0;
  Pose link_from_object{};
};

// A named part of a link or an attached object: the spheres with their centre in a sphere, given in
// the frame of the link or object.
struct SceneRegion {
  std::string body;
  std::string name;
  Sphere around;
};

// A body, or only its region unless that is empty, that may touch another body or an obstacle.
struct SceneContact {
  std::string body;
  std::string region;
  std::string other;
};

// By how much a body grows, or, where `other` is not empty, how much farther the two are kept from
// each other.
struct ScenePadding {
  std::string body;
  std::string other;
  double padding = 0.0;
};

// What a scene file says is around a robot. Metres.
struct SceneDescription {
  Pose world_from_root{};                     // where the robot stands
  std::optional<std::filesystem::path> srdf;  // whose disabled pairs are not tested
  std::vector<SceneObstacle> obstacles{};
  std::vector<SceneAttachment> attached{};
  std::vector<SceneRegion> regions{};
  std::vector<SceneContact> allowed_contacts{};
  std::vector<ScenePadding> padding{};
};

// Reads a scene (JSON, docs/scene-file.md). Paths in it are from the folder of the scene file; the
// files they name are not examined. Every key must be one that the format knows, so that a word
// that is misspelt does not place an obstacle elsewhere than it was meant.
//
// Throws Error, whose subject is the file and whose reason names the place in it: for a file that
// cannot be read, is no JSON (with the line), or is of another format or a newer version of it;
// keys that are unknown, missing or there twice; values of a wrong type; numbers out of range;
// names that are empty or taken; and regions of bodies that the scene and contacts of regions that
// it has not. Links are not known here.
SceneDescription read_scene(const std::filesystem::path& path);

// Points from files.
//
// @code{.cpp}
// #include <cmath>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.xyz";
// std::ofstream(path) << "# millimetres\n0 0 0\n1000 0 500\n";
// const spherule::PointCloudFile cloud = spherule::read_point_cloud(path, 0.001);
// assert(cloud.points.size() == 2 && std::abs(cloud.points[1].z() - 0.5) <= cloud.point_error);
// @endcode

// The points of a file, and how exactly they are held.
struct PointCloudFile {
  std::vector<Eigen::Vector3d> points{};
  // Bound of the distance between a point as stored here and as written in the file, scaled exactly
  // by any number that rounds to `scale`; a scale of 1 is meant as such.
  double point_error = 0.0;
};

// Reads the points of a file as PCL, Open3D and CloudCompare write them: PLY (the vertices; text or
// binary, whatever else it has), PCD (text, binary or compressed; VIEWPOINT moves no point, as with
// PCL), or text: the files of the extensions xyz, txt, csv, asc and pts, with x, y and z at the
// beginning of each line, or in the columns that a first line of names calls x, y and z (X, Y and
// Z), separated by blanks, commas or semicolons; what follows a # is passed over. A file pts may
// begin with a line of the number of its points. Decimals are after a point. A point with a
// coordinate that is not finite (nan) is none: so clouds mark what was not measured. Numbers are
// multiplied by `scale`.
//
// Throws Error, whose subject is the file and whose reason names the line, the byte or the point:
// for a file that cannot be read, another extension, a header that is malformed or has no x, y and
// z, a file that is cut short or longer than it says, what is no number or beyond kMaxCoordinate, a
// line with commas beside semicolons or beside blanks that separate (they may be those of
// decimals), a number of points that is not theirs, a compressed file that unpacks to more than
// 2^29 bytes or 2^26 points, a file without points, and a scale that is not from 1e-300 to 1e15.
PointCloudFile read_point_cloud(const std::filesystem::path& path, double scale = 1.0);

}  // namespace spherule
