// SPDX-License-Identifier: BSD-3-Clause
// The answers of the library itself, for the test of the Python module: reads what
// equal_answers_test.py wrote into a folder, and writes doubles. Usage: python_answers FOLDER

#include "collide/collide.h"
#include "spheretree/tree_file.h"
#include "tests/python/cell_files.h"

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

namespace spherule {
namespace {

void write_doubles(const std::vector<double>& values, const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(double)));
}

// Of each configuration whether it is free; of the first edges and clearances, what is proved.
void answer_robot(const std::filesystem::path& folder) {
  const RobotChecker checker = checker_in(folder);
  const auto dof = static_cast<std::size_t>(checker.robot().variable_count());
  const std::vector<double> all = read_doubles(folder / "configurations");
  const auto at = [&](std::size_t i) { return std::span(all).subspan(i * dof, dof); };
  const std::size_t count = all.size() / dof;

  RobotChecker::Scratch scratch(checker);
  std::vector<double> free;
  for (std::size_t i = 0; i < count; ++i) free.push_back(checker.check_config(at(i), scratch));
  write_doubles(free, folder / "free");

  std::vector<double> verdicts;
  std::vector<double> bounds;
  for (std::size_t i = 0; i + 1 < count && i < 10000; ++i) {
    verdicts.push_back(static_cast<double>(checker.check_edge(at(i), at(i + 1), scratch).verdict));
    if (i >= 5000) continue;
    const RobotClearance clearance = checker.clearance(at(i), scratch);
    bounds.push_back(clearance.lower);
    bounds.push_back(clearance.upper);
  }
  write_doubles(verdicts, folder / "verdicts");
  write_doubles(bounds, folder / "clearances");
}

// Of each pose of b, seven numbers as docs have them, whether the trees touch and how far they are.
void answer_trees(const std::filesystem::path& folder) {
  const SphereTree a = load_tree(folder / "a.tree");
  const SphereTree b = load_tree(folder / "b.tree");
  const std::vector<double> poses = read_doubles(folder / "poses");
  std::vector<double> answers;
  for (std::size_t i = 0; i + 7 <= poses.size(); i += 7) {
    const double* const p = &poses[i];
    const Pose pose(Eigen::Quaterniond(p[6], p[3], p[4], p[5]), {p[0], p[1], p[2]});
    const DistanceResult found = distance(a, {}, b, pose);
    answers.insert(answers.end(), {collides(a, {}, b, pose) ? 1.0 : 0.0, found.lower, found.upper});
  }
  write_doubles(answers, folder / "trees");
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  try {
    if (argc != 2) return 2;
    spherule::answer_robot(argv[1]);
    spherule::answer_trees(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
