// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres that are proved to cover a robot's links: cover_robot(). Before it, the shapes of a link
// as one mesh, and what links are made of for proofs about pairs of them.
//
// @code{.cpp}
// #include <spherule/robot/cover/robot_spheres.h>
// #include <cassert>
//
// const spherule::Primitive pin = spherule::Cylinder{.radius = 0.01, .length = 0.1};
// const spherule::LinkDescription link{.name = "base",
//                                      .collision = {{.name = "", .geometry = pin}}};
// const auto mesh = spherule::link_mesh(link, {.chord_error = 0.001});
// assert(mesh && mesh->triangles.size() > 20);
// assert(!spherule::link_mesh(link, {.geometry = spherule::LinkGeometry::kVisual}));
// @endcode

#include "geometry/triangle_mesh.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// Which of the two geometries that a URDF has for every link.
enum class LinkGeometry {
  kCollision,  // what the author of the robot means collision checks to see
  kVisual      // mostly the exact shape
};

// Of E: how closely cover_robot() and audit_robot() tessellate curved primitives.
inline constexpr double kChordErrorOfError = 1.0 / 16.0;

// How the shapes of a link become one mesh.
struct LinkMeshOptions {
  LinkGeometry geometry = LinkGeometry::kCollision;
  // How far triangles for a sphere, cylinder or capsule may lie outside of it; positive, in metres.
  double chord_error = 0.0005;
  // Vertices of a mesh file that are no further apart than this become one, as with
  // MeshReadOptions::weld, but in metres; under a scale with different factors along the axes less
  // is joined. It counts in `vertex_error`.
  double weld = 0.0;
};

// The shapes of that geometry, as the description lists them. There is no falling back from one to
// the other: a link without collision geometry is one that its author lets pass through things.
std::span<const LinkShape> link_shapes(const LinkDescription& link, LinkGeometry geometry);

// All shapes of a link in the frame of the link, in metres, as one mesh; empty for a link without
// such geometry. Mesh files are read as read_mesh() does it (a DAE file in its own unit turned to
// metres, its axes as they stand), 3MF files are turned to metres, too, then all are scaled, by
// other factors along each axis and mirrored where the description says so, the triangles turned so
// that they face as before.
//
// With M the mesh returned and t its `vertex_error`: M grown by t contains every point of the
// meshes as written in their files, scaled and posed in exact arithmetic, and |M| grown by t every
// point of the solid primitives, exactly. t bounds what reading, scale, pose and the rounding of
// tessellation cost. Curved primitives get tessellations from outside, which therefore add nothing
// to t; they lie within `chord_error` of the primitive.
//
// Throws Error: as read_mesh(); naming the link, for a scale that is zero or not finite, a
// primitive of unusable size, a half-space, and a chord error that is not positive or requires
// more than 1024 sides around; for coordinates beyond kMaxCoordinate.
std::optional<TriangleMesh> link_mesh(const LinkDescription& link,
                                      const LinkMeshOptions& options = {});

// What the links of a robot are made of, for proofs about pairs of them.
//
// @code{.cpp}
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 0.2}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// const std::vector<spherule::LinkBody> bodies = spherule::link_bodies(robot);
// assert(bodies.size() == 1 && bodies[0].mesh->has_inside());
// @endcode

// What one link is made of, by its index: as below; none without such geometry.
std::optional<LinkBody> link_body(const RobotDescription& robot, int link,
                                  const LinkMeshOptions& options = {}, double padding = 0.0);

// What the links are made of, for prove_link_pairs(): a mesh with its inside for each link that has
// such geometry, in the order of the links, grown by its vertex error and by `padding` (metres, at
// least 0), so that what is proved of the bodies holds for the exact geometry of the links grown by
// the padding. Throws Error as link_mesh() does, and for a padding that is negative or not finite.
std::vector<LinkBody> link_bodies(const RobotDescription& robot,
                                  const LinkMeshOptions& options = {}, double padding = 0.0);

// Covers a robot's links with spheres, and certifies them.
//
// @code{.cpp}
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 0.1}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// const auto cover = spherule::cover_robot(robot, {.max_error = 0.04, .effort = 0});
// assert(spherule::links_not_proved(cover).empty());
// assert(!spherule::robot_spheres(robot, cover).links[0].spheres.empty());
// @endcode

// What is other for one link than for the rest; what is absent is as for the rest. Metres, zones in
// the frame of the link. With a max error of its own and no D of its own, a link has the D that is
// chosen for this E, unless the robot's D is given.
struct LinkCoverOptions {
  std::optional<double> max_error = std::nullopt;
  std::optional<double> min_external_diameter = std::nullopt;
  std::optional<double> padding = std::nullopt;
  std::vector<Zone> zones = {};
};

// Lengths in metres.
struct RobotCoverOptions {
  // E of every link. A centimetre is what planners commonly leave as clearance anyway, and an arm
  // of human size gets a few hundred spheres.
  double max_error = 0.01;
  // D of every link; 0 chooses 4 E, the natural ratio: 90-degree edges need spheres of radius 2
  // E, and what is narrower than the smallest sphere of a tool made with the same E need not be
  // kept. For a link that is very large for its E it chooses more, with a warning
  // (SimplifyOptions::min_external_diameter).
  double min_external_diameter = 0.0;
  double tightness = SimplifyOptions{}.tightness;
  double padding = 0.0;
  double weld = 0.0;  // LinkMeshOptions::weld
  LinkGeometry geometry = LinkGeometry::kCollision;
  std::map<std::string, LinkCoverOptions> links = {};  // by the link's name
  std::uint64_t seed = 1;
  int effort = CoverOptions{}.effort;  // of the covering search, for each link
  double seconds = 0.0;                // and its limit in time, for each link; 0: none
  int threads = 0;                     // 0: all; the result does not depend on it
  Progress progress = {};              // the word on what is being done is a link's name
  // Called before the first link is covered, by the thread that called cover_robot(): with the name
  // of each link that is over 10 m and over 1,000 E across, or over 100 m, and a sentence that its
  // meshes may be in millimetres. LinkCover::warnings has it, too.
  std::function<void(const std::string& link, const std::string& doubt)> on_doubt = {};
  // CoverOptions::stop: every link then gets the fewest spheres proved so far, those whose turn has
  // not come their first answer.
  std::stop_token stop = {};
};

// One link's cover and what is proved of it. Lengths in metres, in the frame of the link.
struct LinkCover {
  std::string link;
  std::vector<Sphere> spheres = {};  // empty for a link without geometry
  // Of the fit and the proof; absent for a link without geometry.
  std::optional<Simplification> fit = std::nullopt;
  // Of the link's mesh, tessellated primitives included; 0 for a link of spheres alone.
  std::size_t triangles = 0;
  double vertex_error = 0.0;  // of that mesh; in the fit's padding
  double seconds = 0.0;       // on the wall clock; 0 where an equal link was covered before
  // For a person: an open mesh, promises that are not proved.
  std::vector<std::string> warnings = {};
};

// A robot's links with their spheres.
struct RobotCover {
  std::string robot;             // its name
  std::vector<LinkCover> links;  // of every link, in the order of the description
  RobotCoverOptions options;     // as used
};

// Covers the geometry of every link with spheres, each link by simplify(), and certifies them: the
// one function behind `spherule robot`. Promises G1 and G2 (docs/guarantee.md) for each link whose
// `fit` says so; links_not_proved() names the others. What is covered is the link's mesh grown by
// its vertex error and the padding (link_mesh()), so that exact primitives are covered too; by as
// much as their tessellation lies outside of them, at most E / 16, the spheres protrude less from
// it than E. S is that mesh simplified for things not smaller than D. Links of spheres alone are
// their own cover, with an S of their own. The protrusion is stated over exact primitives, too.
// Links with the same shapes, E, D and padding, and without zones, are covered once. Equal input
// and options give equal spheres on any number of threads, unless `seconds` is set or a stop is
// requested.
//
// Throws Error for options out of range, an option for a link that does not exist or has no such
// geometry, a robot without any, a link more than 10,000 E across (its mesh is probably in
// millimetres), and as link_mesh(). All files are read before the first link is covered.
RobotCover cover_robot(const RobotDescription& robot, const RobotCoverOptions& options = {});

// Throws the Error that cover_robot() would throw for options out of range, and for those of a link
// that does not exist or has no geometry: before long work.
void check_cover_options(const RobotDescription& robot, const RobotCoverOptions& options);

// Names of the links for which not everything promised is proved, in their order.
std::vector<std::string> links_not_proved(const RobotCover& cover);

// Names of the links whose search for few spheres was interrupted, in their order.
std::vector<std::string> links_interrupted(const RobotCover& cover);

// Why pairs of links are not to be checked, in lists of ignored pairs.
inline constexpr std::string_view kAdjacentReason = "Adjacent";
inline constexpr std::string_view kRigidReason = "Rigid (no joint moves them)";

// The spheres of all links, as the writers of formats take them: none for a link without geometry.
// Pairs of links that are not to be checked against each other are those that no joint moves
// against each other, and those that one joint joins, directly or past links without spheres:
// covers of neighbours overlap at their joint in any configuration. Links with one that has spheres
// between them are no neighbours: their reason is kRigidReason. Whether others may touch is for an
// SRDF to say.
RobotSpheres robot_spheres(const RobotDescription& robot, const RobotCover& cover);

}  // namespace spherule
