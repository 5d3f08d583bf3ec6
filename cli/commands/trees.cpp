// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/text.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "collide/collide.h"
#include "io/sphere_file.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct TreeArguments {
  std::string spheres;
  std::string tree;
};

int make_tree(TreeArguments& arguments) {
  if (arguments.tree.empty())
    arguments.tree = default_output(arguments.spheres, ".tree", FileKind::kTree);
  check_outputs({arguments.tree}, {arguments.spheres});
  const SphereFile file = load_spheres(arguments.spheres);
  if (file.spheres.empty()) throw Error(arguments.spheres, "holds no spheres");
  const SphereTree tree = build_tree(file.spheres);
  write_uninterrupted([&] { save_tree(tree, arguments.tree); });
  std::cout << one_line(arguments.tree) << ": " << tree.spheres().size() << " spheres, "
            << tree.node_count() << " nodes, depth " << tree.depth() << ", branching "
            << tree.branching() << "\n"
            << describe(
                   {{{"collide", arguments.tree, "OTHER.tree", "--pose-b", "x y z qx qy qz qw"},
                     "does it touch another part?"}});
  return kYes;
}

struct CollideArguments {
  std::string tree_a;
  std::string tree_b;
  std::optional<std::string> pose_a;
  std::optional<std::string> pose_b;
  bool distance = false;
  bool json = false;
};

// "x y z qx qy qz qw", separated by blanks or commas; the quaternion need not have unit length.
Pose parse_pose(const std::optional<std::string>& given, const std::string& option) {
  if (!given) return {};
  std::string text = *given;
  std::replace(text.begin(), text.end(), ',', ' ');
  std::vector<double> numbers;
  for (const std::string_view word : internal::words_of(text)) {
    const std::optional<double> value = internal::finite_number(word);
    if (!value) throw Error(option, internal::in_quotes(word) + " is not a number");
    numbers.push_back(*value);
  }
  if (numbers.size() != 7) {
    throw Error(option,
                "needs the seven numbers x y z qx qy qz qw, not " + std::to_string(numbers.size()));
  }
  try {
    return Pose(Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5]),
                Eigen::Vector3d(numbers[0], numbers[1], numbers[2]));
  } catch (const Error& error) {
    throw Error(option, error.reason());
  }
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFree:
      return "free";
    case Verdict::kCollision:
      return "collision";
    case Verdict::kUnknown:
      break;
  }
  return "unknown";
}

Json to_json(const CollisionResult& result) {
  Json json = Json::object();
  json["verdict"] = name_of(result.verdict);
  json["pairs"] = Json::array();
  for (const SpherePair& pair : result.pairs)
    json["pairs"].push_back(Json::array({pair.a, pair.b}));
  json["distance_lower_bound"] = spherule::to_json(result.distance_lower_bound);
  json["node_tests"] = result.cost.node_tests;
  json["leaf_tests"] = result.cost.leaf_tests;
  return json;
}

Json to_json(const DistanceResult& result) {
  return {{"lower", spherule::to_json(result.lower)},
          {"upper", spherule::to_json(result.upper)},
          {"nearest", Json::array({result.nearest.a, result.nearest.b})},
          {"node_tests", result.cost.node_tests},
          {"leaf_tests", result.cost.leaf_tests}};
}

int run_collide(const CollideArguments& arguments) {
  const Pose world_from_a = parse_pose(arguments.pose_a, "--pose-a");
  const Pose world_from_b = parse_pose(arguments.pose_b, "--pose-b");
  const SphereTree a = load_tree(arguments.tree_a);
  const SphereTree b = load_tree(arguments.tree_b);
  const CollisionResult result = collide(a, world_from_a, b, world_from_b);
  Json json = to_json(result);
  if (arguments.distance) json["distance"] = to_json(distance(a, world_from_a, b, world_from_b));
  if (arguments.json) {
    std::cout << to_text(json);
  } else {
    std::cout << filled("{verdict}\n", json);
    if (!result.pairs.empty()) {
      std::cout << "overlapping pairs of spheres: " << result.pairs.size()
                << filled(", the first is {pairs.0.0} with {pairs.0.1}\n", json);
    }
    std::cout << lines(json, {{"distance",
                               "distance: {distance.lower} to {distance.upper}, between the "
                               "spheres {distance.nearest.0} and {distance.nearest.1}\n"}});
  }
  return result.verdict == Verdict::kFree ? kYes : kNo;
}

}  // namespace

void add_tree(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("tree", "Build the sphere tree of a set of spheres");
  auto arguments = std::make_shared<TreeArguments>();
  add_file_argument(*command, "spheres", arguments->spheres, "Spheres (JSON)");
  add_file(*command, "-o,--output", arguments->tree,
           "Where the tree goes (default: the name of the spheres with .tree, here)");
  command->footer(
      to_text({.text = "A tree is what `spherule collide` checks, and load_tree() loads.",
               .exit_codes = "0 done",
               .examples = {"spherule tree part.json -o part.tree"}}));
  command->callback([arguments, &exit_code] { exit_code = make_tree(*arguments); });
}

void add_collide(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("collide", "Check two placed trees; exit 0 free, 1 collision");
  auto arguments = std::make_shared<CollideArguments>();
  add_file_argument(*command, "a", arguments->tree_a, "First tree");
  add_file_argument(*command, "b", arguments->tree_b, "Second tree");
  const char* pose_help = "\"x y z qx qy qz qw\" (default: the identity)";
  command->add_option("--pose-a", arguments->pose_a, pose_help);
  command->add_option("--pose-b", arguments->pose_b, pose_help);
  command->add_flag("--distance", arguments->distance, "Bound the separation distance too");
  command->add_flag("--json", arguments->json, "Print the result as JSON");
  command->footer(to_text(
      {.text = "Trees are made by `spherule tree` and by `spherule fit --tree`. Without poses both "
               "parts stand where their meshes do.",
       .exit_codes = "0 free; 1 collision",
       .examples = {
           "spherule collide part.tree tool.tree --pose-b \"0 0 120 0 0 0 1\" --distance",
           "spherule collide part.tree tool.tree --pose-b \"60 0 0 0 0 0.7 0.7\" --json"}}));
  command->callback([arguments, &exit_code] { exit_code = run_collide(*arguments); });
}

}  // namespace spherule
