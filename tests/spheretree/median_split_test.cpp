// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/median_split.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <random>
#include <span>
#include <vector>

namespace spherule::test {
namespace {

// Against sorted numbers: the halves hold the same ones.
TEST(MedianSplit, HalvesAreThoseOfTheOrder) {
  std::mt19937 bits(3);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<int> items(count);
    for (int& item : items) item = static_cast<int>(bits() % 1000);
    std::vector<int> sorted = items;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    const std::size_t half =
        internal::split_at_median(std::span(items), [](int item) { return -item; });
    ASSERT_EQ(half, count / 2);
    std::sort(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), std::greater<>());
    std::sort(items.begin() + static_cast<std::ptrdiff_t>(half), items.end(), std::greater<>());
    ASSERT_EQ(items, sorted);
  }
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  EXPECT_EQ(internal::longest_axis(cube), 0);
  EXPECT_EQ(internal::longest_axis({Eigen::Vector3d::Zero(), Eigen::Vector3d(1.0, 2.0, 3.0)}), 2);
}

}  // namespace
}  // namespace spherule::test
