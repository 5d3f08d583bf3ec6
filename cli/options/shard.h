// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spherule {

// The part of a command's work that one of several processes does: the index-th of `of`, from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t of = 1;
};

// Things in a row, `first` the index of the first one.
struct ShardRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

// Those of a shard of `count` things: shards follow one another, each thing is in one of them, and
// their sizes differ by one at most.
ShardRange range_of(const Shard& shard, std::size_t count);

// Whether a thing is among those that a shard takes where neighbours cost alike: every `of`-th.
bool is_dealt_to(const Shard& shard, std::size_t thing);

// Adds --shard I/N, whose help says what is divided.
CLI::Option* add_shard_option(CLI::App& command, const std::string& help, Shard& shard);

}  // namespace spherule
