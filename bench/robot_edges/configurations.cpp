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

void ConfigurationTimes::print_head() {
  std::printf(
      "\none configuration: ns one a call; times as long as that: many a call, confirmed, the "
      "flat\n"
      "scan, FCL; of all configurations in contact by FCL or with an obstacle inside of a link, "
      "missed, extra, and extra confirmed\n"
      "| scene, order | ns | many | confirmed | flat | OBBRSS | OBB | contact | missed | extra | "
      "confirmed: missed | extra |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void ConfigurationTimes::print(const char* name) const {
  const auto count = static_cast<double>(single.free.size());
  const double own = single.median_ns();
  const auto times = [&](const ConfigurationRow& row) {
    return row.is_asked() ? row.median_ns() / own : 0.0;
  };
  std::size_t contact = 0, missed = 0, extra = 0, confirmed_missed = 0, confirmed_extra = 0;
  for (std::size_t i = 0; i < single.free.size(); ++i) {
    const bool is_contact = truth[i] == 0;
    contact += is_contact ? 1 : 0;
    missed += is_contact && single.free[i] != 0 ? 1 : 0;
    extra += !is_contact && single.free[i] == 0 ? 1 : 0;
    confirmed_missed += is_contact && confirmed.free[i] != 0 ? 1 : 0;
    confirmed_extra += !is_contact && confirmed.free[i] == 0 ? 1 : 0;
  }
  std::printf(
      "| %-16s | %6.0f | %4.2f | %5.2f | %5.1f | %6.1f | %6.1f | %5zu | %zu | %4zu | %zu | "
      "%zu |\n",
      name, own / count, times(batch), times(confirmed), times(flat), times(obbrss), times(obb),
      contact, missed, extra, confirmed_missed, confirmed_extra);
}

}  // namespace spherule
