// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "collide/collide.h"
#include "collide/pair_cache.h"
#include "robot/check/robot_scene.h"
#include "simplifier/simplify.h"
#include "tests/soak/random_scene.h"
#include "tests/soak/robot_scenes.h"
#include "tests/soak/scale.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>
// What threads may do at the same time, as the headers promise: each answer is that of one thread
// alone. Built for the thread sanitizer, each of its reports fails the test, too.
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace spherule::test {
namespace {

constexpr std::size_t kThreads = 4;

void run_at_once(std::size_t threads, const std::function<void(std::size_t)>& work) {
  std::vector<std::jthread> all;
  for (std::size_t i = 0; i < threads; ++i) all.emplace_back([&work, i] { work(i); });
}

struct CheckedPath {
  std::vector<double> configurations, from, to;
  std::size_t count = 0;
};

// More than are shared out among threads.
CheckedPath random_path(const TreeScene& robot, SoakRandom& random) {
  CheckedPath path;
  for (path.count = 0; path.count < 4200; ++path.count) {
    const std::vector<double> at = robot.anywhere(random);
    path.configurations.insert(path.configurations.end(), at.begin(), at.end());
  }
  const auto edges = static_cast<std::ptrdiff_t>(path.configurations.size() / path.count * 40);
  path.from.assign(path.configurations.begin(), path.configurations.begin() + edges);
  path.to = path.from;
  for (double& position : path.to) position += random.between(-0.1, 0.1);
  return path;
}

struct CheckedAnswers {
  std::vector<std::uint8_t> free;
  std::vector<double> free_until;

  bool operator==(const CheckedAnswers&) const = default;
};

CheckedAnswers answers(const RobotChecker& checker, const CheckedPath& path, std::size_t threads) {
  std::vector<RobotChecker::Scratch> scratches;
  for (std::size_t i = 0; i < threads; ++i) scratches.emplace_back(checker);
  CheckedAnswers all;
  all.free.resize(path.count);
  checker.check_configs(path.configurations, scratches, all.free);
  for (const EdgeResult& edge : checker.check_edges(path.from, path.to, scratches)) {
    all.free_until.push_back(edge.free_until);
  }
  return all;
}

std::vector<Sphere> fitted(const TriangleMesh& mesh, int threads) {
  return simplify(mesh, {.max_error = 0.25, .effort = 1, .threads = threads}).cover.spheres;
}

// What is proved when it is told to stop, or an Error if that is nothing.
void fit_and_stop(const TriangleMesh& mesh) {
  std::stop_source stop;
  SimplifyOptions options{.max_error = 0.2, .effort = 50};
  options.progress = [&stop](double share, std::string_view) {
    if (share > 0.5) stop.request_stop();
  };
  options.on_proved = [&stop](std::size_t) { stop.request_stop(); };
  options.stop = stop.get_token();
  try {
    simplify(mesh, options);
  } catch (const Error&) {
  }
}

TEST(Threads, AskTreesAtOnce) {
  SoakRandom random(seeded(7));
  for (int scene = 0; scene < scaled(2); ++scene) {
    const ScenePair pair(random);
    std::vector<PosePair> poses;
    for (int i = 0; i < 200; ++i) {
      const auto near = pair.at_gap(random, random.small_gap());
      poses.push_back(near ? *near : pair.anywhere(random));
    }
    const auto query = [&] {
      PairCache cache(pair.a(), pair.b());
      std::vector<double> said;
      for (const PosePair& at : poses) {
        const DistanceResult gap =
            distance(pair.a(), at.world_from_a, pair.b(), at.world_from_b, {});
        said.insert(said.end(), {gap.lower, gap.upper,
                                 cache.collides(at.world_from_a, at.world_from_b) ? 1.0 : 0.0});
      }
      return said;
    };
    const std::vector<double> expected = query();
    std::vector<std::vector<double>> said(kThreads);
    run_at_once(kThreads, [&](std::size_t i) { said[i] = query(); });
    for (const auto& of_thread : said) EXPECT_TRUE(of_thread == expected);
  }
}

TEST(Threads, AskACheckerWhileItsSceneIsEdited) {
  SoakRandom random(seeded(7));
  for (int number = 0; number < scaled(1); ++number) {
    const TreeScene robot(random);
    RobotScene scene = robot.scene();
    const RobotChecker checker = scene.snapshot();
    const CheckedPath path = random_path(robot, random);
    const CheckedAnswers expected = answers(checker, path, 1);
    std::vector<CheckedAnswers> said(kThreads);
    const std::vector<std::string> obstacles = scene.obstacles();
    run_at_once(kThreads + 1, [&](std::size_t i) {
      if (i < kThreads) {
        said[i] = answers(checker, path, i + 1);
        return;
      }
      for (int step = 0; step < 20; ++step) {
        scene.move(obstacles.front(), Pose::from_translation({0.1 * step, 0.0, 0.0}));
        const RobotChecker moved = scene.snapshot();
        RobotChecker::Scratch scratch(moved);
        moved.check_config(
            std::span(path.configurations).first(path.configurations.size() / path.count), scratch);
      }
    });
    for (const CheckedAnswers& of_thread : said) {
      EXPECT_TRUE(of_thread == expected);
    }
  }
}

TEST(Threads, FitAtOnce) {
  SoakRandom random(seeded(7));
  for (int fit = 0; fit < scaled(1); ++fit) {
    const TriangleMesh mesh = make_box({1.0, random.between(0.3, 1.0), random.between(0.3, 1.0)});
    const std::vector<Sphere> expected = fitted(mesh, 1);
    std::vector<std::vector<Sphere>> made(2);
    run_at_once(3, [&](std::size_t i) {
      if (i < made.size()) {
        made[i] = fitted(mesh, 2);
      } else {
        fit_and_stop(mesh);
      }
    });
    for (const std::vector<Sphere>& spheres : made) {
      EXPECT_EQ(spheres, expected);
    }
  }
}

TEST(Threads, ShareAFile) {
  SoakRandom random(seeded(7));
  const TempDir folder;
  const std::filesystem::path file = folder.path() / "shared";
  for (int round = 0; round < scaled(20); ++round) {
    const auto size = static_cast<std::size_t>(random.whole(1, 100'000));
    write_file_atomically(file, std::string(size, 'a'));
    std::vector<std::string> read(kThreads);
    run_at_once(2 * kThreads, [&](std::size_t i) {
      if (i < kThreads) {
        read[i] = read_file(file);
      } else {
        write_file_atomically(file, std::string(size, static_cast<char>('a' + i)));
      }
    });
    for (const std::string& bytes : read) {
      EXPECT_TRUE(bytes.size() == size && bytes == std::string(size, bytes.front())) << "torn";
    }
  }
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "temporary files are left";
}

}  // namespace
}  // namespace spherule::test
