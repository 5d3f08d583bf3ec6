// SPDX-License-Identifier: BSD-3-Clause
// The shapes of zones against long double and the file they come in; what gets in where with a D of
// their own, and that nothing ever intersects the mesh; zones about sharp concave edges.
#include "simplifier/types/zones.h"

#include "simplifier/concave_edges.h"
#include "simplifier/simplify.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/zone_file.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

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
  const std::string head = R"({"format":"spherule-zones","version":1,"zones":)";
  const auto file = [&](const std::string& zones) { return head + "[" + zones + "]}"; };
  const auto ball = [&](const std::string& rest) {
    return file(R"({"shape":"ball",)" + rest + "}");
  };
  const std::string middle = R"("center":[0,0,0],)";
  const std::string good = R"({"shape":"ball","center":[0,0,0],"radius":1,"max_error":1})";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1, column 1: is not JSON: unexpected end of input"},
      {"[]", "is not an object"},
      {"{}", "\"format\" is missing"},
      {R"({"format":"other","version":1,"zones":[]})", "is not of format"},
      {R"({"format":"spherule-zones","version":2,"zones":[]})", "version"},
      {head + "{}}", "is not a list"},
      {head + R"([],"more":1})", "unknown key \"more\""},
      {file(good + ",7"), "zone 1: is not an object"},
      {file(good + R"(,{"shape":"cone","max_error":1})"),
       "zone 1: unknown shape \"cone\": ball, box or capsule"},
      {file("{" + middle + R"("radius":1,"max_error":1})"), "zone 0: \"shape\" is missing"},
      {file(R"({"shape":3})"), "zone 0: \"shape\" is not a text"},
      {ball(R"("center":[0,0],"radius":1,"max_error":1)"), "zone 0: \"center\" is not [x,y,z]"},
      {ball(R"("center":[0,0,"a"],"radius":1,"max_error":1)"), "\"center\" is not a number"},
      {ball(middle + R"("max_error":1)"), "zone 0: \"radius\" is missing"},
      {ball(middle + R"("radius":-1,"max_error":1)"), "zone 0: the shape has"},
      {ball(R"("center":[0,0,1e16],"radius":1,"max_error":1)"), "zone 0: the shape has"},
      {ball(middle + R"("radius":1)"), "zone 0: has neither"},
      {ball(middle + R"("radius":1,"max_error":0)"), "zone 0: the max error must be"},
      {ball(middle + R"("radius":1,"min_external":-2)"), "zone 0: the min external"},
      {ball(middle + R"("radius":1,"max_eror":1)"), "zone 0: unknown key \"max_eror\""},
      {ball(middle + R"("radius":1,"radius":2,"max_error":1)"), "the key \"radius\" appears twice"},
      {ball(middle + R"("radius":1,"from":[0,0,0],"max_error":1)"), "zone 0: unknown key \"from\""},
      {file(R"({"shape":"box","min":[0,0,0],"max":[1,-1,1],"max_error":1})"),
       "zone 0: the shape has"},
      {file(R"({"shape":"capsule","from":[0,0,0],"radius":1,"max_error":1})"),
       "zone 0: \"to\" is missing"}};
  for (const auto& [text, reason] : cases) {
    const std::string path = folder.write("bad.json", text).string();
    const std::string said = refusal([&] { read_zones(path); });
    EXPECT_TRUE(said.starts_with(path)) << said;
    EXPECT_NE(said.find(reason), std::string::npos) << text << ": " << said;
  }
}

TEST(Zones, ValuesAboveThoseElsewhereAreRefused) {
  const std::vector<Zone> zones = {{Sphere{{0, 0, 0}, 1.0}, 0.5, 2.0}};
  EXPECT_NO_THROW(check_zones(zones, 0.5, 2.0));
  EXPECT_THROW(check_zones(zones, 0.49, 2.0), Error);
  EXPECT_THROW(check_zones(zones, 0.5, 1.9), Error);
  for (const Zone& bad : {Zone{Sphere{{0, 0, 0}, kNan}, 0.5, 2.0}, Zone{zones[0].shape, kNan, {}},
                          Zone{zones[0].shape, {}, kNan}}) {
    EXPECT_THROW(check_zones(std::vector<Zone>{bad}, 1.0, 4.0), Error);
  }
}

// --- zones of their own D ---

constexpr double kWide = 3.0;    // D
constexpr double kNarrow = 1.0;  // d

// Two square plates, 1 thick, with a gap between them that is open on all four sides.
TriangleMesh two_plates(double gap, double side = 20.0) {
  return joined(box_mesh({0, 0, -1}, {side, side, 0}),
                box_mesh({0, 0, gap}, {side, side, 1 + gap}));
}

Zone box_zone(const Vector3d& low, const Vector3d& high, double diameter) {
  return {.shape = AlignedBox3d(low, high), .min_external_diameter = diameter};
}

constexpr double kStep = kSanitized ? 0.9 : 0.6;
const std::vector<double> kSteps = effort(std::vector{kStep, 0.51}, 1);

ExternalSpheres placed(const TriangleMesh& mesh, std::vector<Zone> zones, double step = kStep) {
  return place_external_spheres(
      mesh, {.min_external_diameter = kWide, .grid_step = step, .zones = std::move(zones)});
}

// Brute force: no sphere intersects the mesh, and each is as large as its place requires.
void expect_true_spheres(const TriangleMesh& mesh, const ExternalSpheres& external,
                         const std::vector<Zone>& zones) {
  bool some_small = false;
  for (const Sphere& sphere : external.spheres) {
    ASSERT_LE(sphere.radius, judged_mesh_distance(sphere.center, mesh));
    double least = kWide / 2.0;
    for (const Zone& zone : zones) {
      if (std::get<AlignedBox3d>(zone.shape).contains(sphere.center)) {
        least = std::min(least, *zone.min_external_diameter / 2.0);
      }
    }
    ASSERT_GE(sphere.radius, least);
    some_small = some_small || sphere.radius < kWide / 2.0;
  }
  EXPECT_EQ(some_small, !zones.empty());
}

TEST(ZoneReach, ASlotIsOpenInTheZoneAndClosedOutsideOfIt) {
  // The zone holds the near third of the slot and the mouth before it.
  const std::vector<Zone> zones = {box_zone({-5, -5, -1}, {7, 25, 3}, kNarrow)};
  for (const double shift : effort(std::vector{0.13, 0.0, 0.31}, 1)) {
    const TriangleMesh mesh =
        joined(two_plates(1.9), box_mesh({0, 0, -2.0 - shift}, {0.1, 0.1, -1.0}));
    const ExternalSpheres external = placed(mesh, zones);
    expect_true_spheres(mesh, external, zones);
    EXPECT_FALSE(is_in_solid({1.0, 10.0, 0.95}, external));
    EXPECT_FALSE(is_in_solid({6.0, 10.0, 0.95}, external));
    // What is wider than d only, beyond the zone, and at the far mouth.
    for (const double x : {9.0, 12.0, 18.0}) {
      EXPECT_TRUE(is_in_solid({x, 10.0, 0.95}, external)) << x;
    }
    EXPECT_TRUE(is_in_solid({6.0, 10.0, 0.95}, placed(mesh, {})));
  }
}

TEST(ZoneReach, AGapNarrowerThanTheZonesDiameterStaysClosed) {
  const std::vector<Zone> zones = {box_zone({-3, -3, -3}, {7, 7, 5}, kNarrow)};
  for (const double gap : effort(std::vector{0.999, 0.5, 0.9}, 2)) {
    for (const double step : kSteps) {
      const ExternalSpheres external = placed(two_plates(gap, 4.0), zones, step);
      EXPECT_TRUE(is_in_solid({1.0, 2.0, gap / 2.0}, external)) << gap;
      EXPECT_TRUE(is_in_solid({2.0, 2.0, gap / 2.0}, external)) << gap;
    }
  }
}

// A chamber behind a throat: the zone round the chamber alone does not open the throat, nor does
// one that ends within it; neither do two zones between which a piece of the throat is left.
TEST(ZoneReach, TheWholeWayInHasToBeWideEnough) {
  // 11 long and 3 wide inside, open where x is 0.
  TriangleMesh mesh = joined(box_mesh({0, 0, -1}, {12, 4, 0}), box_mesh({0, 0, 1.9}, {12, 4, 2.9}));
  for (const Vector3d& low : {Vector3d(0, 0, -1), Vector3d(0, 3.5, -1), Vector3d(11.5, 0, -1)}) {
    const Vector3d high(12, low == Vector3d(0, 0, -1) ? 0.5 : 4, 2.9);
    mesh = joined(mesh, box_mesh(low, high));
  }
  const Vector3d far(9.5, 2.0, 0.95);
  const auto is_open = [&](const std::vector<Zone>& zones) {
    return !is_in_solid(far, placed(mesh, zones));
  };
  const Vector3d low(-2, -2, -2);
  const Vector3d high(14, 6, 4);
  EXPECT_TRUE(is_open({box_zone(low, high, kNarrow)}));
  EXPECT_FALSE(is_open({box_zone({6, -2, -2}, high, kNarrow)}));
  if (kSanitized) return;  // each takes seconds there
  EXPECT_FALSE(is_open({box_zone(low, {6, 6, 4}, kNarrow)}));
  EXPECT_FALSE(
      is_open({box_zone(low, {5, 6, 4}, kNarrow), box_zone({5.05, -2, -2}, high, kNarrow)}));
  EXPECT_TRUE(is_open({box_zone(low, {6, 6, 4}, kNarrow), box_zone({4, -2, -2}, high, kNarrow)}));
}

TEST(ZoneReach, TheSlackHoldsInZonesAndAcrossTheirBorders) {
  for (const double step : kSteps) {
    const double slack = placed(cube_mesh(), {}, step).closing_slack;
    // The grid of the zone: the same share of d, down to the next halving.
    const double zone_slack = slack / std::exp2(std::ceil(std::log2(kWide / kNarrow)));
    for (const double shift : effort(std::vector{0.19, 0.0}, 1)) {
      const auto shifted = [&](const TriangleMesh& mesh) {
        return joined(mesh, box_mesh({0, 0, -2.0 - shift}, {0.1, 0.1, -1.0}));
      };
      const std::vector<Zone> all = {box_zone({-3, -3, -3}, {7, 7, 5}, kNarrow)};
      const double narrow = kNarrow + zone_slack * 1.0001;
      EXPECT_FALSE(
          is_in_solid({2, 2, narrow / 2.0}, placed(shifted(two_plates(narrow, 4)), all, step)));
      const std::vector<Zone> middle = {box_zone({2.5, -3, -3}, {4.5, 7, 7}, kNarrow)};
      const double wide = kWide + slack * 1.0001;
      const ExternalSpheres external = placed(shifted(two_plates(wide, 7)), middle, step);
      for (const double x : {1.0, 2.5, 3.5, 4.5, 6.0}) {
        EXPECT_FALSE(is_in_solid({x, 3.5, wide / 2.0}, external)) << x;
      }
    }
  }
}

TEST(ZoneReach, BadZonesAreRefused) {
  for (const double bad : {2.0 * kWide, 1e-300}) {
    EXPECT_THROW(placed(cube_mesh(), {box_zone({0, 0, 0}, {1, 1, 1}, bad)}), Error) << bad;
  }
  for (const ExternalPlacement placement : {ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
    ExternalOptions options{.placement = placement, .min_external_diameter = kWide};
    options.zones = {box_zone({0, 0, 0}, {1, 1, 1}, kNarrow)};
    EXPECT_THROW(place_external_spheres(cube_mesh(), options), Error);
    options.zones.clear();
    options.keep_concave_edges = true;
    EXPECT_THROW(place_external_spheres(cube_mesh(), options), Error);
  }
}

// --- sharp concave edges ---

TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const std::array<Vector3d, 3> v = corners_of(mesh, t);
    const Vector3d ab = (v[0] + v[1]) / 2.0, bc = (v[1] + v[2]) / 2.0, ca = (v[2] + v[0]) / 2.0;
    for (const auto& [a, b, c] : {std::array{v[0], ab, ca}, std::array{ab, v[1], bc},
                                  std::array{ca, bc, v[2]}, std::array{ab, bc, ca}}) {
      const auto first = static_cast<int>(fine.vertices.size());
      fine.vertices.insert(fine.vertices.end(), {a, b, c});
      fine.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return fine;
}

// Two faces of 4 x 4 that meet in the z axis at the given outside angle, as an extruded wedge.
TriangleMesh notch(double angle) {
  const Vector3d arm(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0);
  const Vector3d up(0, 0, 4);
  const Vector3d o(0, 0, 0), x(4, 0, 0);
  // Normals point into the opening between the arms.
  return {{o, x, Vector3d(x + up), up, arm, Vector3d(arm + up)},
          {{0, 3, 2}, {0, 2, 1}, {0, 4, 5}, {0, 5, 3}}};
}

const ConcaveEdgeOptions kEdges{.min_external_diameter = 0.9, .max_error = 0.1, .margin = 0.045};

TEST(ConcaveEdges, TheInsideEdgeOfABracketIsTheOnlyOne) {
  TriangleMesh mesh = l_bracket();
  for (int level = 0; level < 3; ++level) {
    for (const TriangleMesh& variant : {mesh, inverted(mesh)}) {
      const std::vector<Zone> zones = concave_edge_zones(variant, kEdges);
      ASSERT_EQ(zones.size(), 1U);
      const auto& capsule = std::get<ZoneCapsule>(zones[0].shape);
      EXPECT_NEAR((capsule.to - capsule.from).norm(), 0.5, 1e-12);
      // E / 2 = r (sqrt 2 - 1).
      EXPECT_NEAR(*zones[0].min_external_diameter, 0.1 / (std::numbers::sqrt2 - 1.0), 1e-9);
      EXPECT_GT(capsule.radius, 0.495 * std::numbers::sqrt2);
      EXPECT_LT(capsule.radius, 0.6 * std::numbers::sqrt2);
    }
    mesh = subdivided(mesh);
  }
}

TEST(ConcaveEdges, ConvexAndBluntEdgesAreNone) {
  for (const TriangleMesh& mesh :
       {cube_mesh(), icosphere(2), thin_sheet(0.01), with_duplicates(cube_mesh())}) {
    EXPECT_TRUE(concave_edge_zones(mesh, kEdges).empty());
  }
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const double angle : {20.0, 60.0, 90.0, 120.0}) {
    EXPECT_EQ(concave_edge_zones(notch(angle * kDegree), kEdges).size(), 1U) << angle;
  }
  for (const double angle : {151.0, 179.0}) {
    ConcaveEdgeOptions options = kEdges;
    options.max_error = 1e-3;
    EXPECT_TRUE(concave_edge_zones(notch(angle * kDegree), options).empty()) << angle;
  }
  // D itself leaves little enough: r (1 / sin 60 - 1) < E / 2.
  EXPECT_TRUE(
      concave_edge_zones(notch(120 * kDegree), {.min_external_diameter = 2.0, .max_error = 0.4})
          .empty());
}

TEST(ConcaveEdges, TheDiameterHasALeastShare) {
  const std::vector<Zone> zones = concave_edge_zones(
      notch(1.0), {.min_external_diameter = 32.0, .max_error = 1e-3, .margin = 0.1});
  ASSERT_EQ(zones.size(), 1U);
  EXPECT_EQ(*zones[0].min_external_diameter, 8.0);
}

// Edges whose triangles contradict each other, and those of three: uncertain they count.
TEST(ConcaveEdges, InDoubtAnEdgeCounts) {
  TriangleMesh mesh = notch(1.5);
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  std::swap(mesh.triangles[1][1], mesh.triangles[1][2]);
  EXPECT_EQ(concave_edge_zones(mesh, kEdges).size(), 1U);
  EXPECT_EQ(concave_edge_zones(three_fins(), kEdges).size(), 1U);
}

// The fillet that is left in the corner: wide with D, at most E / 2 and the grid's share with the
// zone; and no sphere intersects the mesh.
TEST(ConcaveEdges, TheCornerIsKept) {
  TriangleMesh bracket = l_bracket();
  for (Vector3d& v : bracket.vertices) v *= 20.0;
  ExternalOptions options{.min_external_diameter = 9.0, .max_error = 1.0};
  const std::vector<Zone> zones =
      concave_edge_zones(bracket, {.min_external_diameter = 9.0, .max_error = 1.0});
  ASSERT_EQ(zones.size(), 1U);
  const auto& edge = std::get<ZoneCapsule>(zones[0].shape);
  const Vector3d middle = (edge.from + edge.to) / 2.0;
  // Away from both arms, which lie along x and z.
  const Vector3d inwards = Vector3d(1, 0, 1).normalized();
  const auto fillet = [&](const ExternalSpheres& external) {
    double depth = 0.0;
    while (is_in_solid(middle + depth * inwards, external)) depth += 0.01;
    return depth;
  };
  EXPECT_GT(fillet(place_external_spheres(bracket, options)), 4.5 * (std::numbers::sqrt2 - 1.0));
  options.keep_concave_edges = true;
  const ExternalSpheres kept = place_external_spheres(bracket, options);
  EXPECT_EQ(kept.concave_edges.size(), 1U);
  EXPECT_LT(fillet(kept), 0.5 + 0.3);  // E / 2 and a step
  for (const Sphere& sphere : kept.spheres) {
    ASSERT_LE(sphere.radius, judged_mesh_distance(sphere.center, bracket));
  }
}

}  // namespace
}  // namespace spherule::test
