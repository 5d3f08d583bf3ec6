// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/representations.h"

#include "base/error.h"
#include "bench/baseline/mesh_methods.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/paper/figures.h"
#include "geometry/mesh_report.h"
#include "simplifier/simplify.h"
#include "spheretree/build.h"
#include "tests/support/fcl_models.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/solids.h"

#include <fcl/geometry/shape/convex.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

namespace spherule {
namespace {

// The narrowest way into the workpiece is its bore of 34 mm.
constexpr double kNothingNarrower = 0.010;
// Of the decomposition's parts: a tenth of a pipe.
constexpr double kConcavity = 0.004;

std::size_t workpiece_index(const Workload& workload) {
  const auto found =
      std::find_if(workload.obstacles.begin(), workload.obstacles.end(),
                   [](const Obstacle& obstacle) { return obstacle.part.name == "workpiece"; });
  if (found == workload.obstacles.end()) throw Error(workload.name, "has no workpiece");
  return static_cast<std::size_t>(found - workload.obstacles.begin());
}

std::string count(std::size_t number, const char* what) {
  return std::to_string(number) + ' ' + what;
}

std::vector<Sphere> by_papers_loop(const Part& part) {
  const Simplification result =
      simplify(part.mesh, {.max_error = part.max_error,
                           .min_external_diameter = part.min_external_diameter,
                           .method = CoverMethod::kPaper,
                           .external = ExternalPlacement::kRandom});
  if (!result.certificate.covered) throw Error(part.name, broken_promises(result));
  return result.cover.spheres;
}

class Rows {
 public:
  explicit Rows(const Workload& workload)
      : workload_(workload),
        index_(workpiece_index(workload)),
        part_(workload.obstacles[index_].part) {}

  const Part& part() const { return part_; }

  void add(Representation row) {
    std::printf("  %s: %s\n", row.method.c_str(), row.complexity.c_str());
    std::fflush(stdout);
    rows_.push_back(std::move(row));
  }

  // The workpiece as another mesh, as convex parts, or as spheres.
  void add_mesh(std::string method, const TriangleMesh& mesh, bool is_conservative,
                std::optional<PaperRow> paper) {
    Workload changed = workload_;
    changed.obstacles[index_].part.mesh = mesh;
    add({std::move(method), count(mesh.triangles.size(), "triangles"), is_conservative,
         make_fcl_mesh_checker(changed, {}), std::move(paper)});
  }
  void add_convex(std::string method, const std::vector<TriangleMesh>& parts,
                  bool is_conservative) {
    add({std::move(method), count(parts.size(), parts.size() == 1 ? "hull" : "hulls"),
         is_conservative, make_fcl_convex_checker(workload_, index_, parts)});
  }
  void add_spheres(std::string method, std::span<const Sphere> spheres, bool is_conservative,
                   std::optional<PaperRow> paper = {}) {
    Workload changed = workload_;
    changed.obstacles[index_].part.tree = std::make_shared<const SphereTree>(build_tree(spheres));
    add({std::move(method), count(spheres.size(), "spheres"), is_conservative,
         make_tree_checker(changed, TreeMode::kMeshes), std::move(paper)});
  }

  std::vector<Representation> take() { return std::move(rows_); }

 private:
  const Workload& workload_;
  std::size_t index_;
  const Part& part_;
  std::vector<Representation> rows_;
};

}  // namespace

std::vector<Representation> make_representations(const Workload& workload) {
  Rows rows(workload);
  const Part& part = rows.part();
  const TriangleMesh& mesh = part.mesh;
  rows.add_mesh("original", mesh, true, PaperRow{"1942 triangles", 2032, 1798.0});
  rows.add_mesh("decimated",
                decimate(mesh, {.target_triangles = mesh.triangles.size() / 2, .measure = {}}).mesh,
                false, PaperRow{"996 triangles", 1801, 894.0});
  rows.add_convex("hull", {convex_hull(mesh).mesh}, true);
  rows.add_convex("decomposition",
                  decompose(mesh, {.max_concavity = kConcavity, .measure = {}}).parts, false);
  const SpherePacking packing =
      pack_spheres(mesh, {.max_error = part.max_error, .closed_below = kNothingNarrower});
  rows.add_spheres("packing", packing.spheres, false, PaperRow{"4752 spheres", 2134, 258.0});
  rows.add_spheres("packing-inflated", packing.inflated, true);
  rows.add_spheres("voxels",
                   voxelise(mesh, {.step = kPaperVoxel, .sphere = VoxelSphere::kInscribed}).spheres,
                   false, PaperRow{"2675 spheres", 2865, 170.0});
  rows.add_spheres("voxels-covering", voxelise(mesh, {.step = kPaperVoxel}).spheres, true);
  rows.add_spheres("bounding-paper", by_papers_loop(part), true,
                   PaperRow{"283 spheres", 2222, 102.0});
  rows.add_spheres("bounding-cover", part.tree->spheres(), true);
  rows.add({"all-simplified", count(sphere_count(workload), "spheres"), true,
            make_tree_checker(workload, TreeMode::kSingle), PaperRow{"-", 2289, 7.0}});
  return rows.take();
}

namespace {

constexpr double kAfterStage1 = 4.0;  // D over E
constexpr double kAsIs = 1.0;
constexpr int kEffort = 6;
// Hubbard's method is told a count: that of spheres of radius E side by side on the surface, at
// most.
constexpr double kMostSpheres = 5000.0;
constexpr double kLevelSetStep = 0.25;     // of E
constexpr double kCoverPointsApart = 0.2;  // of E
constexpr double kFewestCoverPoints = 10000.0;
constexpr double kMostCoverPoints = 30000.0;

std::vector<Sphere> bounding(const TriangleMesh& mesh, double error, CoverMethod method,
                             double diameter_over_error) {
  return simplify(mesh, {.max_error = error,
                         .min_external_diameter = diameter_over_error * error,
                         .method = method,
                         .effort = kEffort})
      .cover.spheres;
}

SphereMethod bounding_method(const char* name, CoverMethod method, double diameter_over_error) {
  return {name, [=](const TriangleMesh& mesh, double error) {
            return bounding(mesh, error, method, diameter_over_error);
          }};
}

double area_of(const TriangleMesh& mesh) {
  return mesh_report(mesh, {.self_intersections = false}).area;
}

// Between the points that have to be covered nothing is promised: many enough make it little.
std::vector<Sphere> medial(const TriangleMesh& mesh, double error) {
  MedialAxisOptions options{.max_protrusion = error};
  const double apart = kCoverPointsApart * error;
  options.sampling.cover_points = static_cast<std::size_t>(
      std::clamp(area_of(mesh) / (apart * apart), kFewestCoverPoints, kMostCoverPoints));
  return medial_axis(mesh, options).spheres;
}

std::vector<Sphere> hubbard(const TriangleMesh& mesh, double error) {
  const double spheres = std::clamp(area_of(mesh) / (error * error), 2.0, kMostSpheres);
  HubbardOptions options;
  options.counts = {static_cast<std::size_t>(spheres)};
  options.sites = std::max(options.sites, 2 * options.counts.front());
  return hubbard_spheres(mesh, options).levels.back();
}

}  // namespace

std::vector<SphereMethod> sphere_methods() {
  return {
      {"packing", [](const TriangleMesh& mesh,
                     double error) { return pack_spheres(mesh, {.max_error = error}).inflated; }},
      {"openvdb",
       [](const TriangleMesh& mesh, double error) {
         return level_set_packing(mesh, {.step = kLevelSetStep * error});
       }},
      {"voxels", [](const TriangleMesh& mesh,
                    double error) { return voxelise(mesh, {.max_error = error}).spheres; }},
      {"octree",
       [](const TriangleMesh& mesh, double error) {
         const SphereTree tree = octree_spheres(mesh, {.max_error = error}).tree;
         return std::vector<Sphere>(tree.spheres().begin(), tree.spheres().end());
       }},
      {"hubbard", hubbard},
      {"medial-axis", medial},
      bounding_method("paper", CoverMethod::kPaper, kAfterStage1),
      bounding_method("cover-as-is", CoverMethod::kCover, kAsIs),
      bounding_method("cover", CoverMethod::kCover, kAfterStage1),
  };
}

namespace {

using Model = FclModel<fcl::OBBRSS<double>>;
using Box = Eigen::AlignedBox3d;

std::shared_ptr<fcl::Convex<double>> convex(const TriangleMesh& part) {
  auto vertices =
      std::make_shared<std::vector<fcl::Vector3d>>(part.vertices.begin(), part.vertices.end());
  auto faces = std::make_shared<std::vector<int>>(polygon_list(part));
  return std::make_shared<fcl::Convex<double>>(
      std::move(vertices), static_cast<int>(part.triangles.size()), std::move(faces));
}

class MeshesAndConvexParts : public SingleChecker {
 public:
  MeshesAndConvexParts(const Workload& workload, std::size_t obstacle,
                       const std::vector<TriangleMesh>& parts)
      : SingleChecker(workload.robot) {
    for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
      const Obstacle& standing = workload.obstacles[i];
      const auto pose = fcl_pose<double>(standing.world_from_part);
      if (i != obstacle) {
        const Model model(standing.part.mesh);
        static_.push_back({model.geometry, pose, model.world_box(pose), i});
        continue;
      }
      for (const TriangleMesh& part : parts) {
        const Box box = bounding_box(placed(part, pose.linear(), pose.translation()));
        static_.push_back({convex(part), pose, box, i});
      }
    }
    for (const Body& body : workload.bodies) {
      bodies_.push_back({Model(body.part.mesh), static_cast<std::size_t>(body.link), {}});
      for (std::size_t i = 0; i < static_.size(); ++i) {
        if (is_tested(body, workload.obstacles[static_[i].obstacle])) {
          bodies_.back().against.push_back(i);
        }
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Moving& body) {
      const auto pose = fcl_pose<double>(world_from_link[body.link]);
      const Box box = body.model.world_box(pose);
      return std::any_of(body.against.begin(), body.against.end(), [&](std::size_t i) {
        const Static& other = static_[i];
        if (!box.intersects(other.box)) return false;
        const fcl::CollisionRequest<double> request;  // one contact, not kept
        fcl::CollisionResult<double> result;
        return fcl::collide(body.model.geometry.get(), pose, other.geometry.get(), other.pose,
                            request, result) > 0;
      });
    });
  }

 private:
  struct Static {
    std::shared_ptr<const fcl::CollisionGeometry<double>> geometry;
    fcl::Transform3<double> pose;
    Box box;
    std::size_t obstacle;
  };
  struct Moving {
    Model model;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Static> static_;
  std::vector<Moving> bodies_;
};

}  // namespace

std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts) {
  if (parts.empty()) throw Error(workload.name, "no convex parts");
  return std::make_unique<MeshesAndConvexParts>(workload, obstacle, parts);
}

}  // namespace spherule
