// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/progress.h"
#include "robot/cover/robot_spheres.h"

#include <set>
#include <span>
#include <string>

namespace spherule {

// The warnings about the links of a robot that is covered or audited, each once on standard error:
// doubts about sizes before the long work, in which a search for a goal covers links again and
// again, and the rest after it. What follows the figures in brackets, "open (8 edges): ...",
// explains them, and is printed for the first link of which the same is said.
class LinkWarnings {
 public:
  // For the field of that name in the options; refers to this and the bar.
  decltype(RobotCoverOptions::on_doubt) on_doubt(ProgressBar& bar);

  // Those of a link that were not printed before.
  void print(const std::string& link, std::span<const std::string> warnings);

 private:
  void print(const std::string& link, const std::string& warning);

  std::set<std::string> printed_;
  std::set<std::string> explained_;
};

}  // namespace spherule
