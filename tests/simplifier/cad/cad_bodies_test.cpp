// SPDX-License-Identifier: BSD-3-Clause
// The bodies of an assembly: their names and places, and that fitting them together is fitting each
// alone. Where the bodies are, OpenCASCADE says.
#include "base/error.h"
#include "io/cad/cad_file.h"
#include "simplifier/bodies.h"
#include "tests/simplifier/cad/cad_assembly.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace spherule::test::cad_bodies_test {
namespace {

std::vector<Body> bodies_of(std::vector<CadBody> read) {
  std::vector<Body> bodies;
  for (CadBody& body : read) {
    bodies.push_back({.name = body.name, .mesh = std::move(body.part.mesh), .copy = body.copy});
  }
  return bodies;
}

std::vector<std::string> names_of(const std::vector<CadBody>& bodies) {
  std::vector<std::string> names;
  for (const CadBody& body : bodies) names.push_back(body.name);
  return names;
}

TEST(CadBodies, AreNamedByTheirPlacesInTheAssembly) {
  const TempDir folder;
  write_assembly(box_parts(2, 2), folder.path() / "plain.step");
  EXPECT_EQ(
      names_of(read_cad_bodies(folder.path() / "plain.step")),
      (std::vector<std::string>{"CELL/PART_0", "CELL/PART_0:2", "CELL/PART_1", "CELL/PART_1:2"}));
  write_assembly(box_parts(1, 2), folder.path() / "named.step", true);
  EXPECT_EQ(names_of(read_cad_bodies(folder.path() / "named.step")),
            (std::vector<std::string>{"CELL/PART_0 no 1", "CELL/PART_0 no 2"}));
}

// One file, read as a whole and by bodies, has the same triangles in the same places.
TEST(CadBodies, TogetherAreTheWholePart) {
  const TempDir folder;
  write_assembly(box_parts(3, 3), folder.path() / "all.step");
  for (const double scale : {1.0, 0.001}) {
    const TriangleMesh whole = read_cad(folder.path() / "all.step", {.scale = scale}).mesh;
    const std::vector<Body> bodies =
        bodies_of(read_cad_bodies(folder.path() / "all.step", {.scale = scale}));
    ASSERT_EQ(bodies.size(), 9u);
    std::vector<Eigen::Vector3d> corners;
    std::size_t triangles = 0;
    for (const Body& body : bodies) {
      const TriangleMesh& mesh = body.copy ? bodies[body.copy->of].mesh : body.mesh;
      triangles += mesh.triangles.size();
      for (const Eigen::Vector3d& v : mesh.vertices) {
        corners.push_back(body.copy ? body.copy->pose * v : v);
      }
    }
    EXPECT_EQ(std::count_if(bodies.begin(), bodies.end(), [](const Body& b) { return b.copy; }), 6);
    EXPECT_EQ(triangles, whole.triangles.size());
    for (const Eigen::Vector3d& v : whole.vertices) {
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& c) {
        return (c - v).norm() <= 1e-9 * scale;
      }));
    }
  }
}

// Also of a compound without any product, and of IGES.
TEST(CadBodies, SolidsOfAPartAreBodies) {
  const TempDir folder;
  write_step(assembly(), folder.path() / "two.step");
  const std::vector<CadBody> bodies = read_cad_bodies(folder.path() / "two.step");
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_NE(bodies[0].name, bodies[1].name);
  write_step(shape_named("torus"), folder.path() / "one.step");
  const std::vector<CadBody> one = read_cad_bodies(folder.path() / "one.step");
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].part.mesh.vertices, read_cad(folder.path() / "one.step").mesh.vertices);
  write_iges(shape_named("torus"), folder.path() / "one.iges");
  EXPECT_EQ(read_cad_bodies(folder.path() / "one.iges").size(), 1u);
}

TEST(CadBodies, TheUnitOfTheFileIsTold) {
  const TempDir folder;
  write_step(shape_named("torus"), folder.path() / "one.step", "INCH");
  EXPECT_EQ(read_cad(folder.path() / "one.step").stated_unit, "inch");
  EXPECT_EQ(read_cad_bodies(folder.path() / "one.step").front().part.stated_unit, "inch");
}

// More than a hundred bodies: each as if it were fitted alone, on one thread and on two; what
// OpenCASCADE has on the faces of each in its place lies in its spheres.
TEST(CadBodies, AHundredBodiesAreFittedAsEachAlone) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TempDir folder;
  const int kinds = effort(12, 2);
  const std::vector<AssemblyPart> parts = box_parts(kinds, 9);
  write_assembly(parts, folder.path() / "all.step");
  const std::vector<Body> bodies = bodies_of(read_cad_bodies(folder.path() / "all.step"));
  ASSERT_EQ(bodies.size(), 9u * parts.size());
  SimplifyOptions options{.max_error = 4.0, .effort = 0};
  options.threads = 1;
  const std::vector<BodyFit> fits = fit_bodies(bodies, options);
  options.threads = 2;
  const std::vector<BodyFit> again = fit_bodies(bodies, options);
  ASSERT_EQ(fits.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    EXPECT_EQ(fits[i].broken, "") << bodies[i].name;
    EXPECT_TRUE(fits[i].certificate.covered) << bodies[i].name;
    ASSERT_TRUE(
        std::ranges::equal(fits[i].spheres, again[i].spheres, [](const Sphere& a, const Sphere& b) {
          return a.center == b.center && a.radius == b.radius;
        }));
    if (!bodies[i].copy && i < 27) {
      const Simplification alone = simplify(bodies[i].mesh, options);
      EXPECT_TRUE(std::ranges::equal(fits[i].spheres, alone.cover.spheres,
                                     [](const Sphere& a, const Sphere& b) {
                                       return a.center == b.center && a.radius == b.radius;
                                     }));
    }
    const AssemblyPart& part = parts[i / 9];
    for (const Eigen::Vector3d& p : points_of(part.shape.Moved(part.places[i % 9]), 40)) {
      EXPECT_TRUE(std::ranges::any_of(fits[i].spheres, [&](const Sphere& s) {
        return (p - s.center).norm() <= s.radius;
      })) << bodies[i].name;
    }
  }
  const SphereFile file = sphere_file(bodies, fits, std::vector<double>(bodies.size(), 1.0));
  EXPECT_TRUE(file.certificate->covered);
  EXPECT_EQ(file.bodies.size(), bodies.size());
}

}  // namespace
}  // namespace spherule::test::cad_bodies_test
