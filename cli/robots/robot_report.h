// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/robots/robot_false_alarms.h"
#include "cli/text/json.h"
#include "robot/cover/robot_spheres.h"

#include <string>

namespace spherule {

// What covering a robot came to, beside the spheres themselves: options, and a link the triangles,
// spheres, certificate, warnings and seconds; lengths in metres. `seconds` is for all of it.
Json robot_summary(const std::string& urdf, const RobotCover& cover, double seconds);

// What NAME.report.json holds: the summary, and of each link the simplified solid.
Json robot_report(const Json& summary, const RobotCover& cover, ReportContent content);

// The same as a table for a person, lengths in millimetres.
std::string robot_table(const RobotCover& cover, double seconds);

// The false alarms of a cover, for the summary; null if none were counted. Lengths in metres.
Json false_alarm_summary(const MeasuredCover& measured, const RobotModel& robot);

// The same for a person, with the pairs that refuse most and what would mend them; empty if none
// were counted. Lengths in millimetres.
std::string describe_false_alarms(const MeasuredCover& measured, const RobotModel& robot);

}  // namespace spherule
