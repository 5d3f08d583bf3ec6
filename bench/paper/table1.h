// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/measure.h"
#include "bench/workload.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// What the paper's table says of a method.
struct PaperRow {
  std::string complexity;
  std::size_t collisions = 0;
  double seconds = 0.0;
};

// A way to represent the work cell, as an engine.
struct Representation {
  std::string method;      // its name in paper.json
  std::string complexity;  // of the workpiece; of everything where everything is simplified
  bool is_conservative = false;
  std::unique_ptr<Checker> checker;
  std::optional<PaperRow> paper = {};
};

// Of some of the queries.
struct Table1Cells {
  std::size_t queries = 0;
  std::size_t collisions = 0;
  std::size_t missed = 0;  // the original solids touch, the representation is free
  std::size_t extra = 0;   // the reverse
  double seconds = 0.0;    // for all of them
  double ratio = 0.0;      // of the first row's time
};

struct Table1Row {
  std::string method;
  std::string complexity;
  bool is_conservative = false;
  Table1Cells whole;
  Table1Cells critical;  // the torch at the seams
  std::optional<PaperRow> paper;
};

// The rows that can be made of a fitted workload: the original meshes first, then the workpiece in
// spheres, by the paper's loop and by ours, against robot and torch as meshes, and all in spheres.
std::vector<Representation> make_representations(const Workload& workload);

// Times them in alternating rounds in the program's order and judges their verdicts by the
// original solids.
std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options);

void print_table1(const std::vector<Table1Row>& rows);

}  // namespace spherule
