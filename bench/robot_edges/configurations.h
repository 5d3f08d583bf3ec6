// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace spherule {

// What one method says of configurations, and how long each round took.
struct ConfigurationRow {
  std::vector<std::uint8_t> free;
  std::vector<double> rounds_ns{};

  void take(double ns) { rounds_ns.push_back(ns); }
  double median_ns() const;
  bool is_asked() const { return !rounds_ns.empty(); }
};

struct ConfigurationTimes {
  explicit ConfigurationTimes(std::size_t count)
      : single{std::vector<std::uint8_t>(count)},
        batch(single),
        confirmed(single),
        flat(single),
        truth(count) {}

  // Of another library.
  struct Peer {
    std::string name;
    ConfigurationRow row;
  };

  ConfigurationRow single, batch, confirmed, flat;
  std::vector<Peer> peers{};
  std::vector<std::uint8_t> truth;  // 1: free, by FCL and by points in solids

  // A row of the table: ns a configuration, times as long as single calls, and verdicts.
  void print(const char* name) const;
  void print_head() const;
};

}  // namespace spherule
