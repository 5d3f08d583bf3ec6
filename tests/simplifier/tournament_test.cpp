// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/search/cover_search.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::test::tournament_test {
namespace {

using internal::Tournament;

// By a look at all of them.
std::uint32_t least_of(const std::vector<std::uint64_t>& keys, std::uint32_t except) {
  std::uint32_t best = Tournament::kNone;
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    if (i != except && (best == Tournament::kNone || keys[i] < keys[best])) best = i;
  }
  return best;
}

// Items come at the end, go with the last taking their place, and change, several between two
// questions; few keys make many ties.
TEST(Tournament, FindsWhatALookAtAllFinds) {
  Random random(1);
  for (const std::size_t most : {1U, 3U, 64U, 65U, 1000U}) {
    std::vector<std::uint64_t> keys;
    Tournament tournament;
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
      EXPECT_LT(a, keys.size());
      EXPECT_LT(b, keys.size());
      return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    };
    bool was_full = false;
    for (int question = 0; question < 2000; ++question) {
      was_full = was_full || keys.size() == most;
      for (std::size_t change = random.index(12); change > 0; --change) {
        const std::size_t what = random.index(4);
        if ((what == 0 || (what == 2 && !was_full)) && keys.size() < most) {
          keys.push_back(random.index(50));
          tournament.touch(static_cast<std::uint32_t>(keys.size() - 1));
        } else if (what == 1 && !keys.empty()) {
          const std::size_t gone = random.index(keys.size());
          keys[gone] = keys.back();
          keys.pop_back();
          tournament.touch(static_cast<std::uint32_t>(gone));
          tournament.touch(static_cast<std::uint32_t>(keys.size()));
        } else if (!keys.empty()) {
          const std::size_t changed = random.index(keys.size());
          keys[changed] = random.index(50);
          tournament.touch(static_cast<std::uint32_t>(changed));
        }
      }
      const std::uint32_t except = random.index(3) == 0 || keys.empty()
                                       ? Tournament::kNone
                                       : static_cast<std::uint32_t>(random.index(keys.size()));
      ASSERT_EQ(tournament.least(static_cast<std::uint32_t>(keys.size()), except, less),
                least_of(keys, except));
    }
    EXPECT_TRUE(was_full);
  }
}

}  // namespace
}  // namespace spherule::test::tournament_test
