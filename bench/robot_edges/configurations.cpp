// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/configurations.h"

#include "bench/clock.h"

#include <algorithm>
#include <cstdio>

namespace spherule {

double ConfigurationRow::median_ns() const {
  std::vector<double> sorted = rounds_ns;
  std::sort(sorted.begin(), sorted.end());
  return quantile(sorted, 0.5);
}

void ConfigurationTimes::print_head() const {
  std::printf(
      "\none configuration: ns in single calls; times as long as that: in batches, confirmed, the "
      "flat\n"
      "scan, other libraries; of all configurations in contact by FCL or with an obstacle inside "
      "of a link, missed / extra\n"
      "| scene, order | ns | many | confirmed | flat |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf(" contact | missed / extra | confirmed |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < 2 * peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void ConfigurationTimes::print(const char* name) const {
  const auto count = static_cast<double>(single.free.size());
  const double own = single.median_ns();
  const auto print_time = [&](const ConfigurationRow& row) {
    if (row.is_asked()) {
      std::printf(" %5.2f |", row.median_ns() / own);
    } else {
      std::printf(" - |");
    }
  };
  const auto print_verdicts = [&](const ConfigurationRow& row) {
    std::size_t missed = 0, extra = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      missed += truth[i] == 0 && row.free[i] != 0 ? 1 : 0;
      extra += truth[i] != 0 && row.free[i] == 0 ? 1 : 0;
    }
    std::printf(" %zu / %zu |", missed, extra);
  };
  std::printf("| %-16s | %6.0f |", name, own / count);
  for (const ConfigurationRow* row : {&batch, &confirmed, &flat}) print_time(*row);
  for (const Peer& peer : peers) print_time(peer.row);
  std::printf(" %5zu |", static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0)));
  for (const ConfigurationRow* row : {&single, &confirmed}) print_verdicts(*row);
  for (const Peer& peer : peers) print_verdicts(peer.row);
  std::printf("\n");
}

}  // namespace spherule
