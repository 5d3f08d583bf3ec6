// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "robot/cover/audit_robot.h"
#include "robot/cover/link_parts.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "tests/robot/refusals.h"
#include "tests/robot/solid_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <mutex>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

namespace spherule::test {
namespace {

LinkDescription link_of(const LinkShape& shape) {
  return {.name = "arm", .visual = {}, .collision = {shape}};
}

LinkDescription link_of(const Primitive& primitive, const Pose& pose = {}) {
  return link_of({.name = "", .link_from_shape = pose, .geometry = primitive});
}

LinkDescription link_of(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                        const Pose& pose = {}) {
  return link_of({.name = "", .link_from_shape = pose, .geometry = MeshFile{file, scale}});
}

// How far outside of a convex mesh a point lies, by the planes of its faces.
Wide outside_of_convex(const TriangleMesh& mesh, const WidePoint& point) {
  Wide outside = -std::numeric_limits<Wide>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) -> WidePoint {
      return mesh.vertices[static_cast<std::size_t>(t[k])].cast<Wide>();
    };
    const WidePoint normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    outside = std::max(outside, normal.dot(point - corner(0)));
  }
  return outside;
}

// As DAE files are; the scale comes on top.
TEST(LinkMesh, AFileThatStatesItsUnitIsInMetres) {
  const TempDir folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto file = folder.write("part.3mf", threemf_bytes(threemf_model(mesh)));
  for (const double scale : {1.0, 3.0}) {
    const auto read = link_mesh(link_of(file, Eigen::Vector3d::Constant(scale)));
    ASSERT_TRUE(read);
    EXPECT_NEAR(mesh_report(*read).box.sizes().x(), 0.02 * scale, 1e-12);
    EXPECT_GE(read->vertex_error, 0.02 * scale * 0x1p-53);
    EXPECT_LE(read->vertex_error, 1e-15);
  }
}

// The mesh is convex, so that a point is in it if it is behind every face.
TEST(LinkMesh, EnclosesEveryPointOfAPrimitiveAndLittleMore) {
  Random random(1);
  Wide deepest = 0;
  for (int i = 0; i < effort(150, 10); ++i) {
    const Primitive primitive = random_primitive(random, 1.0);
    const Pose pose = random_pose(random, i % 2 == 0 ? 1.0 : 0.0);
    const double chord_error = 0.3 * std::pow(0.1, random.between(0, 3));
    const auto mesh = link_mesh(link_of(primitive, pose), {.chord_error = chord_error});
    ASSERT_TRUE(mesh);
    const MeshReport report = mesh_report(*mesh);
    ASSERT_TRUE(report.closed);
    ASSERT_GT(report.volume, 0.0);
    ASSERT_EQ(report.self_intersections, 0U);
    ASSERT_GE(mesh->vertex_error, 0.0);
    ASSERT_LT(mesh->vertex_error, 1e-12);
    for (int k = 0; k < 40; ++k) {
      const Wide outside = outside_of_convex(*mesh, move(pose, point_of(primitive, random)));
      ASSERT_LE(outside, Wide(mesh->vertex_error)) << "case " << i;
      deepest = std::max(deepest, outside);
    }
    for (const Eigen::Vector3d& v : mesh->vertices) {
      ASSERT_LE(distance_to(primitive, unmove(pose, v.cast<Wide>())),
                Wide(chord_error + mesh->vertex_error))
          << "case " << i;
    }
  }
  // Faces touch what they enclose: only rounding is left between, and it has to be charged.
  EXPECT_GT(deepest, 1e-18L);
}

TEST(LinkMesh, TakesNoMoreTrianglesThanTheChordErrorAsksFor) {
  const auto triangles = [](const Primitive& primitive, double chord_error) {
    return link_mesh(link_of(primitive), {.chord_error = chord_error})->triangles.size();
  };
  EXPECT_EQ(triangles(Box{{1, 2, 3}}, 1e-9), 12U);
  EXPECT_EQ(triangles(Cylinder{1, 1}, 0.1), 4U * 8);
  // 1 / cos(pi / n) - 1 is 0.0086 for n = 24 and 0.0154 for 18, which is not tried, as 0.0196 is
  // for 16.
  EXPECT_EQ(triangles(Cylinder{1, 1}, 0.0087), 4U * 24);
  EXPECT_EQ(triangles(Cylinder{1, 1}, 0.0197), 4U * 16);
  EXPECT_EQ(triangles(SolidSphere{1}, 0.2), 8U * 8);
}

// A mesh of points that are hard to round, as text, so that the file's numbers are those of the
// test.
TEST(LinkMesh, BoundsWhatScaleAndPoseCost) {
  Random random(2);
  const TempDir folder;
  Wide largest_share = 0;
  for (int i = 0; i < effort(100, 10); ++i) {
    const double size = std::pow(10.0, random.between(-3, 4));
    std::vector<Eigen::Vector3d> points;
    std::ostringstream text;
    text.precision(17);
    for (int k = 0; k < 30; ++k) {
      points.push_back(size * random.direction());
      text << "v " << points.back().transpose() << "\n";
    }
    for (int k = 1; k + 2 <= 30; ++k) text << "f " << k << " " << k + 1 << " " << k + 2 << "\n";
    const std::filesystem::path file = folder.write("points.obj", text.str());
    Eigen::Vector3d scale;
    for (int k = 0; k < 3; ++k) {
      scale[k] = std::pow(10.0, random.between(-3, 1)) * (random.index(2) == 0 ? 1 : -1);
    }
    const Pose pose = random_pose(random, size);
    const auto mesh = link_mesh(link_of(file, scale, pose));
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->vertices.size(), points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const WidePoint scaled = points[k].cast<Wide>().cwiseProduct(scale.cast<Wide>());
      const Wide off = (mesh->vertices[k].cast<Wide>() - move(pose, scaled)).norm();
      ASSERT_LE(off, Wide(mesh->vertex_error)) << "case " << i;
      largest_share = std::max(largest_share, off / Wide(mesh->vertex_error));
    }
    ASSERT_LT(mesh->vertex_error, 1e-13 * (10 * size + size));
  }
  EXPECT_GT(largest_share, 0.001L);
}

TEST(LinkMesh, FacesOutwardsWhenMirrored) {
  const TempDir folder;
  write_stl(*link_mesh(link_of(Box{{1, 2, 3}})), folder.path() / "box.stl");
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d scale(k & 1 ? -2 : 2, k & 2 ? -0.5 : 0.5, k & 4 ? -1 : 1);
    const auto mesh = link_mesh(link_of(folder.path() / "box.stl", scale));
    EXPECT_NEAR(mesh_report(*mesh).volume, 6.0, 1e-9) << scale.transpose();
    EXPECT_EQ(mesh_report(*mesh).inverted_components, 0U) << scale.transpose();
  }
}

TEST(LinkMesh, KeepsTheUnitOfColladaAndScalesOnTop) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("part.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 0 0 500 0 0 0 250 1000</float_array>
      <technique_common><accessor source="#a" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)");
  const auto mesh = link_mesh(link_of(file, {2, 4, 3}, Pose::from_translation({10, 0, 0})));
  ASSERT_EQ(mesh->vertices.size(), 3U);
  const Eigen::Vector3d expected[] = {{10, 0, 0}, {11, 0, 0}, {10, 1, 3}};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LE((mesh->vertices[k] - expected[k]).norm(), mesh->vertex_error);
  }
  EXPECT_LT(mesh->vertex_error, 1e-4);
}

TEST(LinkMesh, JoinsAllShapesOfTheGeometryAskedFor) {
  LinkDescription link{.name = "arm", .visual = {}, .collision = {}};
  EXPECT_FALSE(link_mesh(link));
  EXPECT_FALSE(link_mesh(link, {.geometry = LinkGeometry::kVisual}));
  link.visual.push_back({.name = "", .link_from_shape = {}, .geometry = Box{{1, 1, 1}}});
  link.visual.push_back({.name = "",
                         .link_from_shape = Pose::from_translation({5, 0, 0}),
                         .geometry = Box{{1, 1, 1}}});
  EXPECT_FALSE(link_mesh(link)) << "what is only seen is not collided with";
  const auto mesh = link_mesh(link, {.geometry = LinkGeometry::kVisual});
  ASSERT_TRUE(mesh);
  const MeshReport report = mesh_report(*mesh);
  EXPECT_EQ(report.triangles, 24U);
  EXPECT_EQ(report.components, 2U);
  EXPECT_NEAR(report.volume, 2.0, 1e-9);
  EXPECT_NEAR(report.box.max().x(), 5.5, 1e-9);
  EXPECT_NEAR(report.box.min().x(), -0.5, 1e-9);
}

TEST(LinkMesh, RefusesWhatHasNoMesh) {
  const TempDir folder;
  write_stl(*link_mesh(link_of(Box{{1, 2, 3}})), folder.path() / "box.stl");
  const auto expect = [](const LinkDescription& link, const std::string& part,
                         const LinkMeshOptions& options = {}) {
    const std::string text = message_of([&] { link_mesh(link, options); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expect(link_of(HalfSpace{}), "link 'arm'");
  expect(link_of(HalfSpace{}), "half-space");
  expect(link_of(SolidSphere{-1}), "link 'arm'");
  expect(link_of(Box{{1, 0, 1}}), "link 'arm'");
  for (const double bad : {0.0, -kInfinity, std::nan("")}) {
    expect(link_of(SolidSphere{1}), "chord error", {.chord_error = bad});
  }
  expect(link_of(SolidSphere{1}), "too many triangles", {.chord_error = 1e-9});
  const std::filesystem::path file = folder.path() / "box.stl";
  expect(link_of(file, {1, 0, 1}), "box.stl must be finite and not 0");
  expect(link_of(file, {1, kInfinity, 1}), "must be finite");
  expect(link_of(file, {1, 1e16, 1}), "box.stl as scaled: vertex");
  expect(link_of(folder.path() / "none.stl", {1, 1, 1}), "no such file");
}

}  // namespace
}  // namespace spherule::test

// Links of the same shapes are covered and audited once, with the answers of each alone.

namespace spherule::test::equal_links_test {
namespace {

// A palm, and links on it with these shapes; beside it a.stl and b.stl, which nothing reads.
RobotDescription hand(const std::vector<std::string>& shapes) {
  const TempDir folder;
  for (const char* name : {"a.stl", "b.stl"}) folder.write(name, "");
  std::string text = R"(<robot name="hand"><link name="palm"/>)";
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string name = "finger" + std::to_string(i);
    text += "<link name='" + name + "'>" + shapes[i] + "</link><joint name='of " + name +
            "' type='fixed'><parent link='palm'/><child link='" + name + "'/></joint>";
  }
  return read_urdf(folder.write("hand.urdf", text + "</robot>"));
}

std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

const std::string kBar = collision("<box size='0.2 0.01 0.01'/>");
const std::string kShortBar = collision("<box size='0.1 0.01 0.01'/>");

TEST(EqualLinks, EachNumberOfAShapeCounts) {
  const std::vector<std::string> different = {
      kBar,
      kShortBar,
      kBar + kBar,
      collision("<box size='0.2 0.01 0.01'/>", "<origin xyz='0 0 0.1'/>"),
      collision("<box size='0.2 0.01 0.01'/>", "<origin rpy='0 0 0.1'/>"),
      collision("<sphere radius='0.2'/>"),
      collision("<cylinder radius='0.2' length='0.01'/>"),
      collision("<cylinder radius='0.2' length='0.02'/>"),
      collision("<mesh filename='a.stl'/>"),
      collision("<mesh filename='b.stl'/>"),
      collision("<mesh filename='a.stl' scale='1 1 2'/>"),
  };
  std::vector<std::string> twice = different;
  twice.insert(twice.end(), different.rbegin(), different.rend());
  const RobotDescription robot = hand(twice);
  const std::vector<std::size_t> first =
      internal::first_equal_links(robot, LinkGeometry::kCollision);
  ASSERT_EQ(first.size(), 1 + twice.size());
  EXPECT_EQ(first[0], 0U);
  for (std::size_t i = 0; i < different.size(); ++i) {
    EXPECT_EQ(first[1 + i], 1 + i);
    EXPECT_EQ(first[twice.size() - i], 1 + i) << different[i];
  }
  // None has any visual geometry.
  const std::vector<std::size_t> bare = internal::first_equal_links(robot, LinkGeometry::kVisual);
  for (std::size_t i = 0; i < bare.size(); ++i) EXPECT_EQ(bare[i], i);
}

TEST(EqualLinks, AreCoveredOnceAndAsAlone) {
  RobotCoverOptions options{.max_error = 0.01, .effort = 0};
  options.links["finger4"].max_error = 0.02;
  options.links["finger6"].min_external_diameter = 0.05;
  options.links["finger7"].padding = 0.001;
  options.links["finger8"].zones = {
      {.shape = Eigen::AlignedBox3d(Eigen::Vector3d(0, -1, -1), Eigen::Vector3d(1, 1, 1)),
       .max_error = 0.008}};
  std::mutex mutex;
  std::set<std::string> covered;
  options.progress = [&](double, const char* link) {
    const std::lock_guard lock(mutex);
    covered.insert(link);
  };
  const RobotCover cover =
      cover_robot(hand({kBar, kShortBar, kBar, kShortBar, kBar, kBar, kBar, kBar, kBar}), options);
  EXPECT_EQ(covered, (std::set<std::string>{"finger0", "finger1", "finger4", "finger6", "finger7",
                                            "finger8"}));
  const auto alone = [](const std::string& shape, double max_error) {
    return cover_robot(hand({shape}), {.max_error = max_error, .effort = 0}).links[1].spheres;
  };
  EXPECT_TRUE(cover.links[0].spheres.empty());
  for (const std::size_t link : {1UL, 3UL, 6UL}) {
    EXPECT_EQ(cover.links[link].spheres, alone(kBar, 0.01)) << link;
    EXPECT_EQ(cover.links[link].link, "finger" + std::to_string(link - 1));
    EXPECT_EQ(cover.links[link].fit->certificate.covered, true);
    EXPECT_EQ(cover.links[link].seconds == 0.0, link != 1) << link;
  }
  for (const std::size_t link : {2UL, 4UL}) {
    EXPECT_EQ(cover.links[link].spheres, alone(kShortBar, 0.01)) << link;
  }
  EXPECT_EQ(cover.links[5].spheres, alone(kBar, 0.02));
  EXPECT_NE(cover.links[5].spheres, cover.links[1].spheres);
}

TEST(EqualLinks, AreAuditedAndRepairedEachWithItsOwnSpheres) {
  const RobotDescription robot = hand({kBar, kBar, kBar, kShortBar});
  const std::vector<Sphere> ball = {{{0, 0, 0}, 0.11}};
  const std::vector<Sphere> small_ball = {{{0, 0, 0}, 0.06}};
  const std::vector<LinkSpheres> spheres = {
      {"finger0", ball}, {"finger1", small_ball}, {"finger2", ball}, {"finger3", small_ball}};
  const RobotAudit audit = audit_robot(robot, spheres);
  ASSERT_EQ(audit.links.size(), 5U);
  EXPECT_FALSE(audit.links_covered);
  const std::vector<bool> is_covered = {true, false, true, true};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(audit.links[1 + i].link, "finger" + std::to_string(i));
    EXPECT_EQ(audit.links[1 + i].certificate->covered, is_covered[i]) << i;
  }
  const RobotRepair repair = repair_robot(robot, spheres, {.max_error = 0.06});
  ASSERT_EQ(repair.links.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(repair.links[i].link, "finger" + std::to_string(i));
    EXPECT_TRUE(repair.links[i].certificate.covered) << i;
    EXPECT_EQ(repair.links[i].repair.spheres, repair.spheres[i].spheres);
    EXPECT_EQ(repair.spheres[i].spheres == spheres[i].spheres, is_covered[i]) << i;
  }
}

}  // namespace
}  // namespace spherule::test::equal_links_test

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::lie_in_single_spheres;

LinkShape shape_of(const Primitive& primitive, const Pose& pose = {}) {
  return {.name = "", .link_from_shape = pose, .geometry = primitive};
}

// The largest distance from a point to one of the primitive, in its own frame.
struct Farthest {
  const WidePoint& from;

  Wide operator()(const Box& box) const {
    return (from.cwiseAbs() + box.size.cast<Wide>() / 2).norm();
  }
  Wide operator()(const SolidSphere& sphere) const { return from.norm() + sphere.radius; }
  Wide operator()(const Cylinder& cylinder) const {
    return std::hypot(std::hypot(from.x(), from.y()) + cylinder.radius,
                      std::abs(from.z()) + Wide(cylinder.length) / 2);
  }
  Wide operator()(const Capsule& capsule) const {
    return std::hypot(from.x(), from.y(), std::abs(from.z()) + Wide(capsule.length) / 2) +
           capsule.radius;
  }
  Wide operator()(const HalfSpace&) const { return 0; }
};

// Radii step by step through the limit: never held by less, and held by hardly more.
TEST(ShapesInSpheres, ExactlyWhatLiesInASphereUpToRounding) {
  Random random(3);
  for (int i = 0; i < effort(2000, 200); ++i) {
    const double size = std::pow(10.0, random.between(-3, 3));
    const Primitive primitive = random_primitive(random, size);
    const Pose pose =
        random_pose(random, i % 3 == 0 ? 0.0 : size * std::pow(10.0, random.between(0, 3)));
    const double away = i % 5 == 0 ? 0.0 : size * random.between(0, 3);
    const Vector3d center = pose.translation() + away * random.direction();
    const WidePoint own = unmove(pose, center.cast<Wide>());
    const Wide limit = std::visit(Farthest{own}, primitive);
    const double scene = size + center.norm() + pose.translation().norm();
    for (int k = -40; k <= 40; ++k) {
      const double radius = static_cast<double>(limit) + k * 1e-17 * scene;
      const bool held = lie_in_single_spheres(std::array{shape_of(primitive, pose)},
                                              std::array{Sphere{center, radius}});
      // The oracle is off by less than 2^-60 of the scene.
      ASSERT_FALSE(held && Wide(radius) < limit - Wide(scene) * 0x1p-60L) << "case " << i;
    }
    const Sphere more{center, static_cast<double>(limit) + 1e-13 * scene};
    ASSERT_TRUE(lie_in_single_spheres(std::array{shape_of(primitive, pose)}, std::array{more}))
        << "case " << i;
  }
}

TEST(ShapesInSpheres, ASphereLiesInItselfAndNoMeshDoes) {
  const Pose pose(Eigen::Quaterniond(1, 2, 3, 4), {0.1, -0.3, 0.7});
  const std::vector<LinkShape> shape{shape_of(SolidSphere{0.1}, pose)};
  EXPECT_TRUE(lie_in_single_spheres(shape, std::array{Sphere{pose.translation(), 0.1}}));
  const double less = std::nextafter(0.1, 0.0);
  EXPECT_FALSE(lie_in_single_spheres(shape, std::array{Sphere{pose.translation(), less}}));
  EXPECT_FALSE(lie_in_single_spheres(shape, {}));
  const LinkShape mesh{.name = "", .geometry = MeshFile{"part.stl", Vector3d::Ones()}};
  EXPECT_FALSE(lie_in_single_spheres(std::array{mesh}, std::array{Sphere{Vector3d::Zero(), 1e6}}));
}

// Every shape needs one sphere that holds all of it.
TEST(ShapesInSpheres, AChainOfCapsules) {
  std::vector<LinkShape> shapes;
  std::vector<Sphere> spheres;
  for (int i = 0; i < 12; ++i) {
    const auto middle = Pose::from_translation({0.1 * i, 0.0, 0.0});
    shapes.push_back(shape_of(Capsule{.radius = 0.02, .length = 0.06}, middle));
    spheres.push_back({middle.translation(), 0.0501});
  }
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
  std::ranges::reverse(spheres);
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
  spheres[5].radius = 0.0499;
  EXPECT_FALSE(lie_in_single_spheres(shapes, spheres));
}

// Six spheres at the corners of an octahedron overlap in threes and leave a cavity between them,
// which belongs to the inside and is covered by none.
TEST(ShapesInSpheres, ACavityBetweenThemIsNotHeld) {
  std::vector<LinkShape> shapes;
  std::vector<Sphere> spheres;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const Vector3d center = side * Vector3d::Unit(axis);
      shapes.push_back(shape_of(SolidSphere{0.9}, Pose::from_translation(center)));
      spheres.push_back({center, 0.9});
    }
  }
  EXPECT_FALSE(lie_in_single_spheres(shapes, spheres));
  EXPECT_TRUE(lie_in_single_spheres(std::span(shapes).first(3), spheres));
  // One sphere that holds all of them encloses none.
  spheres.insert(spheres.begin(), {Vector3d::Zero(), 2.0});
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
}

// Each of them overlaps many others, and from everywhere between them there is a way out.
TEST(ShapesInSpheres, ABlockOfManySpheresEnclosesNoCavity) {
  const auto held = [](double radius, const Vector3d& left_out) {
    std::vector<LinkShape> shapes;
    std::vector<Sphere> spheres;
    for (int i = 0; i < 27; ++i) {
      const Vector3d center(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (center == left_out) continue;
      spheres.push_back({center, radius});
      shapes.push_back(shape_of(SolidSphere{radius}, Pose::from_translation(center)));
    }
    return lie_in_single_spheres(shapes, spheres);
  };
  EXPECT_TRUE(held(0.9, {2, 2, 2}));
  // The middle of eight is sqrt(3/4) away from them; without one in the middle there is a hollow,
  // which is open where the sphere before a face is left out.
  EXPECT_FALSE(held(0.8, {2, 2, 2}));
  EXPECT_FALSE(held(0.9, {0, 0, 0}));
  EXPECT_TRUE(held(0.9, {0, 0, 1}));
}

}  // namespace
}  // namespace spherule::test
