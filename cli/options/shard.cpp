// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/shard.h"

#include "base/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

namespace spherule {
namespace {

constexpr std::int64_t kMostShards = 1'000'000;

std::optional<Shard> shard_in(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos) return std::nullopt;
  const std::optional<std::int64_t> index = internal::whole_number(text.substr(0, slash));
  const std::optional<std::int64_t> of = internal::whole_number(text.substr(slash + 1));
  if (!index || !of || *index < 1 || *index > *of || *of > kMostShards) return std::nullopt;
  return Shard{static_cast<std::size_t>(*index), static_cast<std::size_t>(*of)};
}

}  // namespace

ShardRange range_of(const Shard& shard, std::size_t count) {
  // As many as fit in each, and one more in the first ones.
  const std::size_t least = count / shard.of;
  const std::size_t more = count % shard.of;
  const std::size_t before = shard.index - 1;
  return {before * least + std::min(before, more), least + (before < more ? 1 : 0)};
}

bool is_dealt_to(const Shard& shard, std::size_t thing) {
  return thing % shard.of == shard.index - 1;
}

CLI::Option* add_shard_option(CLI::App& command, const std::string& help, Shard& shard) {
  return command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = *shard_in(text); }, help)
      ->check([](const std::string& text) {
        return shard_in(text) ? "" : "'" + text + "' is no shard: I/N with 1 <= I <= N, 3/8 say";
      })
      ->type_name("I/N");
}

}  // namespace spherule
