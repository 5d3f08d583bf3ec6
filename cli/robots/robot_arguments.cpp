// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_arguments.h"

#include "cli/help/command_specification.h"
#include "cli/options/search_options.h"
#include "simplifier/simplify.h"

#include <CLI/CLI.hpp>

namespace spherule {
namespace {

void add_cover_options(CLI::App& command, RobotArguments& arguments) {
  command
      .add_option("urdf", arguments.urdf,
                  "The robot (URDF, or .xacro where the program xacro is found)")
      ->required()
      ->type_name(kFile);
  command
      .add_option("-o,--output", arguments.folder,
                  "Folder for what is written; it is made if it is not there (default: "
                  "NAME-spheres, here, where the URDF is NAME.urdf)")
      ->type_name(kFolder);
  arguments.lengths.add_positive(command, "--max-error", arguments.options.max_error,
                                 "E in metres, how far the spheres may protrude (default: 0.01)");
  arguments.lengths.add(command, "--min-external", arguments.options.min_external_diameter,
                        "D in metres, diameter of the smallest object to be checked against the "
                        "robot (default: 4 E, or more for links that are very large for their E)");
  command
      .add_option("--tightness", arguments.options.tightness,
                  "How much wider than D a way into a link may be and still be filled, as a share "
                  "of D (default: 0.03)")
      ->check(CLI::Range(0.001, ExternalOptions::kNoTightness));
  arguments.lengths.add(command, "--padding", arguments.options.padding,
                        "Grow every link by so many metres");
  arguments.lengths.add(command, "--weld", arguments.options.weld,
                        "Join vertices that are no further apart, in metres, so that cracks which "
                        "rounding has left do not open meshes; added to the padding");
}

void add_link_options(CLI::App& command, RobotArguments& arguments) {
  add_geometry_option(command, "What is covered: collision (default) or visual geometry",
                      arguments.geometry);
  add_package_option(command, arguments.packages);
  command
      .add_option("--link", arguments.links,
                  "What is other for one link, of max-error=E,min-external=D,padding=T,zones=FILE; "
                  "may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME:max-error=E,...");
  command
      .add_option("--format", arguments.formats,
                  "What is written, with commas between (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(robot_format_names()));
}

// Files of which what does not concern the spheres is kept.
void add_kept_files(CLI::App& command, RobotArguments& arguments) {
  command
      .add_option("--srdf", arguments.srdf,
                  "The robot's SRDF: its disabled pairs are ignored; all but its spheres is kept, "
                  "and pairs that need no test are added")
      ->type_name(kFile);
  command
      .add_option("--curobo", arguments.curobo,
                  "The robot's cuRobo file, of which all but the spheres is kept; pairs that need "
                  "no test are added")
      ->type_name(kFile);
  command
      .add_option("--xrdf", arguments.xrdf,
                  "The robot's XRDF, of which all but the spheres is kept; pairs that need no test "
                  "are added")
      ->type_name(kFile);
  command
      .add_option("--tool-link", arguments.tool_link,
                  "The tool's link in new cuRobo and XRDF files (default: where the chain of "
                  "joints ends or branches)")
      ->type_name("LINK");
}

}  // namespace

void add_robot_options(CLI::App& command, RobotArguments& arguments) {
  add_cover_options(command, arguments);
  add_link_options(command, arguments);
  add_kept_files(command, arguments);
  add_false_alarm_options(command, arguments.false_alarms);
  RobotCoverOptions& options = arguments.options;
  add_search_options(
      command, {options.seed, options.effort, options.seconds, options.threads},
      "Rounds at most of searching for fewer spheres than at first, for each link, fewer where "
      "more would not pay; 0: none",
      "Search for fewer spheres for so long, for each link, less where it no longer finds any; the "
      "result then depends on the machine");
  add_external_spheres_flag(command, arguments.report_content);
  command.add_flag("--json", arguments.json, "Print the summary as JSON, lengths in metres");
  command
      .add_option("--view", arguments.view,
                  "Write a page that shows the robot and its spheres (HTML, as view writes it)")
      ->type_name(kFile);
}

}  // namespace spherule
