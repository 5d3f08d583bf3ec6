// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/help/help.h"
#include "cli/modules/module.h"
#include "cli/options/options.h"
#include "cli/parts/baseline_spheres.h"
#include "spheretree/build.h"

#include <CLI/CLI.hpp>

#include <limits>
#include <utility>

namespace spherule {
namespace {

const std::map<std::string, VoxelSphere> kSpheres = {{"circumscribed", VoxelSphere::kCircumscribed},
                                                     {"inscribed", VoxelSphere::kInscribed}};
const std::map<std::string, SphereReduction> kReductions = {{"merge", SphereReduction::kMerge},
                                                            {"burst", SphereReduction::kBurst},
                                                            {"expand", SphereReduction::kExpand},
                                                            {"best", SphereReduction::kBest}};

// What options of several methods say.

// Without the check CLI11 takes -1 for the largest number; files store 63 bits.
void add_seed(CLI::App& command, SphereArguments& arguments) {
  command.add_option("--seed", arguments.seed, "Seed of everything random (default: 1)")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
}

void add_surface(CLI::App& command, SphereArguments& arguments) {
  command.add_flag("--surface", arguments.surface,
                   "Only the cells that the surface intersects, none inside");
}

CLI::Option* add_tree_file(CLI::App& command, SphereArguments& arguments, const char* help) {
  return command.add_option("--tree-file", arguments.tree_file, help)->type_name(kFile);
}

void require_one(CLI::App& command, CLI::Option* a, CLI::Option* b) {
  CLI::Option_group* group = command.add_option_group("how finely");
  group->add_options(a, b);
  group->require_option(1);
}

OptionValue stored(std::uint64_t count) {
  return static_cast<std::int64_t>(count);
}

// Only lengths and counts that were requested are stored.
template <typename Number>
void store(MadeSpheres& made, const char* name, Number value, Number unasked) {
  if (value != unasked) made.options[name] = value;
}

// What the spheres around cells cover whatever a certificate can prove: at the corners of cells
// they touch without room to spare.
const char* covered_by_construction(Filling filling) {
  return filling == Filling::kSolid ? "solid" : "surface";
}

Filling filling_of(const SphereArguments& arguments) {
  return arguments.surface ? Filling::kSurface : Filling::kSolid;
}

void add_voxels(CLI::App& command, SphereArguments& arguments) {
  arguments.sphere = "circumscribed";
  CLI::Option* step = arguments.lengths.add_positive(command, "--step", arguments.voxelisation.step,
                                                     "Edge of a voxel");
  require_one(command, step,
              arguments.lengths.add_positive(
                  command, "--max-error", arguments.voxelisation.max_error,
                  "As large as a step may be for spheres around voxels to protrude by no "
                  "more than this"));
  command
      .add_option("--ball", arguments.sphere,
                  "What stands for a voxel: circumscribed, the sphere around it (default), or "
                  "inscribed, the paper's of its width")
      ->check(CLI::IsMember(kSpheres));
  add_surface(command, arguments);
}

MadeSpheres run_voxels(const TriangleMesh& mesh, const SphereArguments& arguments,
                       const Progress&) {
  VoxelisationOptions options = arguments.voxelisation;
  options.sphere = kSpheres.at(arguments.sphere);
  options.filling = filling_of(arguments);
  options.padding = arguments.padding;
  Voxelisation voxels = voxelise(mesh, options);
  MadeSpheres made;
  made.spheres = std::move(voxels.spheres);
  made.figures = {{"step", voxels.step}, {"surface", voxels.surface}, {"inside", voxels.inside}};
  made.figures["covers_by_construction"] = options.sphere == VoxelSphere::kCircumscribed
                                               ? Json(covered_by_construction(options.filling))
                                               : Json(nullptr);
  made.options = {{"ball", arguments.sphere}, {"surface", arguments.surface}};
  store(made, "step", options.step, 0.0);
  store(made, "max-error", options.max_error, 0.0);
  return made;
}

void add_packing(CLI::App& command, SphereArguments& arguments) {
  SpherePackingOptions& options = arguments.packing;
  arguments.lengths
      .add_positive(command, "--max-error", options.max_error,
                    "No point of the solid is further than this from the spheres")
      ->required();
  arguments.lengths.add_positive(
      command, "--closed-below", options.closed_below,
      "Ways into the solid that are narrower than this count as closed (default: half of "
      "--max-error)");
  command.add_flag("--inflated", arguments.inflated,
                   "Grow every sphere by the proved error of the packing, so that they cover");
  add_seed(command, arguments);
}

MadeSpheres run_packing(const TriangleMesh& mesh, const SphereArguments& arguments,
                        const Progress& progress) {
  SpherePackingOptions options = arguments.packing;
  options.padding = arguments.padding;
  options.seed = arguments.seed;
  options.threads = arguments.threads;
  options.progress = progress;
  SpherePacking packing = pack_spheres(mesh, options);
  MadeSpheres made;
  made.spheres = std::move(arguments.inflated ? packing.inflated : packing.spheres);
  made.figures = {{"error", packing.error},
                  {"closed_below", packing.solid.min_external_diameter},
                  {"external_sphere_count", packing.solid.spheres.size()},
                  {"seeds_rejected", packing.seeds_rejected}};
  made.figures["covers_by_construction"] =
      arguments.inflated ? Json(covered_by_construction(Filling::kSolid)) : Json(nullptr);
  made.options = {{"max-error", options.max_error},
                  {"closed-below", packing.solid.min_external_diameter},
                  {"inflated", arguments.inflated},
                  {"seed", stored(options.seed)}};
  return made;
}

void add_filling(CLI::App& command, SphereArguments& arguments) {
  LevelSetPackingOptions& options = arguments.level_set;
  arguments.lengths
      .add_positive(command, "--step", options.step, "Edge of a voxel of the level set")
      ->required();
  arguments.lengths.add_positive(command, "--min-radius", options.min_radius,
                                 "No sphere is smaller (default: half of --step)");
  command.add_option("--spheres", options.max_spheres, "At most so many (default: 10000)")
      ->check(check_positive);
}

MadeSpheres run_filling(const TriangleMesh& mesh, const SphereArguments& arguments,
                        const Progress&) {
  LevelSetPackingOptions options = arguments.level_set;
  options.threads = arguments.threads;
  MadeSpheres made;
  made.spheres = level_set_module().pack(mesh, options);
  if (made.spheres.empty()) throw Error(arguments.mesh, "no sphere of that size fits inside");
  made.options = {{"step", options.step}, {"spheres", stored(options.max_spheres)}};
  store(made, "min-radius", options.min_radius, 0.0);
  return made;
}

void add_medial(CLI::App& command, SphereArguments& arguments) {
  arguments.reduction = "best";
  CLI::Option* spheres =
      command.add_option("--spheres", arguments.medial.spheres, "At most so many (default: 512)");
  spheres->check(check_positive);
  CLI::Option* protrusion = arguments.lengths.add_positive(
      command, "--max-protrusion", arguments.medial.max_protrusion,
      "As few as protrude by no more than this, instead of a number of them");
  protrusion->excludes(spheres);
  command
      .add_option("--reduction", arguments.reduction,
                  "How medial spheres become few: merge, burst, expand or best, the best of the "
                  "three (default)")
      ->check(CLI::IsMember(kReductions));
  CLI::Option* tree =
      command.add_flag("--tree", arguments.levels, "Make levels of spheres, and write the finest");
  tree->disable_flag_override();
  tree->excludes(spheres)->excludes(protrusion);
  command
      .add_option("--branching", arguments.medial_tree.branching,
                  "With --tree: spheres of the next level for each, 2 to 64 (default: 8)")
      ->needs(tree);
  command
      .add_option("--depth", arguments.medial_tree.depth,
                  "With --tree: levels below the first sphere, 1 to 8 (default: 3)")
      ->needs(tree);
  add_tree_file(command, arguments,
                "With --tree: where a tree goes in which the spheres enclose the finer ones")
      ->needs(tree);
  add_seed(command, arguments);
}

// The numbers of spheres of each level, and the tree over the finest.
void keep_levels(SphereLevels levels, MadeSpheres& made) {
  made.spheres = levels.levels.back();
  made.figures["level_counts"] = Json::array();
  for (const std::vector<Sphere>& level : levels.levels) {
    made.figures["level_counts"].push_back(level.size());
  }
  made.tree = [levels = std::move(levels)](std::span<const Sphere> leaves) {
    return enclosing_tree(levels, leaves).tree;
  };
}

MadeSpheres run_medial(const TriangleMesh& mesh, const SphereArguments& arguments,
                       const Progress&) {
  const SphereReduction reduction = kReductions.at(arguments.reduction);
  MadeSpheres made;
  made.options = {{"reduction", arguments.reduction}, {"seed", stored(arguments.seed)}};
  if (arguments.levels) {
    MedialTreeOptions options = arguments.medial_tree;
    options.reduction = reduction;
    options.sampling.seed = arguments.seed;
    options.threads = arguments.threads;
    keep_levels(medial_axis_tree(mesh, options), made);
    made.options["tree"] = true;
    made.options["branching"] = std::int64_t{options.branching};
    made.options["depth"] = std::int64_t{options.depth};
    return made;
  }
  MedialAxisOptions options = arguments.medial;
  options.reduction = reduction;
  options.sampling.seed = arguments.seed;
  options.threads = arguments.threads;
  MedialAxisSpheres result = medial_axis(mesh, options);
  made.spheres = std::move(result.spheres);
  made.figures = {{"protrusion", to_json(result.protrusion)},
                  {"medial_spheres", result.medial_spheres},
                  {"sites", result.sites},
                  {"cover_points", result.cover_points}};
  store(made, "max-protrusion", options.max_protrusion, 0.0);
  if (options.max_protrusion == 0.0) made.options["spheres"] = stored(options.spheres);
  return made;
}

void add_octree(CLI::App& command, SphereArguments& arguments) {
  CLI::Option* depth =
      command.add_option("--depth", arguments.octree.depth, "Halvings of the cube around the mesh");
  depth->check(check_positive);
  require_one(command, depth,
              arguments.lengths.add_positive(
                  command, "--max-error", arguments.octree.max_error,
                  "Halve cubes until their spheres protrude by no more than this"));
  add_surface(command, arguments);
  add_tree_file(
      command, arguments,
      "Where the tree of the method goes; if spheres had to be inflated, the smallest spheres "
      "around them take the place of those around cubes");
}

MadeSpheres run_octree(const TriangleMesh& mesh, const SphereArguments& arguments,
                       const Progress&) {
  OctreeSpheresOptions options = arguments.octree;
  options.filling = filling_of(arguments);
  options.padding = arguments.padding;
  OctreeSpheres result = octree_spheres(mesh, options);
  MadeSpheres made;
  made.spheres.assign(result.tree.spheres().begin(), result.tree.spheres().end());
  made.figures = {{"step", result.step},
                  {"depth", result.tree.depth()},
                  {"nodes", result.tree.node_count()},
                  {"covers_by_construction", covered_by_construction(options.filling)}};
  made.options = {{"surface", arguments.surface}};
  store(made, "depth", std::int64_t{options.depth}, std::int64_t{0});
  store(made, "max-error", options.max_error, 0.0);
  made.tree = [tree = std::move(result.tree)](std::span<const Sphere> leaves) {
    return refit(tree, leaves);
  };
  return made;
}

void add_hubbard(CLI::App& command, SphereArguments& arguments) {
  command
      .add_option(
          "--counts", arguments.hubbard.counts,
          "Spheres of each level, ascending, with commas between them; the last are written "
          "(default: 1,8,64,512)")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(check_positive);
  add_tree_file(command, arguments,
                "Where a tree goes in which the spheres of a level enclose the finer ones");
  add_seed(command, arguments);
}

MadeSpheres run_hubbard(const TriangleMesh& mesh, const SphereArguments& arguments,
                        const Progress&) {
  HubbardOptions options = arguments.hubbard;
  options.seed = arguments.seed;
  options.threads = arguments.threads;
  MadeSpheres made;
  keep_levels(hubbard_spheres(mesh, options), made);
  std::string counts;
  for (const std::size_t count : options.counts) {
    counts += (counts.empty() ? "" : ",") + std::to_string(count);
  }
  made.options = {{"counts", counts}, {"seed", stored(options.seed)}};
  return made;
}

}  // namespace

const std::vector<SphereBaseline>& sphere_baselines() {
  static const std::vector<SphereBaseline> kMethods = {
      {{"voxelise", "A sphere for every voxel; around it they cover, of its width they do not",
        "spherule baseline voxelise part.stl -o voxels.json --step 5 --conservative"},
       add_voxels,
       run_voxels},
      {{"pack", "The paper's packing of the solid; not conservative unless inflated",
        "spherule baseline pack part.stl -o packed.json --max-error 5 --inflated"},
       add_packing,
       run_packing},
      {{"fill", "The largest spheres inside of a level set (OpenVDB); not conservative",
        "spherule baseline fill part.stl -o filled.json --step 1 --conservative"},
       add_filling,
       run_filling},
      {{"medial", "Adaptive medial-axis approximation (AMAA); not conservative",
        "spherule baseline medial part.stl -o medial.json --spheres 200 --conservative"},
       add_medial,
       run_medial},
      {{"octree", "The octree of Liu, Palmer and Grimsdale; the spheres around cubes cover",
        "spherule baseline octree part.stl -o octree.json --depth 5 --conservative"},
       add_octree,
       run_octree},
      {{"hubbard", "Hubbard's medial spheres, merged to levels; not conservative",
        "spherule baseline hubbard part.stl -o hubbard.json --counts 1,8,64 --conservative"},
       add_hubbard,
       run_hubbard}};
  return kMethods;
}

}  // namespace spherule
