// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_bodies.h"

#include "collide/solid_mesh.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

namespace spherule {

std::optional<LinkBody> link_body(const RobotDescription& robot, int link,
                                  const LinkMeshOptions& options, double padding) {
  if (!(padding >= 0.0) || !std::isfinite(padding)) {
    throw Error("padding", "must be at least 0 and finite");
  }
  std::optional<TriangleMesh> mesh =
      link_mesh(robot.links.at(static_cast<std::size_t>(link)), options);
  if (!mesh) return std::nullopt;
  mesh->vertex_error = add_up(mesh->vertex_error, padding);
  return LinkBody{.link = link, .mesh = std::make_shared<const SolidMesh>(*mesh)};
}

std::vector<LinkBody> link_bodies(const RobotDescription& robot, const LinkMeshOptions& options,
                                  double padding) {
  std::vector<LinkBody> bodies;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link) {
    if (auto body = link_body(robot, link, options, padding)) bodies.push_back(std::move(*body));
  }
  return bodies;
}

}  // namespace spherule
