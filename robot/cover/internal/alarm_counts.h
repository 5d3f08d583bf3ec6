// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/internal/alarm_sample.h"

namespace spherule::internal {

// Adds what was counted in other postures of the same robot, by the same options.
void add(const FalseAlarms& other, FalseAlarms& sum);

// What spheres do to a sample.
FalseAlarms count_alarms(const AlarmJudge& judge, const AlarmSample& sample, const LinkTrees& trees,
                         const FalseAlarmOptions& options);

}  // namespace spherule::internal
