// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/fit_parts.h"

#include "base/error.h"
#include "spheretree/build.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

namespace spherule {

void print_fit(const FitRecord& fit) {
  std::printf("  %s: %zu spheres, %.1f s\n", fit.part.c_str(), fit.spheres, fit.seconds);
  std::fflush(stdout);
}

void check_promises(const Simplification& fit, const std::string& part) {
  const std::string broken = broken_promises(fit);
  if (!broken.empty()) throw Error(part, broken);
}

namespace {

FitRecord fit(Part& part, int effort) {
  SimplifyOptions options;
  options.max_error = part.max_error;
  options.min_external_diameter = part.min_external_diameter;
  options.effort = effort;
  const auto start = std::chrono::steady_clock::now();
  const Simplification result = simplify(part.mesh, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  check_promises(result, part.name);
  part.tree = std::make_shared<const SphereTree>(build_tree(result.cover.spheres));
  return {part.name,
          part.mesh.triangles.size(),
          result.cover.spheres.size(),
          part.max_error,
          part.min_external_diameter,
          elapsed.count(),
          true};
}

}  // namespace

std::vector<FitRecord> fit_parts(Workload& workload,
                                 const std::function<void(const FitRecord&)>& done, int effort) {
  std::vector<FitRecord> records;
  const auto add = [&](Part& part) {
    records.push_back(fit(part, effort));
    done(records.back());
  };
  for (Body& body : workload.bodies) add(body.part);
  for (Obstacle& obstacle : workload.obstacles) add(obstacle.part);
  return records;
}

}  // namespace spherule
