// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/rounding_mode.h"

#include "collide/mechanism_check.h"
#include "collide/mesh_tree.h"
#include "collide/pair_cache.h"
#include "spheretree/build.h"
#include "spheretree/error.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <string>

namespace spherule::test::rounding_mode_test {
namespace {

// The mode of this thread while it lives.
class Rounding {
 public:
  explicit Rounding(int mode) : old_(std::fegetround()) { std::fesetround(mode); }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;
  ~Rounding() { std::fesetround(old_); }

 private:
  int old_;
};

template <typename Call>
std::string subject_of(int mode, Call call) {
  const Rounding rounding(mode);
  try {
    call();
  } catch (const Error& error) {
    return error.subject();
  }
  return "accepted";
}

TEST(RoundingMode, OthersAreRefused) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
  const SphereTree tree = build_tree(spheres);
  const MechanismCheck check({}, {}, {}, {}, 0.0);
  const TriangleMesh cube = cube_mesh();
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    const std::string expected = mode == FE_TONEAREST ? "accepted" : "rounding mode";
    EXPECT_EQ(subject_of(mode, [] { require_rounding_to_nearest(); }), expected) << mode;
    EXPECT_EQ(subject_of(mode, [&] { build_tree(spheres); }), expected) << mode;
    EXPECT_EQ(subject_of(mode, [&] { MeshTree{cube}; }), expected) << mode;
    EXPECT_EQ(subject_of(mode, [&] { PairCache(tree, tree); }), expected) << mode;
    EXPECT_EQ(subject_of(mode, [&] { MechanismCheck::Scratch{check}; }), expected) << mode;
  }
}

}  // namespace
}  // namespace spherule::test::rounding_mode_test
