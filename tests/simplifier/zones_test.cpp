// SPDX-License-Identifier: BSD-3-Clause
// The shapes of zones against long double and the file they come in; what gets in where with a D of
// their own, and that nothing ever intersects the mesh; zones about sharp concave edges; that
// covers with zones of their own E keep both errors, and that the tool that made D does not notice
// the simplification.
#include "simplifier/types/zones.h"

#include "geometry/mesh_distance.h"
#include "simplifier/concave_edges.h"
#include "simplifier/option_record.h"
#include "simplifier/simplify.h"
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
    const Real exact = zone_distance(shape, p);
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
      ASSERT_LE(zone_distance(shape, p + reach * random.direction()), 1e-15L);
    }
  }
  EXPECT_GT(contained, 100);
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
    TriangleMesh mixed = mesh;
    for (std::size_t i = 0; i < mixed.triangles.size(); i += 3) {
      std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
    }
    for (const TriangleMesh& variant : {mesh, inverted(mesh), mixed, joined(mixed, mesh)}) {
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

// --- covers with zones of their own E ---

constexpr double kError = kSanitized ? 0.2 : 0.1;
constexpr double kZoneError = kSanitized ? 0.04 : 0.02;

// Of points in spheres and in the zone, densest on the spheres' surfaces: how many there are
// outside of S, and how many of these have no point of S within the error, where a sphere that
// holds them promises one: on the way to its centre.
struct ZoneJudgement {
  int outside = 0;
  int beyond = 0;
};

ZoneJudgement judge_zone(const Zone& zone, const std::vector<Sphere>& spheres,
                         const ExternalSpheres& external, double error, Random& random) {
  ZoneJudgement judgement;
  for (const Sphere& sphere : spheres) {
    for (int i = 0; i < effort(600, 150); ++i) {
      const Vector3d direction = random.direction();
      const double way = sphere.radius * (i % 2 == 0 ? 1.0 : random.between(0.7, 1.0));
      const Vector3d p = sphere.center + way * direction;
      if (zone_distance(zone.shape, p) > 0.0L || is_in_solid(p, external)) continue;
      ++judgement.outside;
      bool near = false;
      for (const double share : {0.5, 0.9, 1.0 + 1e-9}) {
        const double back = std::min(way, share * error);
        near = near || is_in_solid(sphere.center + (way - back) * direction, external);
      }
      if (!near) ++judgement.beyond;
    }
  }
  return judgement;
}

SimplifyOptions options_with(std::vector<Zone> zones) {
  return {.max_error = kError, .zones = std::move(zones), .effort = effort(4, 1)};
}

std::vector<Zone> zones_of_all_shapes() {
  return {{.shape = Sphere{{1, 1, 1}, 0.2}, .max_error = kZoneError},
          {.shape = AlignedBox3d(Vector3d(-0.3, -0.3, -0.3), Vector3d(0.2, 0.15, 0.1)),
           .max_error = 2.0 * kZoneError},
          {.shape = ZoneCapsule{{1, 0.2, 0}, {1, 0.5, 0}, 0.1}, .max_error = kZoneError}};
}

TEST(ZoneFit, NoPointOfASphereInAZoneIsFurtherFromTheSolidThanTheZoneAllows) {
  const TriangleMesh mesh = cube_mesh();
  Random random(81);
  const Simplification fit = simplify(mesh, options_with(zones_of_all_shapes()));
  EXPECT_EQ(broken_promises(fit), "");
  ASSERT_EQ(fit.certificate.protrusion_in_zones.size(), 3U);
  const Simplification coarse = simplify(mesh, options_with({}));
  for (std::size_t i = 0; i < 3; ++i) {
    const Zone& zone = fit.options.zones[i];
    EXPECT_LE(fit.certificate.protrusion_in_zones[i], *zone.max_error);
    EXPECT_GT(fit.certificate.protrusion_in_zones[i], 0.0);
    const ZoneJudgement judgement =
        judge_zone(zone, fit.cover.spheres, fit.external, *zone.max_error, random);
    EXPECT_GT(judgement.outside, effort(20, 5)) << i;
    EXPECT_EQ(judgement.beyond, 0) << i;
    // The judge is not blind: without zones the error is E there too.
    EXPECT_GT(
        judge_zone(zone, coarse.cover.spheres, coarse.external, *zone.max_error, random).beyond,
        effort(20, 2))
        << i;
  }
  // G1 and G2 as ever.
  const auto points = points_of_solid(fit.external, samples(20000, 2000), random);
  EXPECT_EQ(judge_cover(points, fit.cover.spheres).uncovered, 0U);
  EXPECT_EQ(
      judge_protrusion(fit.cover.spheres, mesh, fit.external, kError, samples(200, 40), random)
          .beyond,
      0U);
}

// A small zone makes its surroundings fine, not the whole part.
TEST(ZoneFit, ASmallZoneCostsLittle) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const Zone zone{.shape = Sphere{{1, 1, 1}, 0.1}, .max_error = kZoneError};
  const Simplification coarse = simplify(cube_mesh(), options_with({}));
  const Simplification fit = simplify(cube_mesh(), options_with({zone}));
  EXPECT_EQ(broken_promises(fit), "");
  const auto elsewhere = [](const std::vector<Sphere>& spheres) {
    return std::ranges::count_if(
        spheres, [](const Sphere& s) { return (s.center - Vector3d(1, 1, 1)).norm() > 0.4; });
  };
  EXPECT_LE(elsewhere(fit.cover.spheres), 5 * elsewhere(coarse.cover.spheres) / 4 + 2);
}

TEST(ZoneFit, ASphereThatReachesIntoAZoneTooFarIsBlamed) {
  const std::vector<Zone> zones = zones_of_all_shapes();
  Simplification fit = simplify(cube_mesh(), options_with({}));
  const Certificate certificate =
      certify(cube_mesh(), fit.cover.spheres, {.external = &fit.external, .zones = zones});
  fit.options.zones = zones;
  EXPECT_NE(broken_promises(fit).find("in zone 0"), std::string::npos);  // not even examined
  fit.certificate = certificate;
  EXPECT_NE(broken_promises(fit).find("in zone 0, only by at most " +
                                      std::string(kSanitized ? "0.2" : "0.1")),
            std::string::npos)
      << broken_promises(fit);
}

// A file holds spheres, certificate and options; an audit from it alone comes to the same end.
TEST(ZoneFit, ZonesSurviveTheRecordAndAnAuditPlacesTheSameExternalSpheres) {
  TriangleMesh mesh = l_bracket();
  SimplifyOptions options = options_with(zones_of_all_shapes());
  options.zones[1].min_external_diameter = 0.2;
  options.keep_concave_edges = true;
  options.effort = 0;
  const Simplification fit = simplify(mesh, options);
  const SphereFile file = sphere_file(fit, 1.0);
  const SimplifyOptions again = options_from_record(file.options);
  EXPECT_EQ(again.zones, options.zones);
  EXPECT_TRUE(again.keep_concave_edges);
  EXPECT_EQ(place_external_spheres(mesh, external_options(again)).spheres, fit.external.spheres);
  EXPECT_EQ(file.spheres, fit.cover.spheres);
  EXPECT_EQ(file.options, option_record(fit.options, 1.0));
  EXPECT_TRUE(file.certificate->covered);
  EXPECT_EQ(file.certificate->sphere_count, file.spheres.size());
  EXPECT_EQ(file.certificate->protrusion_over_simplified_max,
            fit.certificate.protrusion_over_simplified_max);
  EXPECT_EQ(file.certificate->protrusion_over_mesh_max,
            fit.certificate.protrusion_over_mesh->upper);
  EXPECT_EQ(file.certificate->protrusion_in_zones, fit.certificate.protrusion_in_zones);
  EXPECT_FALSE(option_record({}, 1.0).contains("zones"));
  EXPECT_FALSE(option_record({}, 1.0).contains("keep-concave-edges"));
  EXPECT_THROW(options_from_record({{"zones", std::string("[]")}}), Error);
  EXPECT_THROW(options_from_record({{"zones", 1.0}}), Error);
  EXPECT_THROW(options_from_record({{"keep-concave-edges", 1.0}}), Error);
}

// --- the right tool ---

TEST(Tool, DIsTheDiameterOfItsSmallestSphere) {
  EXPECT_EQ(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, 2.0}, {{1, 0, 0}, 0.75}}), 1.5);
  EXPECT_THROW(tool_diameter({}), Error);
  EXPECT_THROW(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, 2.0}, {{1, 0, 0}, 0.0}}), Error);
  EXPECT_THROW(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, -2.0}}), Error);
}

// "Nothing is lost by simplifying, for the right tool" (docs/guarantee.md). Let h be the grid step.
// A tool whose every sphere (c, r), r >= rho, keeps a room of m = 1.733 h > 2 sqrt(3)/2 h beyond r
// all the way in intersects nothing of S, not even by the scallops: take a point p of the sphere
// and c' between c and p, p within rho of c', where the room is still rho + m. As m is more than
// the 1.367 h that the flood requires, the grid reaches the cell of c'. If that is a node x, |x -
// c'| <= 0.867 h, then d(x) >= rho + m - 0.867 h > rho + 0.866 h >= |p - x|; if it is a coarse cell
// of half diagonal g, then d(x) >= rho + g + 1.2 h > |p - x|. So p lies in the sphere kept for that
// cell, which is open, and not in S.
class Walk {
 public:
  Walk(const MeshDistance& distance, const std::vector<Sphere>& tool, double room)
      : distance_(distance), tool_(tool), room_(room) {}

  static Vector3d at(const Eigen::Isometry3d& pose, const Sphere& sphere) {
    return pose * sphere.center;
  }

  // Whether every sphere has the room here, and half a step more for the way here.
  bool is_free(const Eigen::Isometry3d& pose, double step) const {
    return std::ranges::all_of(tool_, [&](const Sphere& sphere) {
      return distance_(at(pose, sphere)).lower >= sphere.radius + room_ + step / 2.0;
    });
  }

  // Towards the target in small free steps, with turns where the way is blocked.
  Eigen::Isometry3d run(Eigen::Isometry3d pose, const Vector3d& target, double step,
                        Random& random) const {
    double reach = 0.1;
    for (const Sphere& sphere : tool_) reach = std::max(reach, sphere.center.norm());
    for (int i = 0; i < effort(400, 200); ++i) {
      const double angle = random.between(-0.2, 0.2) * step / reach;
      const Vector3d towards = target - pose.translation();
      const Vector3d astray = random.between(0.0, 1.5) * random.direction();
      Eigen::Isometry3d next = pose;
      next.linear() = (Eigen::AngleAxisd(angle, random.direction()) * pose.linear()).eval();
      // A sphere moves by at most the step in all: 0.8 of it and a fifth of it.
      next.translation() +=
          std::min(towards.norm(), 0.8 * step) * (towards.normalized() + astray).normalized();
      if (is_free(next, step)) pose = next;
    }
    return pose;
  }

 private:
  const MeshDistance& distance_;
  const std::vector<Sphere>& tool_;
  double room_;
};

// A thin rod, covered by spheres of one radius nearly along its axis.
std::vector<Sphere> rod() {
  const TriangleMesh mesh = box_mesh({-0.01, -0.01, -0.4}, {0.01, 0.01, 0.4});
  return simplify(mesh, {.max_error = 0.05, .min_radius = 0.1, .effort = 2}).cover.spheres;
}

ExternalSpheres externals_for(const std::vector<Sphere>& tool, const TriangleMesh& mesh) {
  return place_external_spheres(mesh,
                                {.min_external_diameter = tool_diameter(tool), .max_error = 0.05});
}

// No point of the closed spheres, those next to the mesh among them, is in S.
void expect_nothing_met(const std::vector<Sphere>& tool, const Eigen::Isometry3d& pose,
                        const MeshDistance& distance, const ExternalSpheres& external,
                        Random& random) {
  for (const Sphere& sphere : tool) {
    const Vector3d c = Walk::at(pose, sphere);
    const Vector3d to_mesh = (distance(c).closest - c).normalized();
    ASSERT_FALSE(is_in_solid(c + sphere.radius * to_mesh, external));
    for (int k = 0; k < 30; ++k) {
      const double share = k % 3 == 0 ? random.unit() : 1.0;
      const Vector3d beside = to_mesh + 0.3 * random.unit() * random.direction();
      const Vector3d direction = k % 2 == 0 ? random.direction() : beside.normalized();
      ASSERT_FALSE(is_in_solid(c + share * sphere.radius * direction, external));
    }
  }
}

constexpr double kRoom = 1.733;  // of the grid step

TEST(Tool, AToolThatDIsMadeForMeetsNothingOfTheSolidUnlessItMeetsTheMesh) {
  const std::vector<Sphere> tool = rod();
  EXPECT_GE(tool_diameter(tool), 0.2);
  Random random(91);
  int close = 0;
  for (const TriangleMesh& mesh : {cube_mesh(1.5), l_bracket(), pipe(0.8, 0.6, 1.0, 16)}) {
    const ExternalSpheres external = externals_for(tool, mesh);
    const MeshDistance distance(mesh);
    const Walk walk(distance, tool, kRoom * external.grid_step);
    for (int i = 0; i < effort(60, 8); ++i) {
      const Vector3d target = random.in_box(external.box);
      Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
      start.linear() = random.rotation().toRotationMatrix();
      start.translation() = target + 6.0 * random.direction();
      const Eigen::Isometry3d pose = walk.run(start, target, 0.05, random);
      ASSERT_TRUE(walk.is_free(pose, 0.0));
      expect_nothing_met(tool, pose, distance, external, random);
      if (external.box.exteriorDistance(pose.translation()) < 0.4) ++close;
    }
  }
  EXPECT_GT(close, effort(60, 8));
}

}  // namespace
}  // namespace spherule::test
