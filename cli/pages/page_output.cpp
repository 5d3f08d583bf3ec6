// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/page_output.h"

#include "base/files.h"
#include "cli/files/interruption.h"
#include "cli/text/message.h"

#include <filesystem>

namespace spherule {

void write_page(const std::string& page, const ViewScene& scene) {
  const std::string text = make_view_page(scene);
  write_uninterrupted([&] { write_file_atomically(page, text); });
}

std::string page_line(const std::string& page) {
  return "page: " + one_line(page) + " (" +
         std::to_string(std::filesystem::file_size(page) / 1024) + " KiB); open it in a browser\n";
}

}  // namespace spherule
