// SPDX-License-Identifier: BSD-3-Clause
#include "cli/command.h"
#include "cli/output.h"
#include "cli/recognize.h"
#include "cli/view_page.h"
#include "simplifier/mesh_io.h"
#include "spheretree/atomic_file.h"
#include "spheretree/sphere_file.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct ViewArguments {
  std::vector<std::string> files;
  std::string page;
};

ViewItem load_item(const std::string& file) {
  switch (recognize(file)) {
    case FileKind::kSpheres:
      return {.name = file, .content = load_spheres(file).spheres};
    case FileKind::kTree:
      return {.name = file, .content = load_tree(file)};
    case FileKind::kMesh:
      break;
  }
  return {.name = file, .content = read_mesh(file)};
}

int view(const ViewArguments& arguments) {
  check_outputs({arguments.page}, {});
  std::vector<ViewItem> items;
  for (const std::string& file : arguments.files) {
    check_outputs({arguments.page}, {file});
    items.push_back(load_item(file));
  }
  const std::string page = make_view_page(arguments.files.front(), items);
  write_uninterrupted([&] { write_file_atomically(arguments.page, page); });
  std::cout << "page: " << arguments.page << " (" << page.size() / 1024 << " KiB)\n";
  return kYes;
}

}  // namespace

void add_view(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("view", "Make a page that shows meshes, spheres and trees in one scene");
  auto arguments = std::make_shared<ViewArguments>();
  command->add_option("files", arguments->files, "Meshes, spheres (JSON) and trees, in one unit")
      ->required();
  command->add_option("-o,--output", arguments->page, "Where the page goes (HTML)")->required();
  command->callback([arguments, &exit_code] { exit_code = view(*arguments); });
}

}  // namespace spherule
