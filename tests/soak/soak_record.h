// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/tally.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// What a chunk of a question came to; the sums of a table are of the same form.
struct SoakRecord {
  std::string question;
  std::uint64_t chunk = 0;
  std::uint64_t cases = 0;
  std::uint64_t answers = 0;  // a case may be queried in several ways
  std::uint64_t near = 0;     // of the answers; of kills: while a file was being written
  std::uint64_t missed = 0;
  std::uint64_t crossed = 0;
  std::uint64_t other = 0;
  std::uint64_t extra = 0;
  std::uint64_t uncertain = 0;
  double worst_slack = 0.0;
  double seconds = 0.0;  // of a processor
  bool is_last = false;  // of a question whose number of chunks is not known before
  std::vector<std::string> faults{};

  bool is_clean() const { return missed == 0 && crossed == 0 && other == 0; }
  void add_fault(const std::string& what);
  // Adds its numbers and faults.
  void add(const SoakRecord& record);
};

SoakRecord record_of(const SoakReport& report, std::uint64_t cases);

// A line of JSON. The latter throws Error, naming `place`, if it is none of these.
std::string encode_record(const SoakRecord& record);
SoakRecord decode_record(std::string_view line, const std::string& place);

}  // namespace spherule
