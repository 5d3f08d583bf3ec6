// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/parsing/input_file.h"

#include "spheretree/atomic_file.h"
#include "spheretree/error.h"

#include <cctype>
#include <system_error>

namespace spherule::internal {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string read_regular_file(const std::filesystem::path& path) {
  const std::string subject = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw Error(subject, "no such file");
  if (error) throw Error(subject, error.message());
  if (std::filesystem::is_directory(status)) throw Error(subject, "is a directory");
  require_regular_file(path);
  std::string bytes = read_file(path);
  if (bytes.empty()) throw Error(subject, "the file is empty");
  return bytes;
}

}  // namespace spherule::internal
