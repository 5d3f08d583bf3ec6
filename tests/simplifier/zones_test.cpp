// SPDX-License-Identifier: BSD-3-Clause
// The shapes of zones against long double, and the file they come in.
#include "simplifier/types/zones.h"

#include "base/error.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/zone_file.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Real = long double;
using Vector3l = Eigen::Matrix<Real, 3, 1>;

Real true_distance(const ZoneShape& shape, const Vector3d& at) {
  const Vector3l p = at.cast<Real>();
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return std::max(0.0L, (p - sphere->center.cast<Real>()).norm() - sphere->radius);
  }
  if (const auto* box = std::get_if<AlignedBox3d>(&shape)) {
    const Vector3l inside =
        p.cwiseMax(box->min().cast<Real>()).cwiseMin(box->max().cast<Real>()).eval();
    return (p - inside).norm();
  }
  const auto& capsule = std::get<ZoneCapsule>(shape);
  const Vector3l from = capsule.from.cast<Real>();
  const Vector3l way = capsule.to.cast<Real>() - from;
  const Real length = way.squaredNorm();
  const Real t = length > 0.0L ? std::clamp((p - from).dot(way) / length, 0.0L, 1.0L) : 0.0L;
  return std::max(0.0L, (p - from - t * way).norm() - capsule.radius);
}

ZoneShape random_shape(Random& random) {
  const AlignedBox3d space(Vector3d::Constant(-1), Vector3d::Constant(1));
  const Vector3d a = random.in_box(space);
  const Vector3d b = random.in_box(space);
  switch (random.index(4)) {
    case 0:
      return Sphere{a, random.unit()};
    case 1:
      return AlignedBox3d(a.cwiseMin(b), a.cwiseMax(b));
    case 2:
      return ZoneCapsule{a, a, 0.5 * random.unit()};
    default:
      return ZoneCapsule{a, b, 0.5 * random.unit()};
  }
}

TEST(Zones, DistancesAreBoundsAndContainmentIsCertain) {
  Random random(71);
  const AlignedBox3d space(Vector3d::Constant(-2), Vector3d::Constant(2));
  int contained = 0;
  for (int i = 0; i < 20000; ++i) {
    const ZoneShape shape = random_shape(random);
    const Vector3d p = random.in_box(space);
    const Real exact = true_distance(shape, p);
    const double lower = distance_lower(shape, p);
    ASSERT_LE(lower, exact);
    ASSERT_GE(lower, exact - 1e-12L);
    const AlignedBox3d box = bounds(shape);
    ASSERT_TRUE(exact > 0.0L || box.contains(p));
    // A sphere in the shape: so are the points on it.
    const double reach = random.index(2) == 0 ? 0.0 : 0.3 * random.unit();
    if (!certainly_contains(shape, p, reach)) continue;
    ++contained;
    for (int k = 0; k < 10; ++k) {
      ASSERT_LE(true_distance(shape, p + reach * random.direction()), 1e-15L);
    }
  }
  EXPECT_GT(contained, 100);
}

TEST(Zones, ThePointsOfAShapeAreContainedUpToRounding) {
  const AlignedBox3d box(Vector3d(0, 0, 0), Vector3d(1, 2, 3));
  EXPECT_TRUE(certainly_contains(ZoneShape(box), Vector3d(0, 2, 1.5)));
  EXPECT_TRUE(
      certainly_contains(ZoneShape(ZoneCapsule{{0, 0, 0}, {1, 0, 0}, 0.5}), {0.5, 0.499, 0}));
  EXPECT_FALSE(
      certainly_contains(ZoneShape(ZoneCapsule{{0, 0, 0}, {1, 0, 0}, 0.5}), {0.5, 0.501, 0}));
}

// min(E, min over Z of max(e, dist(c, Z) - d)), by going through all zones.
TEST(Zones, TheLocalErrorIsTheLeastOfAllZones) {
  Random random(72);
  const AlignedBox3d space(Vector3d::Constant(-3), Vector3d::Constant(3));
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<Zone> zones;
    for (std::size_t i = 0; i < static_cast<std::size_t>(scene) * 10; ++i) {
      zones.push_back({.shape = random_shape(random), .max_error = random.between(0.01, 0.5)});
      if (random.index(4) == 0) zones.back() = {zones.back().shape, std::nullopt, 1.0};
    }
    const internal::LocalError error(0.5, zones);
    for (int i = 0; i < 200; ++i) {
      const Vector3d c = random.in_box(space);
      const double d = random.index(2) == 0 ? 0.0 : random.unit();
      Real expected = 0.5L;
      for (const Zone& zone : zones) {
        if (!zone.max_error) continue;
        const Real gap = true_distance(zone.shape, c) - d;
        expected = std::min(expected, std::max<Real>(*zone.max_error, gap));
      }
      ASSERT_LE(error.allowance(c, d), expected);
      ASSERT_GE(error.allowance(c, d), expected - 1e-12L);
    }
  }
}

constexpr const char* kAllShapes = R"({"format":"spherule-zones","version":1,"zones":[
  {"shape":"ball","center":[1,2,3],"radius":4,"max_error":0.5,"min_external":2},
  {"shape":"box","min":[0,0,0],"max":[1,2.5,3],"max_error":0.1},
  {"shape":"capsule","from":[0,0,0],"to":[0,0,9],"radius":1e-3,"min_external":0.3}]})";

TEST(Zones, AFileHoldsSpheresBoxesAndCapsules) {
  const TempDir folder;
  const std::vector<Zone> zones = read_zones(folder.write("zones.json", kAllShapes));
  const std::vector<Zone> expected = {
      {Sphere{{1, 2, 3}, 4.0}, 0.5, 2.0},
      {AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 2.5, 3)), 0.1, std::nullopt},
      {ZoneCapsule{{0, 0, 0}, {0, 0, 9}, 1e-3}, std::nullopt, 0.3}};
  EXPECT_EQ(zones, expected);
  EXPECT_EQ(tightest_error(zones, 1.0), 0.1);
  EXPECT_EQ(tightest_error(zones, 0.05), 0.05);
}

TEST(Zones, TheTextOfZonesGivesThemBackBitForBit) {
  Random random(73);
  std::vector<Zone> zones;
  for (int i = 0; i < 200; ++i) {
    zones.push_back({random_shape(random), random.unit() + 1e-9, random.unit() + 1e-9});
    if (random.index(3) == 0) zones.back().max_error.reset();
    if (zones.back().max_error && random.index(3) == 0) zones.back().min_external_diameter.reset();
  }
  EXPECT_EQ(parse_zones(zones_text(zones), "text"), zones);
}

TEST(Zones, FaultsAreNamedWithFileAndEntry) {
  const TempDir folder;
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      read_zones(folder.write("bad.json", text));
    } catch (const Error& error) {
      EXPECT_TRUE(error.subject().ends_with("bad.json")) << error.subject();
      return error.reason();
    }
    return "accepted";
  };
  const auto file = [](const std::string& zones) {
    return R"({"format":"spherule-zones","version":1,"zones":[)" + zones + "]}";
  };
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(reason(text).find(part), std::string::npos) << text << ": " << reason(text);
  };
  expect("", "line 1, column 1: is not JSON: unexpected end of input");
  expect("[]", "is not an object");
  expect("{}", "\"format\" is missing");
  expect(R"({"format":"other","version":1,"zones":[]})", "is not of format");
  expect(R"({"format":"spherule-zones","version":2,"zones":[]})", "version");
  expect(R"({"format":"spherule-zones","version":1,"zones":{}})", "is not a list");
  expect(R"({"format":"spherule-zones","version":1,"zones":[],"more":1})", "unknown key \"more\"");
  const std::string good = R"({"shape":"ball","center":[0,0,0],"radius":1,"max_error":1})";
  expect(file(good + ",7"), "zone 1: is not an object");
  expect(file(good + R"(,{"shape":"cone","max_error":1})"),
         "zone 1: unknown shape \"cone\": ball, box or capsule");
  expect(file(R"({"center":[0,0,0],"radius":1,"max_error":1})"), "zone 0: \"shape\" is missing");
  expect(file(R"({"shape":3})"), "zone 0: \"shape\" is not a text");
  const auto sphere = [&](const std::string& rest) {
    return file(R"({"shape":"ball",)" + rest + "}");
  };
  expect(sphere(R"("center":[0,0],"radius":1,"max_error":1)"), "zone 0: \"center\" is not [x,y,z]");
  expect(sphere(R"("center":[0,0,"a"],"radius":1,"max_error":1)"), "\"center\" is not a number");
  expect(sphere(R"("center":[0,0,0],"max_error":1)"), "zone 0: \"radius\" is missing");
  expect(sphere(R"("center":[0,0,0],"radius":-1,"max_error":1)"), "zone 0: the shape has");
  expect(sphere(R"("center":[0,0,1e16],"radius":1,"max_error":1)"), "zone 0: the shape has");
  expect(sphere(R"("center":[0,0,0],"radius":1)"), "zone 0: has neither");
  expect(sphere(R"("center":[0,0,0],"radius":1,"max_error":0)"), "zone 0: the max error must be");
  expect(sphere(R"("center":[0,0,0],"radius":1,"min_external":-2)"), "zone 0: the min external");
  expect(sphere(R"("center":[0,0,0],"radius":1,"max_eror":1)"), "zone 0: unknown key \"max_eror\"");
  expect(sphere(R"("center":[0,0,0],"radius":1,"radius":2,"max_error":1)"),
         "the key \"radius\" appears twice");
  expect(sphere(R"("center":[0,0,0],"radius":1,"from":[0,0,0],"max_error":1)"),
         "zone 0: unknown key \"from\"");
  expect(file(R"({"shape":"box","min":[0,0,0],"max":[1,-1,1],"max_error":1})"),
         "zone 0: the shape has");
  expect(file(R"({"shape":"capsule","from":[0,0,0],"radius":1,"max_error":1})"),
         "zone 0: \"to\" is missing");
}

TEST(Zones, ValuesAboveThoseElsewhereAreRefused) {
  const std::vector<Zone> zones = {{Sphere{{0, 0, 0}, 1.0}, 0.5, 2.0}};
  EXPECT_NO_THROW(check_zones(zones, 0.5, 2.0));
  EXPECT_THROW(check_zones(zones, 0.49, 2.0), Error);
  EXPECT_THROW(check_zones(zones, 0.5, 1.9), Error);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Zone& bad : {Zone{Sphere{{0, 0, 0}, kNan}, 0.5, 2.0}, Zone{zones[0].shape, kNan, {}},
                          Zone{zones[0].shape, {}, kNan}}) {
    EXPECT_THROW(check_zones(std::vector<Zone>{bad}, 1.0, 4.0), Error);
  }
}

}  // namespace
}  // namespace spherule::test
