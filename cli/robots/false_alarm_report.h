// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/robots/robot_false_alarms.h"
#include "cli/text/json.h"

#include <string>

namespace spherule {

// The false alarms of a cover, for the summary; null if none were counted. Lengths in metres.
Json false_alarm_summary(const MeasuredCover& measured, const RobotModel& robot);

// The same for a person, with the pairs that refuse most and what would mend them; empty if none
// were counted. Lengths in millimetres.
std::string describe_false_alarms(const MeasuredCover& measured, const RobotModel& robot);

}  // namespace spherule
