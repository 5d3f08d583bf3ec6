// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The files in which tools keep the spheres of a robot.
//
// @code{.cpp}
// #include <spherule/robot/formats/sphere_formats.h>
// #include <cassert>
//
// spherule::RobotSpheres spheres{.robot = "arm"};
// spheres.links = {{.link = "base", .spheres = {{{0, 0, 0.5}, 0.1}}}};
// const auto xrdf = spherule::SphereFormat::kXrdf;
// const auto folder = std::filesystem::temp_directory_path();
// const auto path = folder / spherule::sphere_file_name("arm", xrdf);
// spherule::write_robot_spheres(spheres, xrdf, {.base_link = "base"}, path);
// const spherule::SphereFormatFile file = spherule::read_robot_spheres(path);
// assert(file.format == xrdf && file.spheres.links[0].spheres == spheres.links[0].spheres);
// @endcode

#include "robot/files/robot_description.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// The spheres of a robot, and what the formats of other tools say beside them.
struct RobotSpheres {
  std::string robot = {};  // empty where the format names no robot
  // No name twice; a link without spheres is one that is stated to have none.
  std::vector<LinkSpheres> links = {};
  // Pairs left out of self-collision checks (cuRobo, XRDF: ignore; SRDF: disable_collisions, which
  // alone has a reason).
  std::vector<DisabledPair> self_collision_ignore = {};
  // By how much the spheres of a link are grown in self-collision checks, metres; cuRobo and XRDF.
  std::map<std::string, double> self_collision_buffer = {};
  // The geometry that is meant for self-collision checks where it is another one than that of
  // `links`, which is all that is read; XRDF alone has it.
  std::string self_collision_geometry = {};
  // By how much they are grown in checks against the world: all (cuRobo), or each link's (XRDF; of
  // cuRobo where it is not one number).
  double collision_buffer = 0.0;
  std::map<std::string, double> collision_buffers = {};
  // Spheres switched off by a radius of zero or below; not in `links`.
  std::size_t switched_off = 0;
  // Shapes other than spheres in the <collision> elements of a URDF; not in `links`.
  std::size_t other_shapes = 0;
  // The search for few spheres was interrupted; kSpherule alone has it.
  bool interrupted = false;
};

// The files in which tools keep the spheres of a robot. The first six are written too.
enum class SphereFormat {
  kUrdf,        // spherized URDF: a <collision> with a <sphere> for each sphere
  kSrdf,        // SRDF: link_sphere_approximation
  kCurobo,      // cuRobo: robot_cfg / kinematics / collision_spheres, or collision_spheres alone
  kXrdf,        // XRDF 1.0
  kFoam,        // foam: a list of levels
  kSpherule,    // {"format":"spherule-robot-spheres","version":1,...}
  kBallpark,    // {"link":{"centers":[..],"radii":[..]}}
  kMorphit,     // {"centers":[..],"radii":[..],...}: one mesh
  kIrmv,        // {"link":{"BiggesetSphere":[..],"SubSpheres":{..}}} (spelt so)
  kBradshaw,    // .sph of the sphere-tree toolkit: one mesh
  kSphereFile,  // SPHERES.json (io/sphere_file.h): one mesh
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

// What a file does not say itself.
struct SphereReadOptions {
  // Formats of one mesh, and levels of it: to which link the spheres belong.
  std::string link = {};
  // Formats with levels (foam, Bradshaw): which one, 0 the coarsest; the finest by default.
  std::optional<std::size_t> level = std::nullopt;
};

// What was read, and the format it was found to have.
struct SphereFormatFile {
  SphereFormat format = SphereFormat::kSpherule;
  RobotSpheres spheres;
};

// Reads a file of any of these formats; which one is told by the content, not by the name. Spheres
// are in the frame of the link that carries them, links in the order of the file.
// - Spherized URDF: the <sphere> elements of each link's <collision>. A leaf that is fixed to
//   another link, has nothing but one sphere in its <collision>, and is named LINK_sphereN after
//   that link, is a sphere of LINK (MorphIt): its centre is moved by the joint's transform, and the
//   radius is grown by the bound of the rounding, so that the sphere read contains the sphere
//   meant. Links that have other shapes and no sphere are not in `links`.
// - cuRobo: also a file whose `collision_spheres` names another file, relative to it.
// - XRDF: the geometry that `collision` names. One that `self_collision` names has to be there as
//   well.
// - A radius of zero or below switches a sphere off, and so does its link's absence from cuRobo's
//   collision_link_names: it is left out and counted. (In SRDF a radius of zero says that the link
//   has no spheres, and one below zero is refused; in our own formats only the latter.) Shapes that
//   are no spheres are left out and counted. Nothing else is left out.
// Throws Error, naming the file, the place (a line, a link, a number) and the reason, for a file
// that cannot be read or is of none of these formats, a URDF without spheres, names or keys that
// are there twice, values of a wrong type, numbers beyond 1e15.
SphereFormatFile read_robot_spheres(const std::filesystem::path& path,
                                    const SphereReadOptions& options = {});

// Whether a format holds the spheres of one mesh and names no link.
bool is_of_one_mesh(const SphereFormatFile& file);

// The spheres that checks against the world see where buffers shrink them: radii plus what is below
// zero of the buffers, rounded down, without those that vanish. Buffers above zero do not count.
std::vector<LinkSpheres> shrunk_by_buffers(const RobotSpheres& spheres);

// What the formats say of the robot beside its spheres.
struct SphereFileContext {
  // The robot's URDF: the document whose <collision> elements are replaced (kUrdf), or what
  // urdf_path names, as it stands here (kCurobo).
  std::filesystem::path urdf = {};
  // A file of the format, kSrdf, kCurobo or kXrdf, that is kept but for the spheres. Empty: none.
  std::filesystem::path original = {};
  std::string base_link = {};                 // cuRobo, XRDF: the root
  std::string tool_link = {};                 // cuRobo: ee_link, XRDF: tool_frames
  std::vector<std::string> joint_names = {};  // cuRobo, XRDF: cspace, in the order of the robot
  std::vector<double> joint_positions = {};   // of these, where the robot rests; empty: zeros
};

// Writes one file. What a format has no place for (a foam file for ignored pairs) is left out.
// Numbers are written in the shortest form that reads back to the same double, decimal without an
// exponent in XML and YAML. The file appears whole or not at all; equal input gives equal bytes.
// - kUrdf: `context.urdf`, with the collision elements of each link of `spheres` replaced by one
//   for each sphere, and leaves that stand for one sphere of such a link (above) taken out;
//   everything else is kept. Relative paths of meshes and textures are made relative to the new
//   place.
// - kSrdf, kCurobo, kXrdf: what `context.original` holds beside the spheres is kept as data, in its
//   order; layout is not, in YAML comments are lost and aliases are written out. In YAML kept are,
//   too, the spheres of links that `spheres` does not name, and those that are switched off. Pairs
//   of `spheres` that it does not list yet, in either order, are added: to cuRobo's files that have
//   `kinematics`, to XRDF that has `self_collision`, and, with their reason, to an SRDF that does
//   not enable them. Buffers, and reasons in YAML (as comments), go into a new file only.
// - A link without spheres: in SRDF, one sphere of radius 0 says so; in a URDF it has no
//   <collision>.
// Throws Error for spheres that are not usable or (but for kSpherule) have no extent,
// names that are empty, twice, not UTF-8 or have control characters, numbers that are not finite,
// links that the URDF does not have, and files that cannot be read or written.
void write_robot_spheres(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const std::filesystem::path& path);

// Throws the Error that write_robot_spheres() would throw for what it is given, but for the place
// of the file; writes nothing.
void check_robot_spheres(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const std::filesystem::path& path);

}  // namespace spherule
