// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"

namespace CLI {
class App;
}

namespace spherule {

// Adds the option --external-spheres, which requires all.
void add_external_spheres_flag(CLI::App& command, ReportContent& content);

}  // namespace spherule
