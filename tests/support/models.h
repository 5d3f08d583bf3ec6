// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace spherule::test {

// The folder of real models that the environment variable SPHERULE_MODELS names, if any.
inline std::optional<std::filesystem::path> models_dir() {
  const char* name = std::getenv("SPHERULE_MODELS");
  if (name == nullptr || *name == '\0') return std::nullopt;
  return std::filesystem::path(name);
}

}  // namespace spherule::test
