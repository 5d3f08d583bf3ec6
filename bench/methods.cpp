// SPDX-License-Identifier: BSD-3-Clause
#include "bench/methods.h"

#include "bench/checkers/bullet_sphere_checker.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/fcl_sphere_checker.h"
#include "bench/checkers/flat_scan_checker.h"
#include "bench/checkers/tree_checker.h"

#include <utility>

namespace spherule {
std::vector<Method> make_methods(const Workload& workload) {
  const std::size_t triangles = triangle_count(workload);
  const std::size_t spheres = sphere_count(workload);
  std::size_t triangles_and_spheres = 0;
  for (const Body& body : workload.bodies) triangles_and_spheres += body.part.mesh.triangles.size();
  for (const Obstacle& obstacle : workload.obstacles) {
    triangles_and_spheres += obstacle.part.tree->spheres().size();
  }
  std::vector<Method> methods;
  using Setting = FclMeshSetting;
  const auto is_plain = [](const Setting& setting) {
    return setting.precision == Setting::Precision::kDouble &&
           setting.front == Setting::Front::kBoxes;
  };
  for (const Setting& setting : all_fcl_mesh_settings()) {
    const bool rss = setting.volume == Setting::Volume::kObbRss;
    const std::string words = to_string(setting);
    const std::string name =
        is_plain(setting) ? (rss ? kUsualFcl : "fcl-mesh-obb") : "fcl-mesh " + words;
    methods.push_back({name, words, make_fcl_mesh_checker(workload, setting), triangles, false});
  }
  methods.push_back({"fcl-spheres", "Sphere shapes, manager against manager",
                     make_fcl_sphere_checker(workload), spheres, true});
#if defined(SPHERULE_BENCH_BULLET)
  methods.push_back({"bullet-pair-test", "compounds of spheres, contactPairTest for each pair",
                     make_bullet_sphere_checker(workload, BulletQuery::kContactPairTest), spheres,
                     false});
  methods.push_back({"bullet-trees", "their dynamic AABB trees walked to the first contact",
                     make_bullet_sphere_checker(workload, BulletQuery::kTrees), spheres, false});
#endif
  methods.push_back({"brute-force-spheres", "all pairs, single precision, widest vectors",
                     make_flat_scan_checker(workload, FlatScan::kAllPairs), spheres, true});
  methods.push_back({"flat-scan-spheres", "the same behind a sphere around each body",
                     make_flat_scan_checker(workload, FlatScan::kSpheresInFront), spheres, false});
  methods.push_back({"spherule-single", "sphere trees, one configuration a call",
                     make_tree_checker(workload, TreeMode::kSingle), spheres, false});
  methods.push_back({"spherule-batch", "sphere trees, many configurations a call",
                     make_tree_checker(workload, TreeMode::kBatch), spheres, false});
  methods.push_back({"spherule-confirmed", "the first, contacts confirmed on the triangles",
                     make_tree_checker(workload, TreeMode::kConfirmed), spheres, false});
  methods.push_back({"spherule-mesh", "meshes of robot and torch, spheres of the rest",
                     make_tree_checker(workload, TreeMode::kMeshes), triangles_and_spheres, false});
  if (best_instruction_set() == InstructionSet::kAvx512) {
    methods.push_back({"spherule-batch-avx2", "many configurations a call, without AVX-512",
                       make_tree_checker(workload, TreeMode::kBatch, InstructionSet::kAvx2),
                       spheres, false});
  }
  return methods;
}

}  // namespace spherule
