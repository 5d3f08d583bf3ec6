// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"
#include "robot/cover/internal/link_subject.h"
#include "robot/cover/link_mesh.h"
#include "robot/model/link_spheres.h"
#include "robot/model/robot_description.h"
#include "spheretree/error.h"
#include "spheretree/progress.h"
#include "spheretree/sphere.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::internal {

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

}  // namespace spherule::internal
