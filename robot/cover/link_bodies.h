// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What the links of a robot are made of, for proofs about pairs of them.
//
// @code{.cpp}
// #include <spherule/robot/cover/link_bodies.h>
// #include <cassert>
//
// spherule::RobotDescription robot{.name = "post", .model = spherule::RobotModel("base")};
// const spherule::Primitive box = spherule::Box{.size = {0.1, 0.1, 0.2}};
// robot.links = {{.name = "base", .collision = {{.name = "post", .geometry = box}}}};
// const std::vector<spherule::LinkBody> bodies = spherule::link_bodies(robot);
// assert(bodies.size() == 1 && bodies[0].mesh->has_inside());
// @endcode

#include "robot/cover/link_mesh.h"
#include "robot/model/robot_description.h"
#include "robot/pairs/link_pairs.h"

#include <optional>
#include <vector>

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
