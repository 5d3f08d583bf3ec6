// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/tree_file.h"

#include "base/crc64.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_bytes.h"
#include "tests/support/exact/trees.h"
#include "tests/support/hash.h"
#include "tests/support/random_scene.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace spherule::test {
namespace {

class TreeFile : public TemporaryFolder {
 protected:
  SphereTree tree_ = build_tree(sphere_families(50, 8).front().spheres);

  std::string good_bytes() const { return internal::encode_tree(tree_); }

  // What reading these bytes says; the subject must be the file.
  static std::string refusal(const std::string& bytes) {
    const std::string error = error_of([&] { internal::decode_tree(bytes, "a.tree"); });
    EXPECT_TRUE(error.empty() || error.starts_with("a.tree: ")) << error;
    return error;
  }
};

// Offsets of docs/tree-file.md.
constexpr std::size_t kByteOrderMark = 8;
constexpr std::size_t kVersion = 12;
constexpr std::size_t kSphereCount = 16;
constexpr std::size_t kNodeCount = 24;
constexpr std::size_t kNodes = 32;

template <typename T>
void overwrite(std::string& bytes, std::size_t offset, T value) {
  static_assert(std::endian::native == std::endian::little);
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

// With the checksum made right again, so that only the content can be refused.
std::string sealed(std::string bytes) {
  overwrite(bytes, bytes.size() - 8, crc64(std::string_view(bytes).substr(0, bytes.size() - 8)));
  return bytes;
}

TEST(Crc64, HasTheCheckValueOfTheCatalogue) {
  EXPECT_EQ(crc64("123456789"), 0x995DC9BBDF1939FAU);
  EXPECT_EQ(crc64(""), 0U);
}

TEST_F(TreeFile, RoundTripKeepsEveryBit) {
  for (const std::size_t count : {1U, 2U, 7U, 300U}) {
    for (const Family& family : sphere_families(count, 12)) {
      for (const int branching : {2, 8, 16}) {
        SCOPED_TRACE(family.name);
        const SphereTree tree = build_tree(family.spheres, {.branching = branching});
        const std::string bytes = internal::encode_tree(tree);
        const SphereTree loaded = internal::decode_tree(bytes, "a.tree");
        EXPECT_EQ(fault_of(loaded.data()), "");
        EXPECT_EQ(loaded.depth(), tree.depth());
        EXPECT_EQ(loaded.branching(), tree.branching());
        EXPECT_EQ(loaded.data().spheres, tree.data().spheres);
        EXPECT_EQ(internal::encode_tree(loaded), bytes);
      }
    }
  }
}

TEST_F(TreeFile, KeepsMinusZeroAndDenormals) {
  const std::vector<Sphere> spheres = {{{-0.0, 0.0, 0x1p-1074}, 0.0}, {{1.0, -0.0, 0.0}, -0.0}};
  save_tree(build_tree(spheres), path("a.tree"));
  const SphereTree loaded = load_tree(path("a.tree"));
  EXPECT_TRUE(std::signbit(loaded.spheres()[0].center.x()));
  EXPECT_EQ(loaded.spheres()[0].center.z(), 0x1p-1074);
  EXPECT_TRUE(std::signbit(loaded.spheres()[1].radius));
}

// The layout that docs/tree-file.md describes, on the smallest tree.
TEST_F(TreeFile, HasTheDocumentedLayout) {
  save_tree(build_tree(std::vector<Sphere>{{{1.0, 2.0, -3.0}, 0.5}}), path("a.tree"));
  const std::string expected(
      "\x89SPT\r\n\x1a\n"
      "\x04\x03\x02\x01"
      "\x01\x00\x00\x00"
      "\x01\x00\x00\x00\x00\x00\x00\x00"
      "\x01\x00\x00\x00\x00\x00\x00\x00"
      "\x00\x00\x00\x00\x00\x00\xf0\x3f"
      "\x00\x00\x00\x00\x00\x00\x00\x40"
      "\x00\x00\x00\x00\x00\x00\x08\xc0"
      "\x00\x00\x00\x00\x00\x00\xe0\x3f"
      "\x00\x00\x00\x00"
      "\x00\x00\x00\x00",
      72);
  const std::string bytes = bytes_of(path("a.tree"));
  ASSERT_EQ(bytes.size(), 80U);
  EXPECT_EQ(bytes.substr(0, 72), expected);
  EXPECT_EQ(bytes, sealed(bytes));
}

TEST_F(TreeFile, RefusesEveryTruncationAndExtension) {
  const std::string good = good_bytes();
  ASSERT_EQ(refusal(good), "");
  for (std::size_t size = 0; size < good.size(); ++size) {
    ASSERT_NE(refusal(good.substr(0, size)).find("cut short"), std::string::npos) << size;
  }
  EXPECT_NE(refusal(good + '\0').find("too long"), std::string::npos);
  EXPECT_NE(refusal(good + good).find("too long"), std::string::npos);
}

TEST_F(TreeFile, RefusesEveryFlippedBit) {
  const std::string good = good_bytes();
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bytes = good;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    ASSERT_NE(refusal(bytes), "") << "bit " << bit;
  }
}

// Broken in one place, with a right checksum: the form of the file, and what check() refuses.
TEST_F(TreeFile, NamesTheReason) {
  const auto refused_for = [this](std::size_t offset, auto value, const std::string& reason) {
    std::string bytes = good_bytes();
    overwrite(bytes, offset, value);
    const std::string error = refusal(sealed(bytes));
    EXPECT_NE(error.find(reason), std::string::npos) << error;
  };
  refused_for(0, 'X', "is not a sphere tree");
  refused_for(kByteOrderMark, std::uint32_t{0x04030201}, "big-endian");
  refused_for(kByteOrderMark, std::uint32_t{0x04030202}, "byte-order mark");
  refused_for(kVersion, std::uint32_t{2}, "format version 2");
  refused_for(kVersion, std::uint32_t{0}, "version 0");
  refused_for(kSphereCount, std::uint64_t{1000000}, "spheres cannot be the leaves");
  refused_for(kSphereCount, std::uint64_t{49}, "does not exist");
  refused_for(kSphereCount, std::uint64_t{51}, "has no leaf");
  refused_for(kNodeCount, std::uint64_t{3}, "too long");
  // No memory is requested on the word of a forged count.
  for (const std::uint64_t count : {std::uint64_t{1} << 31U, std::uint64_t{1} << 58U,
                                    std::uint64_t{1} << 61U, ~std::uint64_t{0}}) {
    refused_for(kNodeCount, count, "cut short");
    refused_for(kSphereCount, count, "spheres cannot be the leaves");
  }
  const std::size_t nodes = tree_.node_count();
  const std::size_t radii = kNodes + 3 * 8 * nodes;
  const std::size_t first_children = kNodes + 4 * 8 * nodes;
  const std::size_t child_counts = first_children + 4 * nodes;
  refused_for(kNodes, std::nan(""), "not usable");
  refused_for(radii, -1.0, "not usable");
  refused_for(radii, tree_.sphere(0).radius * 0.99, "does not enclose");
  refused_for(first_children, std::int32_t{0}, "breadth-first");
  refused_for(first_children + 4 * (nodes - 1), std::int32_t{-1}, "does not exist");
  refused_for(child_counts, std::int32_t{-1}, "children");
  refused_for(child_counts, std::int32_t{0}, "child of no node");
  std::string damaged = good_bytes();
  damaged[kNodes + 5] = static_cast<char>(damaged[kNodes + 5] ^ 1);
  EXPECT_NE(refusal(damaged).find("checksum"), std::string::npos);
  EXPECT_NE(refusal("solid cube\nendsolid\n").find("is not a sphere tree"), std::string::npos);
}

TEST_F(TreeFile, SavesAndLoads) {
  save_tree(tree_, path("a.tree"));
  EXPECT_EQ(bytes_of(path("a.tree")), good_bytes());
  EXPECT_EQ(load_tree(path("a.tree")).data().spheres, tree_.data().spheres);
  EXPECT_EQ(files_in_folder(), 1U);
  put(path("bad.tree"), good_bytes().substr(1));
  for (const auto& bad : {path("bad.tree"), path("missing"), path("")}) {
    const std::string error = error_of([&] { load_tree(bad); });
    EXPECT_TRUE(error.starts_with(bad.string() + ": ")) << error;
  }
}

TEST_F(TreeFile, DoesNotTouchTheOldFileWhenItCannotWrite) {
  EXPECT_NE(error_of([this] { save_tree(tree_, path("no/such/folder/a.tree")); }), "");
  EXPECT_EQ(files_in_folder(), 0U);
}

// G7. Equal input gives equal bytes on every machine, compiler and optimisation level. If the
// builder or the format is changed on purpose, put the value that the failing test prints here and
// say so in CHANGELOG.md: trees built before will differ from trees built after.
TEST_F(TreeFile, GoldenBytes) {
  constexpr std::uint64_t kGolden = 0xb3e7d534cf33e3bb;
  Random random(20240607);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 5000; ++i) {
    spheres.push_back({random.point(1.0), random.between(0.001, 0.1)});
  }
  const std::uint64_t hash = hash_of(internal::encode_tree(build_tree(spheres)));
  EXPECT_EQ(hash, kGolden) << "0x" << std::hex << hash;
}

}  // namespace
}  // namespace spherule::test
