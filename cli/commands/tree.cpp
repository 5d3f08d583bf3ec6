// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/interruption.h"
#include "cli/files/output.h"
#include "cli/help/command_specification.h"
#include "cli/help/help.h"
#include "cli/text/exit_code.h"
#include "cli/text/message.h"
#include "cli/text/next_step.h"
#include "io/sphere_file.h"
#include "spheretree/build.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <string>

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

}  // namespace

void add_tree(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("tree", "Build the sphere tree of a set of spheres");
  auto arguments = std::make_shared<TreeArguments>();
  command->add_option("spheres", arguments->spheres, "Spheres (JSON)")
      ->required()
      ->type_name(kFile);
  command
      ->add_option("-o,--output", arguments->tree,
                   "Where the tree goes (default: the name of the spheres with .tree, here)")
      ->type_name(kFile);
  command->footer(
      to_text({.text = "A tree is what `spherule collide` checks, and load_tree() loads.",
               .exit_codes = "0 done",
               .examples = {"spherule tree part.json -o part.tree"}}));
  command->callback([arguments, &exit_code] { exit_code = make_tree(*arguments); });
}

}  // namespace spherule
