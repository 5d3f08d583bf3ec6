// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/in_file.h"

#include <filesystem>
#include <system_error>

namespace spherule {

bool names_its_place(const Error& error) {
  const std::string& subject = error.subject();
  std::error_code fault;
  return subject.starts_with("--") || subject.find('/') != std::string::npos ||
         std::filesystem::exists(subject, fault);
}

}  // namespace spherule
