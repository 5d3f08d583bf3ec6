// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "io/placement.h"
#include "io/polygon_triangles.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

double in_millimetres(const std::string& text) {
  const std::optional<Length> length = parse_length(text);
  return length && length->unit != nullptr ? in_units_of(1000.0, *length) : -1.0;
}

TEST(LengthUnits, AreWrittenBehindTheNumber) {
  EXPECT_EQ(in_millimetres("1mm"), 1.0);
  EXPECT_EQ(in_millimetres("10cm"), 100.0);
  EXPECT_EQ(in_millimetres("0.5in"), 12.7);
  EXPECT_EQ(in_millimetres("0.5 inch"), 12.7);
  EXPECT_EQ(in_millimetres("1e-3m"), 1.0);
  EXPECT_EQ(in_millimetres("+2ft"), 609.6);
  EXPECT_EQ(in_millimetres("3MM"), 3.0);
  EXPECT_EQ(in_millimetres("7um"), 0.007);
  ASSERT_TRUE(parse_length("2.5"));
  EXPECT_EQ(parse_length("2.5")->value, 2.5);
  EXPECT_EQ(parse_length("2.5")->unit, nullptr);
  EXPECT_TRUE(std::isinf(parse_length("1e999mm")->value));
  for (const char* wrong : {"", "mm", "1 ", "1km", "1mm ", "1  mm", "1,5mm", "0x10mm", "1mm2"}) {
    EXPECT_FALSE(parse_length(wrong)) << wrong;
  }
}

// As each format has it.
TEST(LengthUnits, FilesStateTheirs) {
  const TempDir folder;
  const auto stated = [&](const std::string& ending, const std::string& bytes) {
    const std::filesystem::path path = folder.path() / ("part." + ending);
    std::ofstream(path, std::ios::binary) << bytes;
    return stated_unit(path);
  };
  const TriangleMesh mesh = cube_mesh();
  EXPECT_FALSE(stated("stl", text_stl(mesh)));
  EXPECT_FALSE(stated("obj", obj_text(mesh)));
  EXPECT_EQ(stated("glb", glb_bytes(mesh, {0, 0, 0}))->micrometres, 1e6);
  EXPECT_TRUE(stated("gltf", gltf_text(mesh, {0, 0, 0}))->by_format);
  const Eigen::Matrix4d unmoved = Eigen::Matrix4d::Identity();
  EXPECT_EQ(stated("dae", dae_text(mesh, unmoved, "0.0254"))->own_micrometres, 25400.0);
  EXPECT_EQ(stated("dae", dae_text(mesh, unmoved, "0.0254"))->micrometres, 1e6);
  std::string model = threemf_model(mesh);
  const std::size_t unit = model.find(" unit=\"");
  if (unit != std::string::npos) model.erase(unit, model.find('"', unit + 7) + 1 - unit);
  EXPECT_EQ(stated("3mf", threemf_bytes(model))->micrometres, 1000.0);
  const std::size_t root = model.find("<model") + 6;
  for (const auto& [name, size] :
       {std::pair{"micron", 1.0}, std::pair{"centimeter", 1e4}, std::pair{"inch", 25400.0},
        std::pair{"foot", 304800.0}, std::pair{"meter", 1e6}}) {
    std::string other = model;
    other.insert(root, std::string(" unit=\"") + name + "\"");
    EXPECT_EQ(stated("3mf", threemf_bytes(other))->micrometres, size) << name;
  }
  model.insert(root, " unit=\"cubit\"");
  EXPECT_THROW(stated("3mf", threemf_bytes(model)), Error);
  EXPECT_EQ(stated("step", "")->micrometres, 1000.0);
}

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;
using Polygon = std::vector<Vector2d>;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double area_of(const Polygon& polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    area += cross(polygon[i], polygon[(i + 1) % polygon.size()]) / 2.0;
  }
  return area;
}

// How often it is around the point: crossings of a ray, each with its direction.
int winding(const Polygon& polygon, const Vector2d& p) {
  int number = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    const double side = cross(b - a, p - a);
    if (a.y() <= p.y() && side > 0.0) ++number;
    if (b.y() <= p.y() && side < 0.0) --number;
  }
  return number;
}

// The polygon divided in a plane of space, as polygons in its own plane.
std::vector<Polygon> divided(const Polygon& polygon, Random& random) {
  Eigen::Quaterniond turn(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                          random.between(-1, 1));
  turn.normalize();
  std::vector<Vector3d> vertices;
  for (const Vector2d& p : polygon) vertices.push_back(turn * Vector3d(p.x(), p.y(), 3.0));
  std::vector<int> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0);
  const auto triangles = internal::polygon_triangles(vertices, corners);
  std::vector<Polygon> result;
  if (!triangles) return result;
  for (const Vector3i& t : *triangles) {
    Polygon& triangle = result.emplace_back();
    for (const int corner : t) triangle.push_back(polygon[static_cast<std::size_t>(corner)]);
  }
  return result;
}

// Points within are in one triangle, points outside in none, and none is turned over.
void expect_exact(const Polygon& polygon, Random& random, const std::string& what) {
  const std::vector<Polygon> triangles = divided(polygon, random);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << what;
  for (const Polygon& triangle : triangles) ASSERT_GE(area_of(triangle), -1e-9) << what;
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : polygon) box.extend(p);
  for (int i = 0; i < effort(200, 20); ++i) {
    const Vector2d p(random.between(box.min().x(), box.max().x()),
                     random.between(box.min().y(), box.max().y()));
    const auto holds = std::ranges::count_if(
        triangles, [&](const Polygon& triangle) { return winding(triangle, p) != 0; });
    ASSERT_EQ(holds, winding(polygon, p)) << what;
  }
}

// Other corners come first, too.
void expect_exact_from_all(Polygon polygon, Random& random, const std::string& what) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    expect_exact(polygon, random, what + " from " + std::to_string(i));
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
}

// Around the origin, at random distances from it.
Polygon star(Random& random, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random.between(0.1, 0.9)) / corners;
    polygon.push_back(random.between(0.1, 1.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

// With teeth of a length as wide as all of them together, leaning.
Polygon comb(int teeth, double lean) {
  Polygon polygon{{0.0, -1.0}, {2.0 * teeth, -1.0}};
  for (int i = teeth - 1; i >= 0; --i) {
    const Vector2d root(2.0 * i, 0.0);
    const Vector2d tip = root + Vector2d(lean * 2.0 * teeth, 2.0 * teeth);
    polygon.insert(polygon.end(), {root + Vector2d(1.5, 0), tip + Vector2d(1, 0), tip, root});
  }
  return polygon;
}

// A square with square holes in a row, each tied to the one before it by a bridge.
Polygon plate(int holes) {
  Polygon polygon{{0, 0}, {4.0 * holes, 0}, {4.0 * holes, 4}, {0, 4}, {0, 0}};
  std::vector<Vector2d> back;
  for (int i = 0; i < holes; ++i) {
    const Vector2d at(4.0 * i + 1.0, 1.0);
    polygon.push_back(at);
    polygon.push_back(at + Vector2d(0, 2));
    polygon.push_back(at + Vector2d(2, 2));
    polygon.push_back(at + Vector2d(2, 0));
    back.push_back(at);
  }
  polygon.insert(polygon.end(), back.rbegin(), back.rend());
  return polygon;
}

TEST(PolygonTriangles, AConvexOneIsAFan) {
  Random random(1);
  Polygon polygon;
  for (int i = 0; i < 12; ++i) polygon.emplace_back(std::cos(i / 2.0), std::sin(i / 2.0));
  const std::vector<Polygon> triangles = divided(polygon, random);
  ASSERT_EQ(triangles.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(triangles[i], (Polygon{polygon[0], polygon[i + 1], polygon[i + 2]}));
  }
}

TEST(PolygonTriangles, AreThePolygon) {
  Random random(2);
  for (int i = 0; i < effort(200, 20); ++i) {
    const int corners = 4 + static_cast<int>(random.index(40));
    expect_exact(star(random, corners), random, "star " + std::to_string(i));
  }
  expect_exact_from_all({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, random, "L");
  expect_exact_from_all({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, random,
                        "U");
  expect_exact_from_all({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {1, 1}, {0, 2}, {0, 1}}, random,
                        "with corners on lines and twice");
  expect_exact_from_all(comb(6, 0.0), random, "comb");
  expect_exact_from_all(comb(6, 0.7), random, "leaning comb");
  for (const int holes : {1, 2, 5}) expect_exact_from_all(plate(holes), random, "plate");
}

TEST(PolygonTriangles, OneThatCrossesItselfStaysAFan) {
  Random random(3);
  const Polygon bow{{0, 0}, {3, 2}, {3, 0}, {0, 1}};
  const std::vector<Polygon> triangles = divided(bow, random);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_EQ(triangles[0], (Polygon{bow[0], bow[1], bow[2]}));
}

TEST(PolygonTriangles, ManyCorners) {
  Random random(4);
  // An L, and from its end there and back a line.
  Polygon spike{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}};
  const int half = effort(20000, 2000);
  for (int i = 1; i <= half; ++i) spike.emplace_back(1.0, 2.0 + i);
  for (int i = half; i-- > 1;) spike.emplace_back(1.0, 2.0 + i);
  spike.insert(spike.end(), {{1, 2}, {0, 2}});
  EXPECT_EQ(divided(spike, random).size(), spike.size() - 2);
  EXPECT_EQ(divided(comb(1000, 0.0), random).size(), 4000u);
  EXPECT_EQ(divided(star(random, 3000), random).size(), 2998u);
  if (kSanitized) return;
  EXPECT_TRUE(divided(comb(10000, 1.0), random).empty());
}

// A plate with a hole through it, its top and bottom a face each, is as thick and as open as it is
// when it is divided by hand.
TEST(PolygonTriangles, AFileOfPolygonsIsThePart) {
  const Polygon top{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0},
                    {4, 4}, {4, 6},  {6, 6},   {6, 4},  {4, 4}};
  std::ostringstream obj;
  for (const int z : {0, 1}) {
    for (const std::size_t i : std::vector<std::size_t>{0, 1, 2, 3, 5, 6, 7, 8}) {
      obj << "v " << top[i].x() << ' ' << top[i].y() << ' ' << z << '\n';
    }
  }
  obj << "f 9 10 11 12 9 13 14 15 16 13\nf 5 8 7 6 5 1 4 3 2 1\n";
  for (const int first : {1, 5}) {
    for (int i = 0; i < 4; ++i) {
      const int a = first + i, b = first + (i + 1) % 4;
      obj << "f " << a << ' ' << b << ' ' << b + 8 << ' ' << a + 8 << '\n';
    }
  }
  const TempDir folder;
  const MeshReport report = mesh_report(read_mesh(folder.write("plate.obj", obj.str())));
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 96.0, 1e-9);
  EXPECT_NEAR(report.area, 2 * 96.0 + 40.0 + 8.0, 1e-9);
  EXPECT_EQ(report.self_intersections, 0u);
}

// Every triangle with vertices of its own, each moved by up to `crack`.
TriangleMesh cracked(const TriangleMesh& mesh, double crack, unsigned seed) {
  Random random(seed);
  TriangleMesh result;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto first = static_cast<int>(result.vertices.size());
    for (const int v : t) {
      result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] +
                                crack * random.unit() * random.direction());
    }
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

double greatest_move(const TriangleMesh& a, const TriangleMesh& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d& p = a.vertices[static_cast<std::size_t>(a.triangles[i][k])];
      const Vector3d& q = b.vertices[static_cast<std::size_t>(b.triangles[i][k])];
      most = std::max(most, (p - q).norm());
    }
  }
  return most;
}

TEST(WeldWithin, ShutsCracksAndMovesNoCornerFurtherThanItSays) {
  for (const char* name : {"icosphere", "torus"}) {
    SCOPED_TRACE(name);
    const TriangleMesh whole =
        name == std::string("torus") ? torus(1.0, 0.3, 24, 12) : icosphere(3);
    constexpr double kCrack = 1e-5;
    const TriangleMesh broken = cracked(whole, kCrack, 5);
    ASSERT_FALSE(mesh_report(broken).closed);
    const double tolerance = 2.0 * kCrack;
    const TriangleMesh shut = internal::weld_within(broken, tolerance);
    EXPECT_TRUE(mesh_report(shut).closed);
    EXPECT_EQ(shut.vertices.size(), whole.vertices.size());
    ASSERT_EQ(shut.triangles.size(), broken.triangles.size());
    EXPECT_LE(greatest_move(broken, shut), tolerance);
    EXPECT_GE(shut.vertex_error, tolerance);
    EXPECT_LE(shut.vertex_error, 1.001 * tolerance);
  }
}

// A chain of vertices, each within reach of the next, is not drawn together to its end.
TEST(WeldWithin, AChainIsNotDrawnTogether) {
  TriangleMesh fan;
  for (int i = 0; i < 40; ++i) {
    const auto first = static_cast<int>(fan.vertices.size());
    fan.vertices.insert(fan.vertices.end(), {Vector3d(0.6 * i, 0.0, 0.0), Vector3d(0.0, 50.0, 0.0),
                                             Vector3d(0.0, 0.0, 50.0)});
    fan.triangles.emplace_back(first, first + 1, first + 2);
  }
  const TriangleMesh welded = internal::weld_within(fan, 1.0);
  ASSERT_EQ(welded.triangles.size(), fan.triangles.size());
  EXPECT_LE(greatest_move(fan, welded), 1.0);
  EXPECT_EQ(welded.vertices.size(), 20U + 2U);
}

TEST(WeldWithin, KeepsTrianglesThatLoseTheirArea) {
  const TriangleMesh mesh = icosphere(1);
  const TriangleMesh point = internal::weld_within(mesh, 10.0);
  EXPECT_EQ(point.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(point.vertices.size(), 1U);
}

// No cracks are so fine that the search for them would run out of whole numbers.
TEST(WeldWithin, AVeryFineToleranceDoesNothing) {
  const TriangleMesh mesh = icosphere(2);
  EXPECT_EQ(internal::weld_within(mesh, 1e-300).vertices.size(), mesh.vertices.size());
  EXPECT_EQ(internal::weld_within(mesh, 0.0).vertex_error, mesh.vertex_error);
}

TEST(WeldWithin, IsAnOptionOfReading) {
  const TempDir folder;
  const std::filesystem::path file = folder.path() / "cracked.stl";
  write_stl(cracked(icosphere(2), 1e-4, 9), file);
  EXPECT_FALSE(mesh_report(read_mesh(file)).closed);
  const TriangleMesh shut = read_mesh(file, {.scale = 1000.0, .weld = 0.3});
  EXPECT_TRUE(mesh_report(shut).closed);
  EXPECT_GE(shut.vertex_error, 0.3);
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(read_mesh(file, {.weld = bad}), Error);
  }
}

}  // namespace
}  // namespace spherule::test
