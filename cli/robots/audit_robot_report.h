// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/robots/pair_kinds.h"
#include "cli/text/json.h"
#include "robot/cover/audit_robot.h"
#include "robot/formats/sphere_formats.h"

#include <string>

namespace spherule {

// What `audit-robot` found, and what it did where it mended. Lengths in metres.
struct RobotAuditReport {
  SphereFormatFile file;
  RobotAudit audit;
  std::string repaired_file;  // where the mended spheres went; empty if nowhere
  std::optional<RobotRepair> repair;
  std::optional<PairKinds> pairs;  // if they were requested
};

// A table of the links, the configurations, the repair and the pairs of links, lengths in
// millimetres.
std::string audit_table(const RobotAuditReport& report);

Json audit_json(const RobotAuditReport& report);

}  // namespace spherule
