// SPDX-License-Identifier: BSD-3-Clause
#include "cli/command.h"
#include "spheretree/error.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>
#include <new>
#include <string>

namespace spherule {
namespace {

int bad_input(const std::string& message) {
  std::cerr << "spherule: " << message << '\n';
  return kBadInput;
}

// CLI11 lists what is left over in an order of its own; name the first option among it.
std::string describe_extras(const CLI::App& app) {
  const auto extras = app.remaining(true);
  for (const std::string& extra : extras) {
    if (extra.starts_with('-')) return "unexpected option: " + extra;
  }
  return "unexpected argument: " + (extras.empty() ? std::string() : extras.front());
}

int run(int argc, char** argv) {
  CLI::App app("Proved sphere covers of meshes, sphere trees, and collision checking on them.",
               "spherule");
  app.set_version_flag("--version", "spherule " SPHERULE_VERSION);
  app.require_subcommand(1);
  int exit_code = kYes;
  add_fit(app, exit_code);
  add_audit(app, exit_code);
  add_tree(app, exit_code);
  add_info(app, exit_code);
  add_collide(app, exit_code);
  add_view(app, exit_code);
#ifdef SPHERULE_HAS_ROBOT
  add_robot(app, exit_code);
  add_audit_robot(app, exit_code);
#endif
#ifdef SPHERULE_HAS_BASELINES
  add_baseline(app, exit_code);
#endif
  app.footer(
      "Exit codes: 0 done; 1 a leak (fit, audit, robot, baseline) or a collision (collide); 2 bad "
      "input.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ExtrasError&) {
    return bad_input(describe_extras(app));
  } catch (const CLI::RequiredError& error) {
    if (!app.get_subcommands().empty()) return bad_input(error.what());
    const auto extras = app.remaining();
    return bad_input(extras.empty() ? "a command is required (see --help)"
                                    : "unknown command: " + extras.front());
  } catch (const CLI::ParseError& error) {
    return bad_input(error.what());
  }
  if (!std::cout.flush()) return bad_input("standard output: cannot be written");
  return exit_code;
}

// What no command expects ends here, so that it is told in the same form.
int run_guarded(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return bad_input("out of memory");
  } catch (const std::exception& error) {
    return bad_input(error.what());
  }
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  return spherule::run_guarded(argc, argv);
}
