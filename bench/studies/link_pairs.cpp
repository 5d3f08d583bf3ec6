// SPDX-License-Identifier: BSD-3-Clause
// spherule_link_pairs ROBOT.urdf BOXES POSTURES [COVER...]: what is proved of the pairs of a
// robot's links, and the share of its free postures that covers refuse without and with the proofs.
#include "robot/pairs/link_pairs.h"

#include "base/error.h"
#include "collide/solids/solid_within.h"
#include "robot/cover/false_alarms.h"
#include "robot/cover/link_mesh.h"
#include "robot/files/urdf.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/allowed_collisions.h"
#include "spheretree/build.h"
#include "tests/support/program.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace spherule {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Robot {
  RobotDescription description;
  std::vector<LinkBody> bodies;
  std::vector<std::shared_ptr<const SolidMesh>> solids;  // of every link, or null
};

Robot read_robot(const char* path) {
  Robot robot{read_urdf(path), {}, {}};
  robot.bodies = link_bodies(robot.description);
  robot.solids.resize(robot.description.links.size());
  for (const LinkBody& body : robot.bodies) {
    robot.solids[static_cast<std::size_t>(body.link)] = body.mesh;
  }
  return robot;
}

// Evenly between the limits.
std::vector<double> draw(const RobotModel& model, std::mt19937_64& bits) {
  std::vector<double> result;
  for (const int j : model.variable_joints()) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(j)];
    const double part = static_cast<double>(bits() >> 11) * 0x1p-53;
    result.push_back(joint.lower + (joint.upper - joint.lower) * part);
  }
  return result;
}

void print_pairs(const RobotModel& model, const LinkPairs& pairs, double seconds) {
  std::array<int, 3> verdicts{};
  std::size_t boxes = 0;
  std::size_t nodes = 0;
  for (const LinkPair& pair : pairs.pairs()) {
    ++verdicts[static_cast<std::size_t>(pair.verdict)];
    boxes += pair.searched_boxes;
    nodes += pair.boxes.node_count();
    std::printf("%-18s %-18s %-8s boxes %6zu nodes %6zu free %.4f gap %.4f mm\n",
                model.links()[static_cast<std::size_t>(pair.first)].name.c_str(),
                model.links()[static_cast<std::size_t>(pair.second)].name.c_str(),
                std::string(name_of(pair.verdict)).c_str(), pair.searched_boxes,
                pair.boxes.node_count(), pair.boxes.free_share(), 1e3 * pair.smallest_gap);
  }
  std::printf("pairs %zu never %d touching %d unknown %d boxes %zu nodes %zu bytes %zu: %.1f s\n",
              pairs.pairs().size(), verdicts[0], verdicts[1], verdicts[2], boxes, nodes,
              internal::encode_link_pairs(pairs).size(), seconds);
}

// Judges random postures in proved boxes by the meshes, and times queries.
void print_judged(const Robot& robot, const LinkPairs& pairs, int postures) {
  const RobotModel& model = robot.description.model;
  std::mt19937_64 bits(5);
  std::vector<std::vector<double>> drawn;
  for (int n = 0; n < postures; ++n) drawn.push_back(draw(model, bits));
  std::size_t proved = 0;
  const Clock::time_point start = Clock::now();
  for (const LinkPair& pair : pairs.pairs()) {
    for (const std::vector<double>& q : drawn) proved += pair.boxes.contains(q) ? 1 : 0;
  }
  const double query = seconds_since(start);
  std::size_t judged = 0;
  std::size_t touching = 0;
  std::vector<Pose> poses;
  for (const std::vector<double>& q : drawn) {
    forward_kinematics(model, q, poses);
    for (const LinkPair& pair : pairs.pairs()) {
      if (!pair.boxes.contains(q)) continue;
      const auto a = static_cast<std::size_t>(pair.first);
      const auto b = static_cast<std::size_t>(pair.second);
      ++judged;
      touching += within(*robot.solids[a], poses[a], *robot.solids[b], poses[b], 0.0) ? 1 : 0;
    }
  }
  const std::size_t queried = std::max<std::size_t>(drawn.size() * pairs.pairs().size(), 1);
  std::printf("%zu of %zu queries proved, %.0f ns each; judged by the meshes: %zu, touching: %zu\n",
              proved, queried, 1e9 * query / static_cast<double>(queried), judged, touching);
}

// Of free postures, so many does a cover refuse: with nothing proved, without the pairs that never
// touch, and without those in free boxes too. Neighbours are not tested.
void print_postures(const Robot& robot, const LinkPairs& pairs, int postures,
                    const char* cover_path) {
  RobotModel model = robot.description.model;
  for (const LinkSpheres& link : read_robot_spheres(cover_path).spheres.links) {
    if (model.find_link(link.link) < 0 || link.spheres.empty()) continue;
    model.attach(link.link, std::make_shared<const SphereTree>(build_tree(link.spheres)));
  }
  const Clock::time_point start = Clock::now();
  const FalseAlarms alarms =
      measure_false_alarms(model, robot.bodies, AllowedCollisions(model), &pairs,
                           {.postures = static_cast<std::size_t>(postures), .seed = 11});
  const double seconds = seconds_since(start);
  const auto share = [&](PairProofs with) { return 100.0 * alarms.refused_share(with).share(); };
  std::printf(
      "%s: %zu of %d free; refused %.2f %%, without pairs that never touch %.2f %%, with "
      "boxes %.2f %%: %.1f s\n",
      cover_path, alarms.free, postures, share(PairProofs::kNone), share(PairProofs::kNever),
      share(PairProofs::kBoxes), seconds);
  for (const PairAlarms& pair : alarms.pairs) {
    std::printf("  %-18s %-18s refused %zu, alone %zu, gap %.1f mm\n",
                model.links()[static_cast<std::size_t>(pair.first)].name.c_str(),
                model.links()[static_cast<std::size_t>(pair.second)].name.c_str(), pair.refused,
                pair.refused_alone, 1e3 * pair.median_gap);
  }
}

int run(int argc, char** argv) {
  if (argc < 4) throw Error("usage", "ROBOT.urdf BOXES POSTURES [COVER...]");
  const auto boxes = static_cast<std::size_t>(count_argument("BOXES", argv[2], 1));
  const int postures = static_cast<int>(count_argument("POSTURES", argv[3], 0));
  const Robot robot = read_robot(argv[1]);
  const Clock::time_point start = Clock::now();
  const LinkPairs pairs = prove_link_pairs(robot.description.model, robot.bodies, {.boxes = boxes});
  print_pairs(robot.description.model, pairs, seconds_since(start));
  print_judged(robot, pairs, postures);
  for (int i = 4; i < argc; ++i) print_postures(robot, pairs, postures, argv[i]);
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  return spherule::run_program("spherule_link_pairs", [&] { return spherule::run(argc, argv); });
}
