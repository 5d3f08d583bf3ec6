// SPDX-License-Identifier: BSD-3-Clause
// G7 (docs/guarantee.md): equal input gives equal bits on every machine, compiler and optimisation
// level. If a stage is changed on purpose, put the value that the failing test prints here and say
// so in CHANGELOG.md: spheres fitted before will differ from spheres fitted after.
#include "simplifier/repair.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

struct Golden {
  const char* name;
  TriangleMesh mesh;
  ExternalPlacement placement;
  std::uint64_t external;
  std::uint64_t paper;
  std::uint64_t cover;
};

// Shapes whose corners are exact: those made with library sines differ by machine.
std::vector<Golden> goldens() {
  return {{"l-bracket", l_bracket(), ExternalPlacement::kReachable, 0xf99a390c5e1d9196,
           0xb45589aed752c7c7, 0x9644a2c479ec55fc},
          {"soup", soup(60, 3), ExternalPlacement::kReachable, 0x80961e6ec53e4ad1,
           0xda40e703ff2222c4, 0x0764b3cb457d2227},
          {"icosphere", icosphere(2), ExternalPlacement::kReachable, 0x35cbb665c82f992f,
           0x34dcd36b4b28135a, 0x6169a83915625a83},
          {"l-bracket, random", l_bracket(), ExternalPlacement::kRandom, 0x7d295e4e8f91a830,
           0xeb449418249e2928, 0x78373213b2c19c89}};
}

TEST(Golden, ExternalSpheresAndTheSpheresOfBothMethods) {
  for (const Golden& golden : effort(goldens(), 2)) {
    SCOPED_TRACE(golden.name);
    CoverOptions options;
    options.method = CoverMethod::kPaper;
    FitShares shares;
    shares.max_error = 0.07;
    shares.placement = golden.placement;
    const Fit fitted = fit(golden.mesh, options, shares);
    const std::uint64_t external = hash_of(fitted.external.spheres);
    const std::uint64_t paper = hash_of(fitted.cover.spheres);
    options.method = CoverMethod::kCover;
    shares.effort = 2;
    const std::uint64_t covering = hash_of(fit(golden.mesh, options, shares).cover.spheres);
    EXPECT_EQ(external, golden.external) << "external: 0x" << std::hex << external;
    EXPECT_EQ(paper, golden.paper) << "paper: 0x" << std::hex << paper;
    EXPECT_EQ(covering, golden.cover) << "cover: 0x" << std::hex << covering;
  }
}

TEST(Golden, NoStageDependsOnTheNumberOfThreads) {
  const TriangleMesh mesh = l_bracket();
  const double size = diagonal_of(mesh);
  const auto all_of = [&](ExternalPlacement placement, CoverMethod method, int threads) {
    const Simplification made = simplify(mesh, {.max_error = 0.1 * size,
                                                .levels = {0.1 * size, 0.2 * size},
                                                .min_external_diameter = 0.4 * size,
                                                .method = method,
                                                .external = placement,
                                                .external_limit = 3000,
                                                .effort = effort(3, 1),
                                                .threads = threads});
    const CoverLevel& level = made.levels.at(0);
    std::vector<Sphere> leaking = made.cover.spheres;
    leaking.pop_back();
    for (Sphere& sphere : leaking) sphere.radius *= 0.98;
    const RepairOptions with{.max_error = 0.1 * size, .effort = 2, .threads = threads};
    const CoverOptions bounded{.max_error = 0.25 * size, .lower_bound = true, .threads = threads};
    return std::tuple(made.external.spheres, made.cover.spheres, level.spheres.spheres,
                      level.spheres.parent_of, level.protrusion,
                      repair(mesh, made.external, leaking, with).spheres,
                      cover(mesh, box_of(mesh), bounded).lower_bound);
  };
  for (const auto& [placement, method] :
       effort(std::vector{std::pair{ExternalPlacement::kReachable, CoverMethod::kCover},
                          {ExternalPlacement::kRandom, CoverMethod::kPaper}},
              1)) {
    const auto first = all_of(placement, method, 1);
    for (const int threads : {2, 0}) EXPECT_TRUE(all_of(placement, method, threads) == first);
  }
}

}  // namespace
}  // namespace spherule::test
