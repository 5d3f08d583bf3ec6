// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_mechanism.h"

#include "collide/internal/joined_scene.h"
#include "collide/internal/mechanism_input.h"
#include "collide/internal/mechanism_kernel.h"
#include "collide/internal/mesh_search.h"
#include "collide/internal/packed_mesh.h"
#include "collide/internal/packed_tree.h"
#include "collide/internal/relative_pose.h"
#include "collide/internal/single_precision.h"
#include "spheretree/build.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace spherule {

struct MeshMechanismCheck::Parts {
  std::vector<internal::KernelFrame> frames{};
  std::vector<internal::KernelBody> balls{};  // around the bodies, to be placed
  internal::KernelProblem kinematics{};
  std::vector<std::shared_ptr<const internal::PackedMesh>> meshes{};
  std::vector<internal::MeshBody> bodies{};
  std::vector<internal::JoinedSpheres> joined{};
  std::vector<internal::PackedTree> trees{};
  std::vector<internal::MeshObstacle> obstacles{};
  std::vector<internal::KernelPair> pairs{};
  internal::MeshProblem problem{};
  const internal::Kernels* kernels = nullptr;
  const internal::MeshKernels* mesh_kernels = nullptr;
};

struct MeshMechanismCheck::Scratch::Memory {
  std::shared_ptr<const Parts> owner;  // kept, so that no later check is at its address
  std::vector<double> sines;
  std::vector<double> cosines;
  std::vector<internal::KernelPose> poses;
  std::vector<internal::KernelTask> roots;
  internal::MeshTasks tasks;
  internal::KernelScratch view = {};
};

struct MeshMechanismCheck::Translator {
  const Parts& parts;
  Ask ask;
  void* context;

  static bool confirm(void* translator, internal::KernelPair pair, std::int32_t sphere,
                      std::int32_t triangle) {
    const Translator& in = *static_cast<const Translator*>(translator);
    const internal::SphereOrigin& origin = in.parts.joined[static_cast<std::size_t>(pair.obstacle)]
                                               .origins[static_cast<std::size_t>(sphere)];
    return in.ask(in.context, {{pair.body, origin.part}, origin.sphere, triangle});
  }
};

namespace {

using Triangle = internal::Triangle;

// Error budget, in the words of internal/mechanism_parts.cpp: v = 2^-24, n frames between the root
// and a body, W how far any point of it can be from the root, X the lengths that changes of frame
// in double involve. Let C bound the distance of every sphere from the root, and B = W + C. Seen
// from a body, no centre is further than B.
//   the chain in double: 1e-10 (n + 1) W covers it and the sines, 1e-12 X the changes of frame.
//   a centre c in the body's frame, R^T c - R^T t: rotation and R^T t rounded to single, sqrt(3) v
//     |c| + v |t|; three products and three sums a row, 7 v (|c| + |t|): less than 10 v B.
//   the tests of internal/mesh_kernel_impl.h: 25 v B.
//   what is found apart must be so for the test in double: by 2 v S, and 160 u S, where S is the
//     scene of mesh_tree.h, at most 4 B; as in internal/mesh_search.cpp. 9 v B covers it.
constexpr double kPerLength = 48.0 * internal::kFloatRoundoff;
constexpr double kPerFrame = 5.0 * internal::kSineError;
constexpr double kPerScene = 1e-12;

void check_input(std::span<const MechanismFrame> frames, std::span<const MechanismMesh> bodies,
                 std::span<const MechanismObstacle> obstacles, std::span<const MechanismPair> pairs,
                 double pose_error) {
  internal::check_frames(frames);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    internal::check_body(i, bodies[i].frame, frames.size(), bodies[i].mesh != nullptr);
  }
  internal::check_obstacles(obstacles);
  internal::check_pairs(pairs, bodies.size(), obstacles.size());
  internal::check_pose_error(pose_error);
}

// Obstacles that are tested against the same bodies, as one.
internal::JoinedScene joined_obstacles(std::span<const MechanismMesh> bodies,
                                       std::span<const MechanismObstacle> obstacles,
                                       std::span<const MechanismPair> pairs) {
  // Bodies stand in for themselves only: each on a frame of its own, so that none are joined.
  const Sphere point{Eigen::Vector3d::Zero(), 0.0};
  const auto tree = std::make_shared<const SphereTree>(build_tree(std::span(&point, 1)));
  std::vector<MechanismBody> apart;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    apart.push_back({static_cast<int>(i), Pose(), tree});
  }
  return internal::JoinedScene(apart, obstacles, pairs);
}

std::shared_ptr<const internal::PackedMesh> moved(const MeshTree& mesh,
                                                  const Pose& frame_from_mesh) {
  std::vector<Triangle> judged;
  std::vector<Triangle> triangles;
  std::vector<Sphere> balls;
  for (const Sphere& ball : mesh.tree().spheres()) {
    const Triangle& triangle = mesh.triangle(static_cast<std::int32_t>(balls.size()));
    judged.push_back(triangle);
    triangles.push_back({frame_from_mesh * triangle[0], frame_from_mesh * triangle[1],
                         frame_from_mesh * triangle[2]});
    balls.push_back({frame_from_mesh * ball.center, ball.radius});
  }
  return std::make_shared<const internal::PackedMesh>(triangles, balls, judged);
}

}  // namespace

MeshMechanismCheck::~MeshMechanismCheck() = default;
MeshMechanismCheck::MeshMechanismCheck(MeshMechanismCheck&&) noexcept = default;
MeshMechanismCheck& MeshMechanismCheck::operator=(MeshMechanismCheck&&) noexcept = default;

MeshMechanismCheck::MeshMechanismCheck(std::span<const MechanismFrame> frames,
                                       std::span<const MechanismMesh> bodies,
                                       std::span<const MechanismObstacle> obstacles,
                                       std::span<const MechanismPair> pairs, double pose_error,
                                       InstructionSet instructions) {
  check_input(frames, bodies, obstacles, pairs, pose_error);
  const internal::Kernels& kernels = internal::kernels_for(instructions);
  internal::JoinedScene scene = joined_obstacles(bodies, obstacles, pairs);
  auto parts = std::make_unique<Parts>();
  for (const MechanismFrame& frame : frames) {
    parts->frames.push_back(internal::kernel_frame(frame));
  }
  const std::vector<internal::Chain> chains = internal::chains_of(frames);
  double farthest = 0.0;  // W of all bodies
  double most_links = 0.0;
  for (const MechanismMesh& body : bodies) {
    const internal::Chain& chain = chains[static_cast<std::size_t>(body.frame)];
    farthest = std::max(farthest, chain.length + body.frame_from_mesh.translation().norm() +
                                      node_reach(body.mesh->tree()));
    most_links = std::max(most_links, chain.frames);
  }
  double bound = farthest;  // X
  for (const MechanismObstacle& obstacle : obstacles) {
    bound = std::max(bound, obstacle.tree->reach() + obstacle.root_from_tree.translation().norm());
  }
  std::vector<SphereTree> trees;
  double around = 0.0;  // C
  for (const internal::JoinedSpheres& obstacle : scene.obstacles) {
    trees.push_back(build_tree(obstacle.spheres));
    around = std::max(around, node_reach(trees.back()));
  }
  if (!(farthest + around + bound <= kMaxCoordinate)) {
    throw Error("mechanism", "it or an obstacle reaches too far");
  }
  const double inflation = kPerLength * (farthest + around) +
                           kPerFrame * (most_links + 1.0) * farthest + kPerScene * bound +
                           pose_error;
  for (const MechanismMesh& body : bodies) {
    const auto& mesh = parts->meshes.emplace_back(moved(*body.mesh, body.frame_from_mesh));
    parts->bodies.push_back({mesh->view(), body.frame});
    const Sphere root = body.mesh->tree().ball(0);
    const Eigen::Vector3d center = body.frame_from_mesh * root.center;
    internal::KernelBody ball = {};
    std::copy_n(center.data(), 3, ball.center);
    // What single precision rounds is in the inflation and in this factor (packed_tree.h).
    ball.radius =
        internal::rounded_up_to_single(root.radius * (1.0 + 16.0 * internal::kFloatRoundoff));
    ball.frame = body.frame;
    parts->balls.push_back(ball);
  }
  for (const SphereTree& tree : trees) {
    const internal::PackedTree& packed = parts->trees.emplace_back(tree, inflation);
    assert(std::all_of(parts->meshes.begin(), parts->meshes.end(), [&](const auto& mesh) {
      return packed.depth() + mesh->depth() <= internal::MeshTasks::kLevels;
    }));
    parts->obstacles.push_back(
        {packed.nodes(), internal::rounded_up_to_single(3.0 * packed.largest_growth())});
  }
  for (const internal::KernelPair& pair : scene.pairs) {
    // Bodies have been joined with nothing, but stand in another order.
    const auto joined = static_cast<std::size_t>(pair.body);
    parts->pairs.push_back({scene.bodies[joined].origins[0].part, pair.obstacle});
  }
  parts->joined = std::move(scene.obstacles);
  parts->kernels = &kernels;
  parts->mesh_kernels = &internal::mesh_kernels_for(instructions);
  parts->kinematics = {.frames = parts->frames.data(),
                       .lane_frames = nullptr,
                       .frame_count = static_cast<std::int32_t>(parts->frames.size()),
                       .variable_count = internal::variable_count(frames),
                       .bodies = parts->balls.data(),
                       .body_count = static_cast<std::int32_t>(parts->balls.size()),
                       .obstacles = nullptr,
                       .pairs = nullptr,
                       .pair_count = 0};
  parts->problem = {.bodies = parts->bodies.data(),
                    .obstacles = parts->obstacles.data(),
                    .pairs = parts->pairs.data(),
                    .pair_count = static_cast<std::int32_t>(parts->pairs.size())};
  parts_ = std::move(parts);
}

MeshMechanismCheck::Scratch::Scratch(const MeshMechanismCheck& check)
    : memory_(std::make_unique<Memory>()) {
  const Parts& parts = *check.parts_;
  const auto variables = static_cast<std::size_t>((parts.kinematics.variable_count + 3) / 4 * 4);
  memory_->owner = check.parts_;
  memory_->sines.resize(variables);
  memory_->cosines.resize(variables);
  memory_->poses.resize(parts.frames.size());
  memory_->roots.resize(parts.balls.size());
  memory_->view.sines = memory_->sines.data();
  memory_->view.cosines = memory_->cosines.data();
  memory_->view.poses = memory_->poses.data();
  memory_->view.roots = memory_->roots.data();
}

MeshMechanismCheck::Scratch::~Scratch() = default;
MeshMechanismCheck::Scratch::Scratch(Scratch&&) noexcept = default;
MeshMechanismCheck::Scratch& MeshMechanismCheck::Scratch::operator=(Scratch&&) noexcept = default;

bool MeshMechanismCheck::collides(std::span<const double> variables, Scratch& scratch, Ask ask,
                                  void* context) const {
  const Parts& parts = *parts_;
  if (!scratch.memory_ || scratch.memory_->owner != parts_) {
    throw Error("scratch", "it was made for another check");
  }
  assert(MechanismCheck::is_in_range(variables));
  assert(variables.size() >= static_cast<std::size_t>(parts.kinematics.variable_count));
  Scratch::Memory& memory = *scratch.memory_;
  parts.kernels->place(parts.kinematics, variables.data(), memory.view);
  Translator translator{parts, ask, context};
  return parts.mesh_kernels->check(parts.problem, memory.poses.data(), memory.roots.data(),
                                   memory.tasks, &Translator::confirm, &translator);
}

}  // namespace spherule
