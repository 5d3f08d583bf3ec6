// SPDX-License-Identifier: BSD-3-Clause
// What the methods of comparison make of a mesh, as files: `spherule_baseline METHOD MESH -o OUT`.
// Lengths are in the unit of the mesh. Prints what was measured or proved as JSON.
#include "base/files.h"
#include "bench/baseline/mesh_methods.h"
#include "bench/baseline/sphere_methods.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "simplifier/simplify.h"
#include "tests/support/program.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <functional>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string mesh;
  std::string output;
  bool conservative = false;
  bool surface = false;
  bool inflated = false;
  double max_error = 0.0;
  double min_external = 0.0;
  std::vector<std::size_t> counts = {1, 8, 64, 512};
  DecimationOptions decimation;
  ConvexHullOptions hull;
  ConvexDecompositionOptions decomposition;
  VoxelisationOptions voxels;
  SpherePackingOptions packing;
  LevelSetPackingOptions level_set;
  MedialAxisOptions medial;
  OctreeSpheresOptions octree;

  Filling filling() const { return surface ? Filling::kSurface : Filling::kSolid; }
};

// The parts as an OBJ file, with all digits of a double: a hull stays one.
std::string obj_text(const std::vector<TriangleMesh>& parts) {
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  int first = 1;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out << "o part-" << i + 1 << '\n';
    for (const Eigen::Vector3d& v : parts[i].vertices) {
      out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    for (const Eigen::Vector3i& t : parts[i].triangles) {
      out << "f " << t[0] + first << ' ' << t[1] + first << ' ' << t[2] + first << '\n';
    }
    first += static_cast<int>(parts[i].vertices.size());
  }
  return out.str();
}

Json to_json(const MeshDeviation& deviation) {
  return {{"loss", {deviation.loss.lower, deviation.loss.upper}},
          {"excess", {deviation.excess.lower, deviation.excess.upper}}};
}

// Writes meshes; returns the figures.
Json write_meshes(const std::vector<TriangleMesh>& parts, const MeshDeviation& deviation,
                  const Arguments& arguments) {
  write_file_atomically(arguments.output, obj_text(parts));
  Json figures{{"parts", parts.size()}, {"triangles", join_parts(parts).triangles.size()}};
  figures.update(to_json(deviation));
  return figures;
}

Json write_certified(std::vector<Sphere> spheres, const Certificate& certificate,
                     const Arguments& arguments) {
  SphereFile file;
  file.spheres = std::move(spheres);
  file.certificate = record(certificate);
  save_spheres(file, arguments.output);
  Json figures{{"sphere_count", file.spheres.size()}};
  figures["certificate"] = {
      {"covered", certificate.covered},
      {"uncovered_depth", {certificate.uncovered_depth.lower, certificate.uncovered_depth.upper}}};
  if (certificate.protrusion_over_mesh) {
    figures["certificate"]["protrusion_over_mesh_max"] = certificate.protrusion_over_mesh->upper;
  }
  if (certificate.protrusion_over_simplified_max) {
    figures["certificate"]["protrusion_over_simplified_max"] =
        *certificate.protrusion_over_simplified_max;
  }
  return figures;
}

// Writes spheres with the certificate that `spherule audit` comes to; returns the figures.
Json write_spheres(std::vector<Sphere> spheres, const TriangleMesh& mesh,
                   const Arguments& arguments) {
  if (spheres.empty()) throw Error(arguments.mesh, "no sphere of that size fits inside");
  if (!arguments.conservative) {
    const Certificate certificate = certify(mesh, spheres);
    return write_certified(std::move(spheres), certificate, arguments);
  }
  ConservativeSpheres made = made_conservative(mesh, spheres);
  Json figures = write_certified(std::move(made.spheres), made.certificate, arguments);
  figures["growth"] = made.inflation;
  return figures;
}

// Stage 2 by another method, after stage 1, certified as a fit is.
Json cover_by(const Stage2Method& method, const TriangleMesh& mesh, const Arguments& arguments) {
  SimplifyOptions options;
  options.max_error = arguments.max_error;
  options.min_external_diameter = arguments.min_external;
  options.stage2_method = method;
  Simplification made = simplify(mesh, options);
  return write_certified(std::move(made.cover.spheres), made.certificate, arguments);
}

// A method: what its help says, the options that only it takes, and the call.
struct Method {
  const char* name;
  const char* summary;
  void (*add_options)(CLI::App&, Arguments&);
  Json (*run)(const TriangleMesh&, const Arguments&);
};

void add_error(CLI::App& command, double& error) {
  command.add_option("--max-error", error, "E")->check(CLI::PositiveNumber);
}

void add_fit_options(CLI::App& command, Arguments& arguments) {
  add_error(command, arguments.max_error);
  command.get_option("--max-error")->required();
  command.add_option("--min-external", arguments.min_external, "D")->check(CLI::PositiveNumber);
}

const std::map<std::string, VoxelSphere> kVoxelSpheres = {
    {"circumscribed", VoxelSphere::kCircumscribed}, {"inscribed", VoxelSphere::kInscribed}};
const std::map<std::string, SphereReduction> kReductions = {{"merge", SphereReduction::kMerge},
                                                            {"burst", SphereReduction::kBurst},
                                                            {"expand", SphereReduction::kExpand},
                                                            {"best", SphereReduction::kBest}};

const std::vector<Method> kMethods = {
    {"decimate", "Fewer triangles by quadric error (meshoptimizer); not conservative",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--triangles", arguments.decimation.target_triangles)->required();
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       const Decimation made = decimate(mesh, arguments.decimation);
       return write_meshes({made.mesh}, made.deviation, arguments);
     }},
    {"hull", "Convex hull (qhull); conservative",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--padding", arguments.hull.padding);
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       const ConvexHull made = convex_hull(mesh, arguments.hull);
       return write_meshes({made.mesh}, measure_deviation(mesh, made.mesh), arguments);
     }},
    {"decompose", "Approximate convex decomposition (HACD); not conservative",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--concavity", arguments.decomposition.max_concavity);
       command.add_option("--parts", arguments.decomposition.min_parts);
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       const ConvexDecomposition made = decompose(mesh, arguments.decomposition);
       return write_meshes(made.parts, made.deviation, arguments);
     }},
    {"voxelise", "A sphere for every voxel; around it they cover, of its width they do not",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--step", arguments.voxels.step, "Edge of a voxel");
       add_error(command, arguments.voxels.max_error);
       command.add_option("--ball", arguments.voxels.sphere)
           ->transform(CLI::CheckedTransformer(kVoxelSpheres));
       command.add_flag("--surface", arguments.surface, "Without the inside");
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       VoxelisationOptions options = arguments.voxels;
       options.filling = arguments.filling();
       return write_spheres(voxelise(mesh, options).spheres, mesh, arguments);
     }},
    {"pack", "The paper's packing of the solid; not conservative unless inflated",
     [](CLI::App& command, Arguments& arguments) {
       add_error(command, arguments.packing.max_error);
       command.add_option("--closed-below", arguments.packing.closed_below);
       command.add_flag("--inflated", arguments.inflated, "Grown by the proved error");
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       SpherePacking made = pack_spheres(mesh, arguments.packing);
       return write_spheres(arguments.inflated ? made.inflated : made.spheres, mesh, arguments);
     }},
    {"fill", "The largest spheres inside of a level set (OpenVDB); not conservative",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--step", arguments.level_set.step, "Edge of a voxel")->required();
       command.add_option("--min-radius", arguments.level_set.min_radius);
       command.add_option("--spheres", arguments.level_set.max_spheres);
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       return write_spheres(level_set_packing(mesh, arguments.level_set), mesh, arguments);
     }},
    {"medial", "Adaptive medial-axis approximation (AMAA); not conservative",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--spheres", arguments.medial.spheres);
       command.add_option("--max-protrusion", arguments.medial.max_protrusion);
       command.add_option("--reduction", arguments.medial.reduction)
           ->transform(CLI::CheckedTransformer(kReductions));
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       return write_spheres(medial_axis(mesh, arguments.medial).spheres, mesh, arguments);
     }},
    {"octree", "The octree of Liu, Palmer and Grimsdale; the spheres around cubes cover",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--depth", arguments.octree.depth, "Halvings of the cube");
       add_error(command, arguments.octree.max_error);
       command.add_flag("--surface", arguments.surface, "Without the inside");
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       OctreeSpheresOptions options = arguments.octree;
       options.filling = arguments.filling();
       const OctreeSpheres made = octree_spheres(mesh, options);
       return write_spheres({made.tree.spheres().begin(), made.tree.spheres().end()}, mesh,
                            arguments);
     }},
    {"hubbard", "Hubbard's medial spheres, merged to levels, of which the last is written",
     [](CLI::App& command, Arguments& arguments) {
       command.add_option("--counts", arguments.counts)->delimiter(',');
     },
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       HubbardOptions options;
       options.counts = arguments.counts;
       return write_spheres(hubbard_spheres(mesh, options).levels.back(), mesh, arguments);
     }},
    {"cover-medial", "Stage 2 of a fit by AMAA, after stage 1; proved", add_fit_options,
     [](const TriangleMesh& mesh, const Arguments& arguments) {
       return cover_by({"medial", medial_cover}, mesh, arguments);
     }}};

int run(int count, char** values) {
  CLI::App app("Makes what other methods make of a mesh: OBJ or SPHERES.json");
  app.require_subcommand(1);
  Arguments arguments;
  for (const Method& method : kMethods) {
    CLI::App* command = app.add_subcommand(method.name, method.summary);
    command->add_option("mesh", arguments.mesh)->required();
    command->add_option("-o,--output", arguments.output)->required();
    command->add_flag("--conservative", arguments.conservative,
                      "Grow every sphere by the proved uncovered depth, so that they cover");
    method.add_options(*command, arguments);
    command->callback([&method, &arguments] {
      check_writable(arguments.output);
      const TriangleMesh mesh = read_mesh(arguments.mesh);
      std::printf("%s\n", method.run(mesh, arguments).dump(1).c_str());
    });
  }
  CLI11_PARSE(app, count, values);
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_baseline", [&] { return spherule::run(count, values); });
}
