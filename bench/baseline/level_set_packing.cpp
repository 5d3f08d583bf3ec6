// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <limits>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToSpheres.h>

namespace spherule {
namespace {

constexpr double kMostSteps = 4096.0;  // along the box diagonal
constexpr double kLeastRadius = 0.5;   // steps
constexpr float kHalfWidth = 3.0F;     // of the level set's band, in voxels

void check(const LevelSetPackingOptions& options, double diagonal) {
  if (!(options.step > 0.0 && options.step >= diagonal / kMostSteps &&
        options.step <= kMaxCoordinate)) {
    throw Error("step", "must be positive and at least 1/4096 of the box diagonal");
  }
  if (!(options.min_radius >= 0.0 && options.min_radius <= kMaxCoordinate)) {
    throw Error("min radius", "must be finite and not negative");
  }
  internal::check_samples("max spheres", options.max_spheres);
  internal::check_samples("candidates", options.candidates);
  internal::check_threads(options.threads);
}

}  // namespace

std::vector<Sphere> level_set_packing(const TriangleMesh& mesh,
                                      const LevelSetPackingOptions& options) {
  validate(mesh, "mesh");
  const Eigen::AlignedBox3d box = internal::box_of(mesh);
  check(options, box.diagonal().norm());
  const internal::ThreadLimit limit(options.threads);

  // In steps from a corner of the box: floats then err by little of a step.
  std::vector<openvdb::Vec3s> points;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3f p = ((vertex - box.min()) / options.step).cast<float>();
    points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<openvdb::Vec3I> triangles;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    triangles.emplace_back(static_cast<openvdb::Index32>(t[0]), static_cast<openvdb::Index32>(t[1]),
                           static_cast<openvdb::Index32>(t[2]));
  }
  const auto least = static_cast<float>(options.min_radius > 0.0 ? options.min_radius / options.step
                                                                 : kLeastRadius);
  std::vector<openvdb::Vec4s> packed;
  try {
    openvdb::initialize();
    const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
    const auto grid =
        openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*unit, points, triangles, kHalfWidth);
    openvdb::tools::fillWithSpheres(
        *grid, packed, openvdb::Vec2i(1, static_cast<int>(options.max_spheres)), true, least,
        std::numeric_limits<float>::max(), 0.0F, static_cast<int>(options.candidates));
  } catch (const openvdb::Exception& error) {
    throw Error("level set", error.what());
  }
  std::vector<Sphere> spheres;
  for (const openvdb::Vec4s& sphere : packed) {
    // One sphere at least the library makes, however small.
    if (!(sphere[3] >= least)) continue;
    spheres.push_back({box.min() + options.step * Eigen::Vector3d(sphere[0], sphere[1], sphere[2]),
                       options.step * static_cast<double>(sphere[3])});
  }
  return spheres;
}

}  // namespace spherule
