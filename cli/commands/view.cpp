// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/help/help.h"
#include "cli/pages/view_files.h"
#include "cli/pages/view_page.h"
#include "cli/pages/view_robot.h"
#include "cli/robots/robot_input.h"
#include "cli/text/print.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct ViewArguments {
  std::vector<std::string> files;
  std::string page;
  bool leaks = false;
  std::string units;
#ifdef SPHERULE_HAS_ROBOT
  RobotViewOptions robot{.packages = {}, .geometry = {geometry_names().front()}};
#endif
};

ViewScene load_scene(const ViewArguments& arguments) {
  ViewScene scene{.title = arguments.files.front(), .items = {}};
  std::vector<std::string> others = arguments.files;
#ifdef SPHERULE_HAS_ROBOT
  const auto of_robot = std::stable_partition(
      others.begin(), others.end(), [](const auto& file) { return !is_robot_file(file); });
  if (of_robot != others.end() && !arguments.units.empty() && arguments.units != "m") {
    throw Error("--units", *of_robot + " is of a robot, which is in metres");
  }
  add_robot({of_robot, others.end()}, arguments.robot, scene);
  others.erase(of_robot, others.end());
#endif
  for (const std::string& file : others) {
    std::vector<ViewItem> items = view_items(file, arguments.units);
    std::move(items.begin(), items.end(), std::back_inserter(scene.items));
  }
  place_leaks(scene.items);
  if (arguments.leaks) {
    std::vector<ViewItem> found = sampled_leaks(scene.items);
    std::move(found.begin(), found.end(), std::back_inserter(scene.items));
  }
  return scene;
}

int view(ViewArguments& arguments) {
  if (arguments.page.empty())
    arguments.page = default_output(arguments.files.front(), ".html", FileKind::kPage);
  std::vector<std::filesystem::path> inputs(arguments.files.begin(), arguments.files.end());
#ifdef SPHERULE_HAS_ROBOT
  inputs.emplace_back(arguments.robot.postures.file);
#endif
  check_outputs({arguments.page}, inputs);
  write_page(arguments.page, load_scene(arguments));
  std::cout << page_line(arguments.page);
  return kYes;
}

}  // namespace

void add_view(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "view", "Make a page that shows meshes, spheres, trees, leaks and a robot in one scene");
  auto arguments = std::make_shared<ViewArguments>();
  add_file_argument(*command, "files", arguments->files,
                    "Meshes, spheres (JSON), trees, reports of `fit`, what `audit --json` printed, "
                    "in one unit; a robot's URDF, files of its spheres, its SRDF and NAME.pairs");
  add_file(*command, "-o,--output", arguments->page,
           "Where the page goes (default: the name of the first file with .html, here)");
  command->add_flag("--leaks", arguments->leaks,
                    "Colour by depth what of the meshes is outside of the spheres, found by "
                    "samples; `audit` proves");
  command
      ->add_option("--units", arguments->units,
                   "Show in this unit meshes whose files state one, and spheres fitted with "
                   "--units; others are taken to be in it")
      ->check(CLI::IsMember(unit_choices()));
#ifdef SPHERULE_HAS_ROBOT
  command
      ->add_option("--geometry", arguments->robot.geometry,
                   "The robot's meshes: collision (default), visual, or both with a comma between; "
                   "the first is shown and searched for leaks")
      ->check(CLI::IsMember(geometry_names()))
      ->delimiter(',')
      ->allow_extra_args(false);
  add_package_option(*command, arguments->robot.packages);
  CLI::Option* poses = add_file(
      *command, "--poses", arguments->robot.postures.file,
      "Postures of the robot to step through, one a line (as the trajectories that check reads)");
  add_degrees_flag(*command, "Angles of --poses are in degrees, lengths in metres",
                   arguments->robot.postures)
      ->needs(poses);
  add_at_option(*command, arguments->robot.postures)->needs(poses);
  add_unknown_links_flag(*command, arguments->robot.ignores_unknown_links);
#endif
  command->footer(to_text(
      {.text = "The page is one file, which any browser opens, without network or server. Two sets "
               "of spheres for one mesh or one robot stand side by side, with their leaks.",
       .exit_codes = "0 done",
       .examples = {
           "spherule view part.stl part.json part.tree -o part.html",
#ifdef SPHERULE_HAS_ROBOT
           "spherule view robot.urdf robot.curobo.yml -o robot.html --leaks",
           "spherule view robot.urdf robot.curobo.yml --poses path.csv -o poses.html",
           "spherule view robot.urdf robot.curobo.yml robot.spheres.json --leaks -o two.html",
#endif
           "spherule view part.stl others.json --leaks -o leaks.html"}}));
  command->callback([arguments, &exit_code] { exit_code = view(*arguments); });
}

}  // namespace spherule
