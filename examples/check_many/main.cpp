// SPDX-License-Identifier: BSD-3-Clause
// Very many random configurations on as many processes as mpirun starts: what is counted does not
// depend on their number.
//
//     mpirun -n 4 consumer 100000000
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <mpi.h>
#include <random>
#include <spherule/robot.h>
#include <string>
#include <vector>

using namespace spherule;

namespace {

constexpr std::int64_t kBlock = 4096;  // configurations that one generator makes
constexpr std::uint32_t kSeed = 1;

// Every process makes the same one. A robot that takes long to cover is covered once beforehand
// (`spherule robot`), and its spheres are read: read_robot_spheres().
RobotChecker make_checker() {
  const RobotDescription robot = read_urdf(URDF);
  const RobotCover cover = cover_robot(robot, {.max_error = 0.05, .effort = 0, .threads = 1});
  RobotScene scene(with_spheres(robot.model, robot_spheres(robot, cover).links));
  scene.add("post", Primitive(Cylinder{0.05, 2.0}), Pose::from_translation({0.0, 0.8, 0.0}));
  return scene.snapshot();
}

// The configurations of a block, whoever makes them: uniform between the limits.
std::vector<double> make_block(const RobotModel& robot, std::int64_t block, std::int64_t count) {
  std::seed_seq seed{kSeed, static_cast<std::uint32_t>(block),
                     static_cast<std::uint32_t>(block >> 32)};
  std::mt19937_64 generator(seed);
  std::vector<double> configurations;
  for (std::int64_t i = 0; i < count; ++i) {
    for (const Joint& joint : robot.joints()) {
      if (joint.variable < 0) continue;
      std::uniform_real_distribution<double> position(joint.lower, joint.upper);
      configurations.push_back(position(generator));
    }
  }
  return configurations;
}

// How many configurations are free of the blocks of this process: every size-th from the rank-th
// on.
std::int64_t count_free(const RobotChecker& checker, std::int64_t all, int rank, int size) {
  RobotChecker::Scratch scratch(checker);
  std::int64_t free_count = 0;
  for (std::int64_t block = rank; block * kBlock < all; block += size) {
    const std::int64_t count = std::min(kBlock, all - block * kBlock);
    const std::vector<double> configurations = make_block(checker.robot(), block, count);
    std::vector<std::uint8_t> free(static_cast<std::size_t>(count));
    checker.check_configs(configurations, scratch, free);
    free_count += std::count(free.begin(), free.end(), 1);
  }
  return free_count;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0;
  int size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const std::int64_t all = argc > 1 ? std::atoll(argv[1]) : 100000;

  const std::int64_t mine = count_free(make_checker(), all, rank, size);
  std::int64_t free_count = 0;
  MPI_Reduce(&mine, &free_count, 1, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
  if (rank == 0) std::cout << free_count << " of " << all << " configurations are free\n";
  MPI_Finalize();
  return 0;
}
