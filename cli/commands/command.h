// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace spherule {

// Each adds one command to `app`. When the command line has been read without fault, the command
// runs and stores its exit code; it throws spherule::Error for bad input.
void add_fit(CLI::App& app, int& exit_code);
void add_audit(CLI::App& app, int& exit_code);
void add_tree(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_collide(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_robot(CLI::App& app, int& exit_code);
void add_audit_robot(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_check_srdf(CLI::App& app, int& exit_code);
void add_help(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);
void add_manual(CLI::App& app, int& exit_code);

}  // namespace spherule
