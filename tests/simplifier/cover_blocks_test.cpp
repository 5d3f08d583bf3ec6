// SPDX-License-Identifier: BSD-3-Clause
// Large solids are covered block by block; here blocks are small, so that small solids have some.
#include "simplifier/stage2/cover_blocks.h"

#include "geometry/mesh_distance.h"
#include "simplifier/internal/stages.h"
#include "simplifier/stage2/cover_fitter.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/sphere_hash.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <stop_token>
#include <vector>

namespace spherule::test::cover_blocks_test {
namespace {

using internal::CoverBlocks;
using internal::CoverFitter;

class Blocks : public testing::Test {
 protected:
  Blocks() : mesh_(l_bracket()) {
    options_.effort = 0;
    set_error((kSanitized ? 0.1 : 0.05) * diagonal_of(mesh_));
  }

  void set_error(double max_error) {
    options_.max_error = max_error;
    external_ = place_external_spheres(mesh_, {.min_external_diameter = 4.0 * options_.max_error,
                                               .max_error = options_.max_error});
  }

  // In about so many blocks.
  std::vector<Sphere> covered(std::size_t blocks) const {
    const MeshDistance distance(mesh_);
    const internal::Clearance clearance(external_);
    CoverFitter fitter(clearance, distance, options_);
    const std::size_t count = fitter.divided().size();
    return CoverBlocks(clearance, distance, options_, fitter.divided().boxes(), {},
                       count / blocks + 1)
        .run();
  }

  void expect_proved(const std::vector<Sphere>& spheres) const {
    CertifyOptions options{.external = &external_, .zones = options_.zones, .volume = false};
    options.resolution = proof_resolution(options_.max_error, diagonal_of(mesh_));
    options.protrusion_tolerance = 0.0;
    const Certificate certificate = certify(mesh_, spheres, options);
    EXPECT_TRUE(certificate.covered);
    EXPECT_LE(certificate.protrusion_over_simplified_max, options_.max_error);
    for (std::size_t i = 0; i < options_.zones.size(); ++i) {
      EXPECT_LE(certificate.protrusion_in_zones[i], options_.zones[i].max_error);
    }
  }

  TriangleMesh mesh_;
  ExternalSpheres external_;
  CoverOptions options_;
};

TEST_F(Blocks, CoverS) {
  for (const std::size_t blocks : {2U, 30U}) {
    SCOPED_TRACE(blocks);
    expect_proved(covered(blocks));
  }
}

// A block covers what its spheres meet beyond it, too, before they are replaced.
TEST_F(Blocks, CoverSAfterASearchWithNoMoreSpheres) {
  for (const std::size_t blocks : effort(std::vector<std::size_t>{3, 30}, 1)) {
    SCOPED_TRACE(blocks);
    options_.effort = 0;
    options_.on_proved = {};
    const std::size_t first = covered(blocks).size();
    std::vector<std::size_t> counts;
    options_.effort = effort(4, 2);
    options_.on_proved = [&](std::size_t count) { counts.push_back(count); };
    const std::vector<Sphere> searched = covered(blocks);
    expect_proved(searched);
    ASSERT_FALSE(counts.empty());
    EXPECT_EQ(counts.front(), first);
    EXPECT_EQ(counts.back(), searched.size());
    EXPECT_TRUE(std::ranges::is_sorted(counts, std::greater<>()));
    if (!kSanitized) {
      EXPECT_LT(searched.size(), first);
    }
  }
}

TEST_F(Blocks, TakeFewMoreSpheresThanOneSearch) {
  const auto whole = static_cast<double>(covered(1).size());
  // Seams, and what chance does with the few spheres of a coarse cover.
  EXPECT_LE(static_cast<double>(covered(3).size()), 1.2 * whole + 5.0);
}

// Equal bits on every machine and any number of threads (G7).
TEST_F(Blocks, AreEqualEverywhere) {
  set_error(0.1 * diagonal_of(mesh_));
  options_.effort = 2;
  const auto on = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return covered(9); });
  };
  EXPECT_EQ(on(1), on(4));
  EXPECT_EQ(hash_of(on(1)), 0xca11962f3252bf80U);
}

TEST_F(Blocks, KeepZonesOfTheirOwnError) {
  options_.zones = {{.shape = Sphere{mesh_.vertices.front(), 2.0 * options_.max_error},
                     .max_error = 0.5 * options_.max_error}};
  const std::vector<Sphere> spheres = covered(4);
  expect_proved(spheres);
}

TEST_F(Blocks, StopAfterTheFirstAnswerAtTheEarliest) {
  const std::vector<Sphere> first = covered(6);
  std::stop_source stop;
  options_.stop = stop.get_token();
  options_.effort = 1000000;
  options_.on_proved = [&](std::size_t) { stop.request_stop(); };
  EXPECT_EQ(covered(6), first);
  options_.on_proved = {};
  EXPECT_EQ(covered(6), first);
}

TEST_F(Blocks, KeepToTheSecondsOfASearch) {
  const std::vector<Sphere> first = covered(6);
  options_.effort = 1000000;
  options_.seconds = 1e-3;
  EXPECT_EQ(covered(6), first);
}

// Of cover(), where there are more cells than it is told.
TEST_F(Blocks, AreUsedForSolidsOfManyCells) {
  const MeshDistance distance(mesh_);
  const internal::Clearance clearance(external_);
  options_.lower_bound = true;
  const SphereCover in_blocks = internal::cover(mesh_, distance, clearance, options_, 1000);
  expect_proved(in_blocks.spheres);
  EXPECT_EQ(in_blocks.spheres, covered(1));
  EXPECT_EQ(in_blocks.lower_bound, 0U);
}

// One that nothing is left to cover for: the spheres are larger than the blocks.
TEST_F(Blocks, MayNeedNoSpheres) {
  options_.min_radius = 0.3 * diagonal_of(mesh_);
  options_.effort = 1;
  const std::vector<Sphere> spheres = covered(30);
  EXPECT_LT(spheres.size(), 15U);
  const CertifyOptions options{.external = &external_, .volume = false};
  EXPECT_TRUE(certify(mesh_, spheres, options).covered);
}

// What the progress throws ends all blocks, in the first answer and in the search.
TEST_F(Blocks, EndWithWhatIsThrown) {
  options_.effort = 2;
  for (const int calls : {2, 20}) {
    std::atomic<int> count = 0;
    options_.progress = [&](double, const char*) {
      if (++count == calls) throw std::runtime_error("enough");
    };
    EXPECT_THROW(covered(12), std::runtime_error) << calls;
  }
}

TEST_F(Blocks, ReportTheShareThatIsDone) {
  options_.effort = 1;
  std::vector<double> shares;
  options_.progress = [&](double share, const char* what) {
    EXPECT_STRNE(what, "");
    shares.push_back(share);
  };
  options_.threads = 1;
  tbb::task_arena arena(1);
  arena.execute([&] { covered(6); });
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.size(), 12U);
  EXPECT_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace spherule::test::cover_blocks_test
