// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/checker_rows.h"

#include <utility>

namespace spherule {

std::vector<CheckerRows> add_checker_rows(const std::string& name, SoakReport& report) {
  std::vector<CheckerRows> rows;
  for (const auto& [set, its_name] :
       {std::pair(InstructionSet::kPortable, "portable"), std::pair(InstructionSet::kAvx2, "avx2"),
        std::pair(InstructionSet::kAvx512, "avx512")}) {
    if (!is_available(set)) continue;
    const std::string row = name + ", " + its_name;
    Tally& single = report.add(row + ", single");
    rows.push_back({set, &single, &report.add(row + ", batch")});
  }
  return rows;
}

}  // namespace spherule
