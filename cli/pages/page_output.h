// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/pages/view_page.h"

#include <string>

namespace spherule {

// Writes the page of `view` that shows a scene.
void write_page(const std::string& page, const ViewScene& scene);

// "page: FILE (N KiB); open it in a browser", for a person.
std::string page_line(const std::string& page);

}  // namespace spherule
