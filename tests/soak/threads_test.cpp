// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "collide/collide.h"
#include "collide/pair_cache.h"
#include "robot/check/robot_scene.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"
#include "tests/soak/robot_scenes.h"
#include "tests/soak/scale.h"
#include "tests/support/random_scene.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>
// What threads may do at the same time, as the headers promise: each answer is that of one thread
// alone. Built for the thread sanitizer, each of its reports fails the test, too.
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
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
CheckedPath random_path(const CheckerScene& scene, Random& random) {
  CheckedPath path;
  for (path.count = 0; path.count < 4200; ++path.count) {
    const std::vector<double> at = scene.anywhere(random);
    path.configurations.insert(path.configurations.end(), at.begin(), at.end());
    if (path.count >= 40) continue;
    const std::vector<double> aim = scene.anywhere(random);
    for (std::size_t k = 0; k < at.size(); ++k) {
      path.from.push_back(at[k]);
      path.to.push_back(0.95 * at[k] + 0.05 * aim[k]);
    }
  }
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
  Random random(seeded(7));
  for (int scene = 0; scene < scaled(2); ++scene) {
    const SphereTree a = build_tree(random_spheres(random, 40, 1.0, 0.1));
    const SphereTree b = build_tree(random_spheres(random, 40, 1.0, 0.1));
    std::vector<Pose> poses;
    for (int i = 0; i < 200; ++i) poses.push_back(random.pose(3.0));
    const auto query = [&] {
      PairCache cache(a, b);
      std::vector<double> said;
      for (const Pose& pose : poses) {
        const DistanceResult gap = distance(a, Pose(), b, pose, {});
        said.insert(said.end(), {gap.lower, gap.upper, cache.collides(Pose(), pose) ? 1.0 : 0.0});
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
  Random random(seeded(7));
  for (int number = 0; number < scaled(1); ++number) {
    std::unique_ptr<CheckerScene> robot;
    do {
      robot = std::make_unique<CheckerScene>(random);
    } while (robot->pair_count() == 0 || robot->scene().obstacles().empty());
    RobotScene scene = robot->scene();
    const RobotChecker checker = scene.snapshot();
    const CheckedPath path = random_path(*robot, random);
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
  Random random(seeded(7));
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
  Random random(seeded(7));
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
