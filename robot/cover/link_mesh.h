// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The shapes of a link as one mesh, and what links are made of for proofs about pairs of them.
//
// @code{.cpp}
// #include <spherule/robot/cover/link_mesh.h>
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
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <optional>
#include <span>
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

}  // namespace spherule

// What the links of a robot are made of, for proofs about pairs of them.
//
// @code{.cpp}
//
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 0.2}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// const std::vector<spherule::LinkBody> bodies = spherule::link_bodies(robot);
// assert(bodies.size() == 1 && bodies[0].mesh->has_inside());
// @endcode

namespace spherule {

// What one link is made of, by its index: as below; none without such geometry.
std::optional<LinkBody> link_body(const RobotDescription& robot, int link,
                                  const LinkMeshOptions& options = {}, double padding = 0.0);

// What the links are made of, for prove_link_pairs(): a mesh with its inside for each link that has
// such geometry, in the order of the links, grown by its vertex error and by `padding` (metres, at
// least 0), so that what is proved of the bodies holds for the exact geometry of the links grown by
// the padding. Throws Error as link_mesh() does, and for a padding that is negative or not finite.
std::vector<LinkBody> link_bodies(const RobotDescription& robot,
                                  const LinkMeshOptions& options = {}, double padding = 0.0);

}  // namespace spherule
