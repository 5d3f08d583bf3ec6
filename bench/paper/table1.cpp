// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/table1.h"

#include "bench/oracle.h"

#include <cstdint>
#include <cstdio>
#include <utility>

namespace spherule {
namespace {

// Of the chosen queries.
Table1Cells cells(const std::vector<std::uint8_t>& verdicts, const std::vector<std::uint8_t>& truth,
                  double ns_per_query) {
  return {.queries = truth.size(),
          .count = count(verdicts, truth),
          .seconds = 1e-9 * ns_per_query * static_cast<double>(truth.size())};
}

}  // namespace

std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options) {
  const auto touching = Oracle(workload).touching_bodies(workload.program);
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t bodies : touching) truth.push_back(bodies != 0 ? 1 : 0);
  std::vector<ArmPositions> critical;
  std::vector<std::uint8_t> critical_truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (workload.is_critical[i] == 0) continue;
    critical.push_back(workload.program[i]);
    critical_truth.push_back(truth[i]);
  }
  std::vector<Table1Row> rows;
  std::vector<Method> methods;
  for (Representation& of : representations) {
    rows.push_back({of.method, of.complexity, of.is_conservative, {}, {}, of.paper});
    methods.push_back({of.method, of.complexity, std::move(of.checker), 0, false});
  }
  const std::vector<Measurement> whole = measure(methods, workload.program, options);
  const std::vector<Measurement> of_critical = measure(methods, critical, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].whole = cells(whole[i].verdicts, truth, whole[i].ns_per_query);
    rows[i].critical = cells(of_critical[i].verdicts, critical_truth, of_critical[i].ns_per_query);
    rows[i].whole.ratio = rows.front().whole.seconds / rows[i].whole.seconds;
    rows[i].critical.ratio = rows.front().critical.seconds / rows[i].critical.seconds;
  }
  return rows;
}

void print_table1(const std::vector<Table1Row>& rows) {
  std::printf("\nTable I (in brackets: the critical section; at the right: the paper's row)\n");
  std::printf("%-16s %-16s %16s %14s %14s %20s %18s | %-16s %6s %8s %6s\n", "method", "complexity",
              "collisions", "missed", "extra", "ms", "ratio", "paper", "coll.", "s", "ratio");
  for (const Table1Row& row : rows) {
    std::printf("%-16s %-16s %7zu (%6zu) %5zu (%5zu) %5zu (%5zu) %9.3f (%8.3f) %8.1f (%6.1f) |",
                row.method.c_str(), row.complexity.c_str(), row.whole.count.collisions,
                row.critical.count.collisions, row.whole.count.missed, row.critical.count.missed,
                row.whole.count.extra, row.critical.count.extra, 1e3 * row.whole.seconds,
                1e3 * row.critical.seconds, row.whole.ratio, row.critical.ratio);
    if (row.paper) {
      std::printf(" %-16s %6zu %8.0f %6.1f", row.paper->complexity.c_str(), row.paper->collisions,
                  row.paper->seconds, rows.front().paper->seconds / row.paper->seconds);
    }
    std::printf("\n");
  }
}

}  // namespace spherule
