// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/link_bodies.h"

#include "collide/solid_mesh.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

namespace spherule {

std::vector<LinkBody> link_bodies(const RobotDescription& robot, const LinkMeshOptions& options,
                                  double padding) {
  if (!(padding >= 0.0) || !std::isfinite(padding)) {
    throw Error("padding", "must be at least 0 and finite");
  }
  std::vector<LinkBody> bodies;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    std::optional<TriangleMesh> mesh = link_mesh(robot.links[i], options);
    if (!mesh) continue;
    mesh->vertex_error = add_up(mesh->vertex_error, padding);
    bodies.push_back(
        {.link = static_cast<int>(i), .mesh = std::make_shared<const SolidMesh>(*mesh)});
  }
  return bodies;
}

}  // namespace spherule
