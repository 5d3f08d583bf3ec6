// SPDX-License-Identifier: BSD-3-Clause
// Are the answers right, in many millions of cases, against an exact oracle? See bench/README.md.
#include "bench/program.h"
#include "bench/scale/cases.h"
#include "spheretree/error.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace spherule {
namespace {

constexpr const char* kUsage =
    "usage: spherule_scale [--poses N] [--motions N] [--distances N] [--checked N] [--seed S]\n"
    "                      [--out FILE]\n"
    "Runs the collision queries of N cases each (10000000 poses, 1000000 motions and "
    "distances),\n"
    "a third of them near contact, and judges the answers by an exact oracle. A tenth as many\n"
    "robot configurations and edges come with the poses and motions; `checked` are configurations\n"
    "of a RobotChecker (1000000), with a tenth as many edges. FILE gets the table, too.\n"
    "Fails if a collision was missed, a bound crossed, or a slack exceeded.\n";

struct Arguments {
  std::uint64_t poses = 10'000'000;
  std::uint64_t motions = 1'000'000;
  std::uint64_t distances = 1'000'000;
  std::uint64_t checked = 1'000'000;
  std::uint64_t seed = 1;
  std::string out;
  bool help = false;
};

Arguments parse(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string option = values[i];
    if (option == "--help") {
      arguments.help = true;
      continue;
    }
    if (i + 1 == count) throw Error(option, "unknown option, or its value is lacking");
    const std::string value = values[++i];
    if (option == "--poses") {
      arguments.poses = static_cast<std::uint64_t>(count_argument(option, value, 0, INT64_MAX));
    } else if (option == "--motions") {
      arguments.motions = static_cast<std::uint64_t>(count_argument(option, value, 0, INT64_MAX));
    } else if (option == "--distances") {
      arguments.distances = static_cast<std::uint64_t>(count_argument(option, value, 0, INT64_MAX));
    } else if (option == "--checked") {
      arguments.checked = static_cast<std::uint64_t>(count_argument(option, value, 0, INT64_MAX));
    } else if (option == "--seed") {
      arguments.seed = static_cast<std::uint64_t>(count_argument(option, value, 0, INT64_MAX));
    } else if (option == "--out") {
      arguments.out = value;
    } else {
      throw Error(option, "unknown option");
    }
  }
  return arguments;
}

int run(const Arguments& arguments) {
  if (arguments.help) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  File file(nullptr, std::fclose);
  if (!arguments.out.empty()) {
    file.reset(std::fopen(arguments.out.c_str(), "w"));
    if (!file) throw Error(arguments.out, "cannot be written");
  }
  ScaleReport report(false);
  check_poses(arguments.poses, arguments.seed, report);
  check_configurations(arguments.poses / 10, arguments.seed, report);
  check_distances(arguments.distances, arguments.seed, report);
  check_sweeps(arguments.motions, arguments.seed, report);
  check_edges(arguments.motions / 10, arguments.seed, report);
  check_checker_configurations(arguments.checked, arguments.seed, report);
  check_checker_edges(arguments.checked / 10, arguments.seed, report);
  report.print(stdout);
  if (file) {
    report.print(file.get());
    if (std::fclose(file.release()) != 0) throw Error(arguments.out, "cannot be written");
  }
  std::printf("%s\n", report.is_clean() ? "nothing missed" : "FAILED");
  return report.is_clean() ? 0 : 1;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_scale",
                               [&] { return spherule::run(spherule::parse(count, values)); });
}
