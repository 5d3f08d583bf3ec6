// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace spherule {

// Whether a report lists the external spheres, often a hundred thousand.
enum class ReportContent { kNoExternalSpheres, kAll };

// Adds the option --external-spheres, which requires all.
void add_external_spheres_flag(CLI::App& command, ReportContent& content);

}  // namespace spherule
