// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/paper/paper.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "simplifier/simplify.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

namespace spherule {
namespace {

constexpr int kMostTries = 5;
// The search ends where the protrusion comes this near to what is allowed, or two settings, of
// which one does and the other does not, this near to each other.
constexpr double kNear = 0.95;
constexpr double kAim = 0.985;
// Of the limit: a protrusion that such a setting does not mend (a sealed cavity that is filled) is
// there at any.
constexpr double kFinest = 0.1;

// Searches for the largest setting whose protrusion keeps to a limit, which it nearly reaches.
class SettingSearch {
 public:
  explicit SettingSearch(double limit) : limit_(limit), setting_(limit) {}

  double setting() const { return setting_; }

  // Takes what came of the setting and moves on to the next; false at the end of the search.
  bool advance(double protrusion, bool holds) {
    const Point at{setting_, protrusion};
    if (holds) {
      held_ = std::max(held_, setting_);
    } else {
      broke_ = broke_ == 0.0 ? setting_ : std::min(broke_, setting_);
    }
    if (holds && protrusion >= kNear * limit_) return false;
    const bool is_bracketed = held_ > 0.0 && broke_ > held_;
    // More spheres may have grown less, so that a finer setting broke before a coarser one held.
    if (held_ > 0.0 && broke_ > 0.0 && kNear * broke_ < held_) return false;
    setting_ = at.setting * std::clamp(aim_from(at) / at.setting, 0.25, 1.6);
    if (is_bracketed && !(setting_ > held_ && setting_ < broke_)) {
      setting_ = std::sqrt(held_ * broke_);
    }
    last_ = at;
    return true;
  }

 private:
  struct Point {
    double setting = 0.0;
    double protrusion = 0.0;
  };

  // On the line through the last two points, or through this one and the origin.
  double aim_from(const Point& at) const {
    const double aim = kAim * limit_;
    const double slope = (at.protrusion - last_.protrusion) / (at.setting - last_.setting);
    return slope > 0.0 ? at.setting + (aim - at.protrusion) / slope
                       : at.setting * aim / at.protrusion;
  }

  double limit_;
  double setting_;
  double held_ = 0.0;   // the largest that kept to the limit; 0: none yet
  double broke_ = 0.0;  // the smallest that did not
  Point last_;
};

// Some files store a vertex several times with other roundings. Of an open mesh no proof says what
// is inside, so that cracks would decide what protrudes.
TriangleMesh read_shut(const std::filesystem::path& file) {
  constexpr double kCrack = 1e-6;  // of the diagonal
  const TriangleMesh mesh = read_mesh(file);
  const MeshReport report = mesh_report(mesh, {.self_intersections = false});
  return report.closed ? mesh : read_mesh(file, {.weld = kCrack * report.box.diagonal().norm()});
}

}  // namespace

CountEntry fewest_spheres(const TriangleMesh& mesh, const SphereMethod& method,
                          double max_protrusion) {
  CountEntry best{.method = method.name};
  SettingSearch search(max_protrusion);
  for (int i = 0; i < kMostTries && search.setting() >= kFinest * max_protrusion; ++i) {
    CountEntry entry{.method = method.name, .setting = search.setting()};
    const auto start = std::chrono::steady_clock::now();
    ConservativeSpheres proved;
    try {
      const std::vector<Sphere> spheres = method.make(mesh, entry.setting);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      entry.seconds = elapsed.count();
      proved = made_conservative(mesh, spheres);
    } catch (const Error& error) {
      std::printf("    %s, error %g: %s\n", entry.method.c_str(), entry.setting, error.what());
      break;
    }
    entry.protrusion = proved.certificate.protrusion_over_mesh->upper;
    entry.inflation = proved.inflation;
    const bool holds = proved.certificate.covered && entry.protrusion <= max_protrusion;
    if (holds) entry.spheres = proved.spheres.size();
    if (holds ? best.spheres == 0 || entry.spheres < best.spheres : best.spheres == 0) best = entry;
    if (!search.advance(entry.protrusion, holds)) break;
  }
  return best;
}

CountRow compare_counts(const NamedMesh& part, const std::function<void(const CountEntry&)>& done) {
  const double diagonal =
      mesh_report(part.mesh, {.self_intersections = false}).box.diagonal().norm();
  CountRow row{part.name, part.mesh.triangles.size(), diagonal, kEqualProtrusion * diagonal, {}};
  for (const SphereMethod& method : sphere_methods()) {
    row.entries.push_back(fewest_spheres(part.mesh, method, row.max_protrusion));
    done(row.entries.back());
  }
  return row;
}

std::vector<NamedMesh> own_parts() {
  return {{"pipe", make_paper_pipe()},
          {"plate, 50 holes", make_plate_with_holes({0.24, 0.12, 0.01}, 10, 5, 0.006, 12)},
          {"bracket", make_l_bracket(0.1, 0.06, 0.008)}};
}

std::vector<NamedMesh> real_parts(const std::filesystem::path& models) {
  const std::filesystem::path folder = models / "parts";
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::filesystem::path& file = entry->path();
    if (!file.filename().string().starts_with("LICENSE")) files.push_back(file);
  }
  if (failed) throw Error(folder.string(), failed.message());
  if (files.empty()) throw Error(folder.string(), "no meshes there");
  std::sort(files.begin(), files.end());
  std::vector<NamedMesh> parts;
  for (const auto& file : files) parts.push_back({file.stem().string(), read_shut(file)});
  return parts;
}

void print_count(const CountEntry& entry) {
  std::printf("    %-12s %6zu spheres, %.1f s\n", entry.method.c_str(), entry.spheres,
              entry.seconds);
  std::fflush(stdout);
}

void print_counts(const std::vector<CountRow>& rows) {
  if (rows.empty()) return;
  std::printf("\nspheres that hold a part and protrude by at most %.0f %% of its diagonal\n%-26s",
              100.0 * kEqualProtrusion, "part");
  for (const CountEntry& entry : rows.front().entries) {
    std::printf(" %12s", entry.method.c_str());
  }
  std::printf("\n");
  for (const CountRow& row : rows) {
    std::printf("%-26s", row.part.c_str());
    for (const CountEntry& entry : row.entries) std::printf(" %12zu", entry.spheres);
    std::printf("\n");
  }
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

}  // namespace spherule
