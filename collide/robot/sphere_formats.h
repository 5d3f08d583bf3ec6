// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/link_spheres.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// The files in which tools keep the balls of a robot. The first six are written too.
enum class SphereFormat {
  kUrdf,        // spherized URDF: a <collision> with a <sphere> for each ball
  kSrdf,        // SRDF: link_sphere_approximation
  kCurobo,      // cuRobo: robot_cfg / kinematics / collision_spheres, or collision_spheres alone
  kXrdf,        // XRDF 1.0
  kFoam,        // foam: a list of levels
  kSpherule,    // {"format":"spherule-robot-spheres","version":1,...}
  kBallpark,    // {"link":{"centers":[..],"radii":[..]}}
  kMorphit,     // {"centers":[..],"radii":[..],...}: one mesh
  kIrmv,        // {"link":{"BiggesetSphere":[..],"SubSpheres":{..}}} (spelt so)
  kBradshaw,    // .sph of the sphere-tree toolkit: one mesh
  kSphereFile,  // SPHERES.json (spheretree/sphere_file.h): one mesh
};

// "spherized URDF", "cuRobo yml", ...: for messages and tables.
std::string_view name_of(SphereFormat format);

// Whether write_robot_spheres() knows the format.
bool is_written(SphereFormat format);

// The format of that name on the command line (urdf, srdf, curobo, xrdf, foam, json), if any.
std::optional<SphereFormat> sphere_format_named(std::string_view name);

// NAME.spheres.urdf, NAME.srdf, NAME.curobo.yml, NAME.xrdf, NAME.foam.json or NAME.spheres.json.
// Throws Error for a robot whose name cannot be part of a file name, and for formats that are not
// written.
std::string sphere_file_name(std::string_view robot, SphereFormat format);

struct SphereReadOptions {
  // Formats of one mesh, and levels of it: to which link the balls belong.
  std::string link = {};
  // Formats with levels (foam, Bradshaw): which one, 0 the coarsest; the finest by default.
  std::optional<std::size_t> level = std::nullopt;
};

struct SphereFormatFile {
  SphereFormat format = SphereFormat::kSpherule;
  RobotSpheres spheres;
};

// Reads a file of any of these formats; which one is told by the content, not by the name. Balls
// are in the frame of the link that carries them, links in the order of the file.
// - Spherized URDF: the <sphere> elements of each link's <collision>; a link with another shape in
//   its <collision> is refused, because its balls would not be the whole of it. A link that is
//   fixed to another and has one ball and no mesh, named LINK_sphereN after it, is a ball of LINK
//   (MorphIt): its centre is moved by the joint's transform, and the radius is grown by the bound
//   of the rounding, so that the ball read contains the ball meant.
// - cuRobo: also a file whose `collision_spheres` names another file, relative to it.
// - A radius of zero or below switches a ball off (all formats but our own): it is left out and
//   counted.
// - Nothing else is left out: numbers beyond 1e15, names or keys twice, values of a wrong type are
//   refused. Throws Error naming the file, the place (line of YAML and XML) and the reason.
SphereFormatFile read_robot_spheres(const std::filesystem::path& path,
                                    const SphereReadOptions& options = {});

// What the formats say of the robot besides its balls.
struct SphereFileContext {
  // The robot's URDF. kUrdf: the document whose <collision> elements are replaced. kCurobo:
  // urdf_path.
  std::filesystem::path urdf = {};
  // kSrdf, kCurobo, kXrdf: a file of that format, all of which is kept but the balls. Empty: a new
  // one.
  std::filesystem::path original = {};
  std::string base_link = {};                 // cuRobo, XRDF: the root
  std::string tool_link = {};                 // cuRobo: ee_link, XRDF: tool_frames
  std::vector<std::string> joint_names = {};  // cuRobo, XRDF: cspace, in the order of the robot
  std::vector<double> joint_positions = {};   // of these, where the robot rests; empty: zeros
};

// Writes one file. A format that keeps no place for something (a foam file for ignored pairs)
// leaves it out. Numbers are decimal, without an exponent where others read them, in the shortest
// form that reads back to the same double. The file appears whole or not at all; equal input gives
// equal bytes.
// - kUrdf: `context.urdf`, with the collision elements of each link in `spheres` replaced by one
// for
//   each ball; everything else is kept. Relative mesh paths are made relative to the new place.
//   Links that stand for one ball (above) go.
// - A link without balls: kUrdf, it has no <collision> any more; kSrdf, a ball of radius 0 says so.
// Throws Error for balls that are not usable or (but for kSpherule) have no radius, names that are
// empty, twice or not UTF-8, links that the URDF does not have, and files that cannot be read or
// written.
void write_robot_spheres(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const std::filesystem::path& path);

}  // namespace spherule
