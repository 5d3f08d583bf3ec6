// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/soak_record.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace spherule {

// What all chunks of a soak depend on.
struct SoakSettings {
  std::uint64_t seed = 1;
  double scale = 1.0;  // share of the whole soak
};

// The chunks that are done, in a file of one line each behind a line of the settings. A process
// that ends while it writes leaves a piece of a line, which is taken off by the next one.
class SoakState {
 public:
  // Begins the file anew, or with `resume` goes on with it, if there is one. Throws Error if it has
  // other settings.
  SoakState(const std::filesystem::path& file, const SoakSettings& settings, bool resume);

  const SoakSettings& settings() const { return settings_; }
  const SoakRecord* find(const std::string& question, std::uint64_t chunk) const;
  void add(const SoakRecord& record);

  using Records = std::map<std::pair<std::string, std::uint64_t>, SoakRecord>;
  const Records& records() const { return records_; }

 private:
  void read();
  void append(const std::string& line) const;

  std::filesystem::path file_;
  SoakSettings settings_;
  Records records_;
};

}  // namespace spherule
