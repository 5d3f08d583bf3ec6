// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/text/print.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>

namespace spherule {
namespace {

int bad_input(const std::string& message) {
  tell(message);
  return kBadInput;
}

int run(int argc, char** argv) {
  CLI::App app("Proved sphere covers of meshes, sphere trees, and collision checking on them.",
               "spherule");
  app.formatter(help_layout());
  app.group("Commands");  // of the commands too, which begin as a copy
  app.set_help_flag("-h,--help", "Print this help");
  app.set_version_flag("--version", "spherule " SPHERULE_VERSION, "Print the version");
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
  add_check_srdf(app, exit_code);
  add_check(app, exit_code);
#endif
  add_help(app, exit_code);
  add_completion(app, exit_code);
  add_manual(app, exit_code);
  app.footer(to_text(
      {.text = "`spherule COMMAND --help` lists the options of a command, with examples.",
       .exit_codes = "0 done; 1 not proved to cover (fit, robot), a leak or not proved "
                     "(audit, audit-robot), pairs that touch or are not proved apart (check-srdf), "
                     "a collision (collide), a collision or not proved (check)",
       .examples = {"spherule fit part.stl -o part.json --max-error 1",
                    "spherule audit part.stl part.json", "spherule robot robot.urdf -o spheres"}}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    return bad_input(describe_usage_error(app, error));
  } catch (const Error& error) {
    const std::string message = error.subject() + ": " + error.reason();  // with zero bytes
    return bad_input(message + wrong_file_hint(app, message));
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

// Where memory ends inside a function that must not throw, the exception cannot travel on.
[[noreturn]] void end_without_memory() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    std::fputs("spherule: out of memory\n", stderr);
    std::_Exit(kBadInput);
  } catch (...) {
  }
  std::abort();
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  // Beyond a limit of file sizes a write is an error then, which names the file.
  std::signal(SIGXFSZ, SIG_IGN);
  // Where the parent ignores it, nobody learns how the readers of STEP files and xacro end.
  std::signal(SIGCHLD, SIG_DFL);
  std::set_terminate(spherule::end_without_memory);
  return spherule::run_guarded(argc, argv);
}
