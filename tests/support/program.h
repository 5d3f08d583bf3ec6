// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What the programs of bench/ have in common.

#include "base/error.h"
#include "base/text.h"
#include "tests/support/models.h"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace spherule {

// What `run` returns; 1 if it throws, and then standard error says why.
template <class Run>
int run_program(const char* name, const Run& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
}

// The numbers of a command line. Throw Error, naming the option, unless they are from `least` to
// `most`.
inline double number_argument(const std::string& option, std::string_view text, double least,
                              double most) {
  const std::optional<double> value = internal::finite_number(text);
  if (!value || !(*value >= least && *value <= most)) {
    throw Error(option, internal::in_quotes(text) + " is not a number in its range");
  }
  return *value;
}

inline std::int64_t count_argument(const std::string& option, std::string_view text,
                                   std::int64_t least, std::int64_t most = INT32_MAX) {
  const std::optional<std::int64_t> value = internal::whole_number(text);
  if (!value || *value < least || *value > most) {
    throw Error(option, internal::in_quotes(text) + " is not a whole number from " +
                            std::to_string(least) + " to " + std::to_string(most));
  }
  return *value;
}

// The folder of real models that SPHERULE_MODELS names, or nothing.
inline std::optional<std::filesystem::path> models_folder() {
  return test::models_dir();
}

// The same where there has to be one.
inline std::filesystem::path needed_models_folder() {
  const std::optional<std::filesystem::path> folder = models_folder();
  if (!folder) throw Error("SPHERULE_MODELS", "does not name a folder of models");
  return *folder;
}

}  // namespace spherule
