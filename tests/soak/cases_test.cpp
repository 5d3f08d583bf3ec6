// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/cases.h"

#include "tests/soak/exact_oracle.h"
#include "tests/soak/motion_track.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

namespace spherule {
namespace {

// All rows are clean, and each had both answers and cases near contact to judge.
void expect_clean(const SoakReport& report) {
  EXPECT_FALSE(report.tallies().empty());
  for (const Tally& tally : report.tallies()) {
    EXPECT_EQ(tally.missed, 0u) << tally.question;
    EXPECT_EQ(tally.crossed, 0u) << tally.question;
    EXPECT_EQ(tally.other, 0u) << tally.question;
    EXPECT_LE(tally.worst_slack, 1.0) << tally.question;
    EXPECT_GT(tally.hits, 0u) << tally.question;
    EXPECT_GT(tally.near, tally.cases / 5) << tally.question;
    EXPECT_LE(tally.uncertain, tally.cases / 100) << tally.question;
    if (tally.question != "sweep, thin walls") {
      EXPECT_GT(tally.free, tally.cases / 20) << tally.question;
    }
  }
}

TEST(Soak, PosesAreAnsweredRight) {
  SoakReport report;
  check_poses(20'000, 7, report);
  expect_clean(report);
}

TEST(Soak, ConfigurationsAreAnsweredRight) {
  SoakReport report;
  check_configurations(4'000, 7, report);
  expect_clean(report);
}

TEST(Soak, DistancesAreBounded) {
  SoakReport report;
  check_distances(5'000, 7, report);
  expect_clean(report);
}

TEST(Soak, MotionsAreFreeWhereTheyAreCalledSo) {
  SoakReport report;
  check_sweeps(1'000, 7, report);
  expect_clean(report);
  for (const Tally& tally : report.tallies()) {
    if (tally.question == "sweep, thin walls") {
      EXPECT_LT(tally.free, tally.cases / 10);
    }
  }
}

TEST(Soak, EdgesAreFreeWhereTheyAreCalledSo) {
  SoakReport report;
  check_edges(300, 7, report);
  expect_clean(report);
}

// Exactly touching, and by the smallest step on either side of it.
TEST(Soak, OracleIsExact) {
  ExactOracle oracle;
  const std::array<Sphere, 1> a{{{{0.0, 0.0, 0.0}, 2.0}}};
  const std::array<Sphere, 1> b{{{{3.0, 4.0, 0.0}, 3.0}}};
  // A turn by (3, 4) / 5, which has no exact unit quaternion in double.
  const Pose turned(Eigen::Quaterniond(2.0, 0.0, 0.0, 1.0), {1e6, 0.0, 0.0});
  const auto within = [&](double x, double clearance) {
    return oracle.within({a, turned}, {b, Pose(turned.rotation(), {x, 0.0, 0.0})}, clearance);
  };
  // The image of (3, 4, 0) is (9 - 16, 12 + 12, 0) / 5 = (-1.4, 4.8, 0), again 5 long.
  EXPECT_TRUE(within(1e6, 0.0));
  EXPECT_FALSE(within(std::nextafter(1e6, 0.0), 0.0));
  EXPECT_TRUE(within(std::nextafter(1e6, 2e6), 0.0));
  EXPECT_TRUE(within(std::nextafter(1e6, 0.0), 1e-9));
  EXPECT_GE(oracle.rational_pairs(), 1u);
  const GapBounds gap = oracle.gap({a, turned}, {b, turned});
  EXPECT_LE(gap.lower, 0.0L);
  EXPECT_GE(gap.upper, 0.0L);
}

// The two ways in which a track is made agree with each other and with the ends.
TEST(Soak, TracksLeadFromPoseToPose) {
  const std::array<Sphere, 1> sphere{{{{0.3, -0.2, 0.5}, 0.1}}};
  const Pose start(Eigen::Quaterniond(0.9, 0.1, -0.4, 0.2), {1.0, 2.0, 3.0});
  const Pose end(Eigen::Quaterniond(-0.3, 0.8, 0.1, 0.6), {-2.0, 0.5, 1.0});
  const Eigen::Vector3d reference(0.1, 0.7, -0.4);
  const auto track = MotionTrack<long double>::between(sphere, start, end, reference);
  std::vector<MotionTrack<long double>::Point> centers;
  for (const auto& [t, pose] : {std::pair{0.0, start}, std::pair{1.0, end}}) {
    track.place(t, centers);
    const Eigen::Vector3d expected = pose * sphere[0].center;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(static_cast<double>(centers[0][k]), expected[static_cast<int>(k)], 1e-14);
    }
  }
  const Eigen::AngleAxisd quarter(0.5, Eigen::Vector3d(0.0, 0.6, 0.8));
  const Pose turned(Eigen::Quaterniond(quarter) * start.rotation(), start.translation());
  const auto turning = MotionTrack<long double>::turning(
      sphere, start, quarter.axis(), quarter.angle(), Eigen::Vector3d::Zero(), {0.0, 0.0, 0.0});
  const auto between = MotionTrack<long double>::between(sphere, start, turned, {0.0, 0.0, 0.0});
  std::vector<MotionTrack<long double>::Point> others;
  for (const double t : {0.0, 0.3, 0.8, 1.0}) {
    turning.place(t, centers);
    between.place(t, others);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(static_cast<double>(centers[0][k]), static_cast<double>(others[0][k]), 1e-14);
    }
  }
}

TEST(Soak, CheckedConfigurationsAreAnsweredAsByTheCanonicalTests) {
  SoakReport report;
  check_checker_configurations(20'000, 7, report);
  expect_clean(report);
}

TEST(Soak, CheckedEdgesAreFreeWhereTheyAreCalledSo) {
  SoakReport report;
  check_checker_edges(2'000, 7, report);
  expect_clean(report);
}

}  // namespace
}  // namespace spherule
