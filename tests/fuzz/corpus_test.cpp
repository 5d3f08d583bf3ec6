// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets do with their seeds, and with some mutants of them in every run: coverage
// guides the search in tests/fuzz/run only.
#include "base/error.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <ostream>
#include <set>
#include <string>
#include <string_view>

namespace spherule::test {

void PrintTo(const FuzzTarget& target, std::ostream* out) {
  *out << target.name;
}

namespace {

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {
 protected:
  // Whether the bytes were read rather than refused, with a reason.
  bool reads(const std::string& bytes) {
    std::filesystem::remove(file_);
    folder_.write(file_.filename().string(), GetParam().file_of(bytes));
    try {
      GetParam().read(file_);
      return true;
    } catch (const Error& error) {
      EXPECT_FALSE(error.subject().empty() || error.reason().empty()) << error.what();
      if (is_mesh()) {
        EXPECT_EQ(error.subject(), file_.string());
      }
      return false;
    }
  }

 private:
  static bool is_mesh() {
    static const std::set<std::string_view> kMeshes = {"stl", "obj",  "ply", "off",      "3mf",
                                                       "dae", "gltf", "glb", "3mf_model"};
    return kMeshes.contains(GetParam().name);
  }

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
    for (int i = 0; i < effort(400, 40); ++i) {
      const std::string_view alphabet = i % 2 == 0 ? "" : "0123456789-.e ";
      refused += reads(mutated(seed, random, alphabet)) ? 0 : 1;
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
