// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/sealed_content.h"

#include "base/crc64.h"
#include "tests/support/mesh_files.h"

#include <cstdint>

namespace spherule::test {

std::string with_checksum(std::string_view content) {
  std::string file(content);
  const std::uint64_t sum = crc64(content);
  for (int k = 0; k < 8; ++k) file.push_back(static_cast<char>(sum >> (8 * k) & 0xFFU));
  return file;
}

std::string without_checksum(std::string_view file) {
  return std::string(file.substr(0, file.size() - 8));
}

std::string threemf_around(std::string_view model) {
  return threemf_bytes(std::string(model));
}

}  // namespace spherule::test
