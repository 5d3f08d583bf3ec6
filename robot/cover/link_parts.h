// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "collide/solids/primitive.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "robot/cover/robot_spheres.h"
#include "robot/model/robot_model.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::internal {

// How errors name a link.
inline std::string subject_of(const std::string& link) {
  return "link '" + link + "'";
}

// A link's mesh beside the spheres that it was given.
struct LinkParts {
  std::string link;
  std::size_t index = 0;  // of the link in the description
  // Of the first part with the same shapes and spheres; the own one where none is before.
  std::size_t first_equal = 0;
  std::optional<TriangleMesh> mesh;
  double chord_error = 0.0;  // of the mesh, which holds what it stands for; 0 without curved shapes
  std::vector<Sphere> spheres;
};

// Meshes and spheres of all links, checked; the links that the robot has not got go to `unknown`.
std::vector<LinkParts> parts_of(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                                LinkGeometry geometry, std::vector<std::string>* unknown);

// What `work` makes; an Error says of which link it is.
template <typename Work>
auto of_link(const std::string& link, Work work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(subject_of(link) + ", " + error.subject(), error.reason());
  }
}

// `done` of `all` steps are done, and that of this link begins.
inline void report(const Progress& progress, std::size_t done, std::size_t all,
                   const std::string& link) {
  if (progress) progress(static_cast<double>(done) / static_cast<double>(all), link.c_str());
}

// Sentences about a link's size that follow its name; empty where nothing is to be said. `across`
// is the diagonal of the box of its mesh; lengths are in metres.

// Why a link is not to be covered, or its spheres examined, for so small a max error.
std::string size_fault(double across, double max_error);

// That a link is so large that its mesh is rather in millimetres.
std::string size_doubt(double across, double max_error);

// For a person: D was to be chosen for a link, and is more than 4 E.
std::string link_diameter_warning(double min_external_diameter);

// S of a link's mesh, by the rule of simplify() for lengths that are 0, and how a cover of it is
// examined. Not copied: the options refer to it.
class LinkSolid {
 public:
  // Throws Error as simplified_solid().
  LinkSolid(const TriangleMesh& mesh, const SimplifyOptions& lengths,
            std::size_t max_cells = ExternalOptions::kMostCells);
  LinkSolid(const LinkSolid&) = delete;
  LinkSolid& operator=(const LinkSolid&) = delete;

  const ExternalSpheres& external() const { return solid_.external; }
  const CertifyOptions& certify_options() const { return certify_options_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  SimplifiedSolid solid_;
  CertifyOptions certify_options_;
  std::vector<std::string> warnings_;
};

// How open a link's mesh is, "its mesh is open (8 edges with one triangle, 0 with more than two)":
// what that means for the caller comes behind a colon. Of a report that says it is not closed.
std::string openness(const MeshReport& report);

// For each link the index of the first link that has the same shapes, number for number: fingers of
// a hand, legs of a walking robot. A link's own index where no earlier link has the same shapes, or
// where it has none.
std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry);

// A closed mesh about a solid primitive, seen counter-clockwise from outside. In exact arithmetic
// it encloses every point of the primitive and lies within `chord_error` of it; the mesh's
// vertex_error bounds what rounding moved. A box comes out exactly.
//
// A curved primitive is a polygon, tangent to its outline, that is turned about z: rings of equal
// regular polygons whose sides touch the outline's circles. The directions come from halving
// angles by square roots, so that they are the same on every machine.
//
// Throws Error, naming `subject`, for a half-space, sizes that require_primitive() refuses, a
// chord error that is not positive, and one that requires more than 1024 sides.
TriangleMesh mesh_around(const Primitive& primitive, double chord_error,
                         const std::string& subject);

// Whether every shape is a primitive that lies in a single one of the spheres, in exact arithmetic,
// and the spheres that hold them enclose no cavity: then these cover the shapes and their inside
// (G1), without any tessellation. False may also mean that this is not proved; it never is where a
// shape is a mesh. The spheres are usable.
bool lie_in_single_spheres(std::span<const LinkShape> shapes, std::span<const Sphere> spheres);

// The spheres that a link is made of, each grown by the padding, without those within another:
// nothing else covers the link as closely (G1, G2). Nothing where a shape is no sphere, or where it
// is not proved that they enclose no cavity.
std::optional<std::vector<Sphere>> exact_spheres(const LinkDescription& link, LinkGeometry geometry,
                                                 double padding);

// No point of the spheres is further from all shapes than this, in exact arithmetic. Nothing where
// a shape is a mesh.
std::optional<double> protrusion_over_primitives(std::span<const LinkShape> shapes,
                                                 std::span<const Sphere> spheres);

// How deep a point of the primitives among the shapes leaks, at least, in exact arithmetic.
struct PrimitiveLeak {
  double depth = 0.0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // up to rounding
};

// Of the points of the primitives that are nearest to `near`, the one that leaks most.
PrimitiveLeak leak_of_primitives(std::span<const LinkShape> shapes, std::span<const Sphere> spheres,
                                 const Eigen::Vector3d& near);

// The largest radius of a sphere, a cylinder or a capsule; 0 where there is none.
double largest_radius(std::span<const LinkShape> shapes);

}  // namespace spherule::internal
