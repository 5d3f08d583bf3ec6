// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets do with their seeds, and with some mutants of them in every run: coverage
// guides the search in tests/fuzz/run only.
#include "base/error.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

namespace spherule::test {

void PrintTo(const FuzzTarget& target, std::ostream* out) {
  *out << target.name;
}

namespace {

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {
 protected:
  // Whether the bytes were read rather than refused.
  bool reads(const std::string& bytes) {
    std::filesystem::remove(file_);
    folder_.write(file_.filename().string(), GetParam().file_of(bytes));
    try {
      GetParam().read(file_);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

 private:
  TempDir folder_;
  std::filesystem::path file_ = folder_.path() / ("input" + std::string(GetParam().extension));
};

TEST_P(FuzzCorpus, SeedsAreRead) {
  for (const std::string& seed : GetParam().seeds()) EXPECT_TRUE(reads(seed)) << seed;
}

TEST_P(FuzzCorpus, MutantsAreReadOrRefused) {
  Random random(23);
  int refused = 0;
  for (const std::string& seed : GetParam().seeds()) {
    for (int i = 0; i < effort(100, 20); ++i) {
      std::string mutant = seed;
      for (std::size_t edits = 1 + random.index(3); edits > 0 && !mutant.empty(); --edits) {
        const std::size_t at = random.index(mutant.size());
        switch (random.index(4)) {
          case 0:
            mutant[at] = static_cast<char>(random.index(256));
            break;
          case 1:
            mutant.erase(at, 1 + random.index(16));
            break;
          case 2:
            mutant.insert(at, mutant.substr(random.index(mutant.size()), random.index(40)));
            break;
          default:
            mutant[at] = "0123456789-.e "[random.index(14)];
        }
      }
      refused += reads(mutant) ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(, FuzzCorpus,
                         testing::ValuesIn(fuzz_targets().begin(), fuzz_targets().end()),
                         [](const testing::TestParamInfo<FuzzTarget>& target) {
                           return std::string(target.param.name);
                         });

}  // namespace
}  // namespace spherule::test
