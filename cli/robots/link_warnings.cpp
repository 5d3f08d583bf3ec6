// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/link_warnings.h"

#include "cli/text/message.h"

namespace spherule {

decltype(RobotCoverOptions::on_doubt) LinkWarnings::on_doubt(ProgressBar& bar) {
  return [this, &bar](const std::string& link, const std::string& doubt) {
    bar.clear();
    print(link, doubt);
  };
}

void LinkWarnings::print(const LinkCover& link) {
  for (const std::string& warning : link.warnings) print(link.link, warning);
}

void LinkWarnings::print(const std::string& link, const std::string& warning) {
  const auto [line, is_new] = printed_.insert("link " + link + ": " + warning);
  if (is_new) warn(*line);
}

}  // namespace spherule
