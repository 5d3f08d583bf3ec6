// SPDX-License-Identifier: BSD-3-Clause

// Seeded mutations of valid files: a loader either throws Error or returns something valid. Run
// under the sanitizers, this also shows that no byte sequence leads to undefined behaviour.

#include "base/crc64.h"
#include "base/error.h"
#include "spheretree/build.h"
#include "spheretree/internal/file_content.h"
#include "tests/spheretree/spheres.h"
#include "tests/spheretree/tree_oracle.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace spherule::test {
namespace {

// One to four changes: overwritten, flipped, inserted, removed or copied bytes, or a cut.
std::string mutated(std::string bytes, Random& random, std::string_view alphabet) {
  const auto any_byte = [&] {
    return alphabet.empty() ? static_cast<char>(random.below(256))
                            : alphabet[random.below(alphabet.size())];
  };
  const std::size_t changes = 1 + random.below(4);
  for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t at = random.below(bytes.size());
    const std::size_t length = std::min(1 + random.below(16), bytes.size() - at);
    switch (random.below(6)) {
      case 0:
        bytes[at] = any_byte();
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
      case 2:
        bytes.insert(at, 1 + random.below(8), any_byte());
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(random.below(bytes.size()), bytes.substr(at, length));
        break;
      default:
        bytes.resize(at);
        break;
    }
  }
  return bytes;
}

constexpr int kCases = effort(40000, 8000);

TEST(LoaderFuzz, MutatedTrees) {
  Random random(31);
  const std::string good =
      internal::encode_tree(build_tree(sphere_families(12, 1).front().spheres, {.branching = 3}));
  int valid = 0;
  int refused = 0;
  for (int i = 0; i < kCases; ++i) {
    std::string bytes = mutated(good, random, {});
    // Half of them get a right checksum, or none would come past it.
    if (i % 2 == 0 && bytes.size() >= 8) {
      const std::uint64_t checksum = crc64(std::string_view(bytes).substr(0, bytes.size() - 8));
      std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
    }
    try {
      const SphereTree tree = internal::decode_tree(bytes, "a.tree");
      ASSERT_EQ(fault_of(tree.data()), "");
      ++valid;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(valid, kCases / 400);  // for example, a leaf that moved within its parent
  EXPECT_GT(refused, kCases / 4);
}

TEST(LoaderFuzz, MutatedSphereFiles) {
  Random random(32);
  SphereFile file;
  file.spheres = sphere_families(4, 1).front().spheres;
  file.certificate = {.covered = true, .volume_ratio = 1.5};
  file.certificate->sphere_count = file.spheres.size();
  file.options = {{"seed", std::int64_t{3}}, {"max-error", 0.5}, {"method", std::string("cover")}};
  const std::string good = internal::encode_spheres(file, "a.json");
  int valid = 0;
  int refused = 0;
  for (int i = 0; i < kCases; ++i) {
    const std::string_view alphabet = i % 2 == 0 ? "0123456789.-+eE,:[]{}\"\\ntfu" : "";
    try {
      const SphereFile loaded = internal::decode_spheres(mutated(good, random, alphabet), "a.json");
      for (const Sphere& sphere : loaded.spheres) {
        ASSERT_TRUE(std::isfinite(sphere.center.sum()) && sphere.radius >= 0.0);
      }
      // What was read can be written and read again.
      const std::string text = internal::encode_spheres(loaded, "a.json");
      ASSERT_EQ(internal::encode_spheres(internal::decode_spheres(text, "a.json"), "a.json"), text);
      ++valid;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(valid, kCases / 40);
  EXPECT_GT(refused, kCases / 4);
}

}  // namespace
}  // namespace spherule::test
