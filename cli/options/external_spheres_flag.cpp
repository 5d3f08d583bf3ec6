// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/external_spheres_flag.h"

#include <CLI/CLI.hpp>

namespace spherule {

void add_external_spheres_flag(CLI::App& command, ReportContent& content) {
  command.add_flag_callback(
      "--external-spheres", [&content] { content = ReportContent::kAll; },
      "List every external sphere in the report, about 100 bytes each: for view, and for who "
      "wants to check what was simplified away");
}

}  // namespace spherule
