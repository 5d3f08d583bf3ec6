// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/measure.h"
#include "bench/paper/representations.h"
#include "bench/workload.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// Of some of the queries.
struct Table1Cells {
  std::size_t queries = 0;
  VerdictCount count = {};  // against the original solids
  double seconds = 0.0;     // for all of them
  double ratio = 0.0;       // of the first row's time
};

struct Table1Row {
  std::string method;
  std::string complexity;
  bool is_conservative = false;
  Table1Cells whole;
  Table1Cells critical;  // the torch at the seams
  std::optional<PaperRow> paper;
};

// Times them in alternating rounds in the program's order and judges their verdicts by the
// original solids.
std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options);

void print_table1(const std::vector<Table1Row>& rows);

}  // namespace spherule
