// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/triangle_mesh.h"

namespace spherule {

ConservativeSpheres made_conservative(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                      double padding, int threads, const Progress& progress) {
  if (spheres.empty()) throw Error("spheres", "there is none that could grow");
  const CertifyOptions options{.padding = padding, .threads = threads, .progress = progress};
  ConservativeSpheres result;
  result.spheres.assign(spheres.begin(), spheres.end());
  result.certificate = certify(mesh, spheres, options);
  if (result.certificate.covered) return result;
  // A piece of the proof's finest size lies in one sphere only if it has room to spare there.
  const double piece = options.resolution * internal::box_of(mesh).diagonal().norm();
  result.inflation = add_up(result.certificate.uncovered_depth.upper, piece);
  for (Sphere& sphere : result.spheres) {
    sphere.radius = add_up(sphere.radius, result.inflation);
    if (!is_usable(sphere)) throw Error("spheres", "too far from the mesh to be grown over it");
  }
  result.certificate = certify(mesh, result.spheres, options);
  return result;
}

}  // namespace spherule
