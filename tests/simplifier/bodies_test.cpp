// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/bodies.h"

#include "base/error.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace spherule::test {
namespace {

const Pose kTurned(Eigen::Quaterniond(Eigen::AngleAxisd(0.7,
                                                        Eigen::Vector3d(1, 2, 3).normalized())),
                   {10, -20, 1.0 / 3.0});

std::vector<Body> bracket_and_copy() {
  return {{.name = "bracket", .mesh = l_bracket()},
          {.name = "copy", .mesh = {}, .copy = BodyCopy{0, kTurned}},
          {.name = "cube", .mesh = cube_mesh()}};
}

SimplifyOptions coarse() {
  return {.max_error = 0.15, .effort = 0};
}

// In extended precision, with the quaternion that the pose holds.
TEST(Bodies, MovedSpheresHoldTheExactlyMovedOnes) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  std::vector<Sphere> spheres;
  for (int i = 0; i < 200; ++i) {
    spheres.push_back({{1e3 * std::sin(i), 1e-3 * i, 7.0 / (i + 1)}, i == 0 ? 0.0 : 1.0 / i});
  }
  const std::vector<Sphere> moved = moved_spheres(spheres, kTurned);
  const Eigen::Quaternion<long double> q = kTurned.rotation().cast<long double>().normalized();
  ASSERT_EQ(moved.size(), spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector exact = q * Vector(spheres[i].center.cast<long double>()) +
                         Vector(kTurned.translation().cast<long double>());
    const long double miss = (Vector(moved[i].center.cast<long double>()) - exact).norm();
    EXPECT_LE(miss + static_cast<long double>(spheres[i].radius), moved[i].radius);
    EXPECT_LE(moved[i].radius - spheres[i].radius, 1e-10);
  }
}

// Against the mesh of the copy in its place, which the fit has not seen.
TEST(Bodies, ACopyIsCoveredAsItsOriginalIs) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const std::vector<Body> bodies = bracket_and_copy();
  const std::vector<BodyFit> fits = fit_bodies(bodies, coarse());
  ASSERT_EQ(fits.size(), 3u);
  for (const BodyFit& fit : fits) EXPECT_EQ(fit.broken, "");
  EXPECT_EQ(fits[0].spheres, simplify(l_bracket(), coarse()).cover.spheres);
  const TriangleMesh placed = moved(l_bracket(), kTurned.isometry());
  EXPECT_TRUE(certify(placed, fits[1].spheres).covered);
  EXPECT_FALSE(certify(placed, fits[0].spheres).covered);
  EXPECT_TRUE(fits[1].certificate.covered);
  EXPECT_GT(*fits[1].certificate.protrusion_over_simplified_max,
            *fits[0].certificate.protrusion_over_simplified_max);
  const SphereFile file = sphere_file(bodies, fits, std::vector<double>(3, 1.0));
  EXPECT_EQ(file.spheres.size(),
            fits[0].spheres.size() + fits[1].spheres.size() + fits[2].spheres.size());
  EXPECT_TRUE(file.certificate->covered);
  EXPECT_EQ(file.certificate->protrusion_over_simplified_max,
            std::max(fits[1].certificate.protrusion_over_simplified_max,
                     fits[2].certificate.protrusion_over_simplified_max));
}

TEST(Bodies, WhatIsNotBegunWhenStoppedIsNotCovered) {
  const std::vector<Body> bodies = bracket_and_copy();
  std::stop_source stop;
  stop.request_stop();
  SimplifyOptions options = coarse();
  options.stop = stop.get_token();
  const std::vector<BodyFit> fits = fit_bodies(bodies, options);
  for (const BodyFit& fit : fits) {
    EXPECT_TRUE(fit.spheres.empty());
    EXPECT_FALSE(fit.certificate.covered);
    EXPECT_NE(fit.broken, "");
    EXPECT_TRUE(fit.interrupted);
  }
  EXPECT_FALSE(sphere_file(bodies, fits, std::vector<double>(3, 1.0)).certificate->covered);
}

// The first answer queries the stop: on one thread that body is all there is.
TEST(Bodies, AStopKeepsWhatIsProved) {
  const std::vector<Body> bodies = bracket_and_copy();
  std::stop_source stop;
  SimplifyOptions options = coarse();
  options.threads = 1;
  options.stop = stop.get_token();
  options.on_proved = [&](std::size_t) { stop.request_stop(); };
  const std::vector<BodyFit> fits = fit_bodies(bodies, options);
  EXPECT_EQ(fits[0].broken, "");
  EXPECT_EQ(fits[1].broken, "");
  EXPECT_NE(fits[2].broken, "");
  const SphereFile file = sphere_file(bodies, fits, std::vector<double>(3, 1.0));
  EXPECT_TRUE(file.interrupted);
  for (const BodyRecord& body : file.bodies) EXPECT_TRUE(body.interrupted) << body.name;
}

TEST(Bodies, AStopAfterTheSearchMarksNothing) {
  const std::vector<Body> bodies = bracket_and_copy();
  std::stop_source stop;
  SimplifyOptions options = coarse();
  options.stop = stop.get_token();
  const std::vector<BodyFit> fits = fit_bodies(bodies, options);
  stop.request_stop();
  const SphereFile file = sphere_file(bodies, fits, std::vector<double>(3, 1.0));
  EXPECT_FALSE(file.interrupted);
  for (const BodyRecord& body : file.bodies) EXPECT_FALSE(body.interrupted) << body.name;
}

TEST(Bodies, WhatIsWrongNamesTheBody) {
  const auto error = [](const std::vector<Body>& bodies, const SimplifyOptions& options) {
    try {
      fit_bodies(bodies, options);
    } catch (const Error& fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  std::vector<Body> bodies = bracket_and_copy();
  bodies[2].mesh.triangles.front()[0] = 99;
  EXPECT_TRUE(error(bodies, coarse()).starts_with("cube: ")) << error(bodies, coarse());
  bodies = bracket_and_copy();
  bodies[1].copy->of = 2;
  EXPECT_TRUE(error(bodies, coarse()).starts_with("copy: ")) << error(bodies, coarse());
  SimplifyOptions options = coarse();
  options.levels = {0.2, 0.4};
  EXPECT_TRUE(error(bracket_and_copy(), options).starts_with("levels: "));
}

}  // namespace
}  // namespace spherule::test
