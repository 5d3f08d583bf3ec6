// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/output.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/files/interruption.h"

#include <set>
#include <system_error>

namespace spherule {
namespace {

namespace fs = std::filesystem;

fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = absolute_path(path);
  const fs::path place = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : place;
}

}  // namespace

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  std::set<fs::path> taken;
  for (const fs::path& input : inputs) {
    if (!input.empty()) taken.insert(place_of(input));
  }
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    std::error_code error;
    const fs::path folder = absolute_path(output).parent_path();
    if (!fs::is_directory(folder, error))
      throw Error(output.string(), "no such folder; make it first");
    if (fs::is_directory(output, error)) throw Error(output.string(), "is a folder");
    write_uninterrupted([&] { check_writable(output); });
    if (!taken.insert(place_of(written_file(output))).second) {
      throw Error(output.string(), "is named twice, as input or output");
    }
  }
}

std::string default_output(const fs::path& input, const char* ending, FileKind kind) {
  std::string output = input.filename().replace_extension(ending).string();
  std::error_code error;
  if (fs::exists(output, error) && recognize(output) != kind) {
    throw Error(output, "is there already, and is something else; name another place (--output)");
  }
  return output;
}

}  // namespace spherule
