// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/link_warnings.h"

#include "cli/text/message.h"

#include <cstddef>

namespace spherule {

decltype(RobotCoverOptions::on_doubt) LinkWarnings::on_doubt(ProgressBar& bar) {
  return [this, &bar](const std::string& link, const std::string& doubt) {
    bar.clear();
    print(link, doubt);
  };
}

void LinkWarnings::print(const std::string& link, std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) print(link, warning);
}

void LinkWarnings::print(const std::string& link, const std::string& warning) {
  const std::string subject = "link " + link + ": ";
  if (!printed_.insert(subject + warning).second) return;
  const std::size_t end_of_figures = warning.find("): ");
  const bool is_explained = end_of_figures != std::string::npos &&
                            !explained_.insert(warning.substr(0, warning.find(" ("))).second;
  warn(subject + (is_explained ? warning.substr(0, end_of_figures + 1) : warning));
}

}  // namespace spherule
