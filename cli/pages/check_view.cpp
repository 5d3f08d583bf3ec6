// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/check_view.h"

#include "base/error.h"
#include "cli/pages/view_page.h"
#include "cli/pages/view_robot.h"
#include "cli/robots/check_report.h"
#include "cli/robots/robot_input.h"
#include "cli/text/print.h"
#include "io/sphere_file.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/robot_spheres.h"
#include "robot/model/joint_positions.h"
#include "spheretree/tree_file.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {
namespace {

// Of longer trajectories a page shows so many configurations, evenly spread, the last one included;
// each step between two of them has the worst verdict of what is in it, and its first contact.
constexpr std::size_t kMostShownConfigurations = 10000;
// Of more contacts at one point a page shows so many, the deepest.
constexpr std::size_t kMostShownContacts = 8;

// How far triangles for curved obstacles may lie outside, as a share of their size.
constexpr double kChordShare = 0.01;
// The least side of the square that stands for a half-space, in metres.
constexpr double kLeastSide = 1.0;

double size_of(const Primitive& primitive) {
  if (const auto* cylinder = std::get_if<Cylinder>(&primitive)) return cylinder->radius;
  if (const auto* capsule = std::get_if<Capsule>(&primitive)) return capsule->radius;
  return 1.0;
}

// What stands in a scene, in the world: meshes and primitives as triangles, points, spheres and
// trees as spheres, and what is attached to links of the robot, in their frames. Of a half-space,
// a square of its surface about the other obstacles. Parts have the names of the scene. Throws
// Error as link_mesh() and the readers do.
class Obstacles {
 public:
  explicit Obstacles(const RobotModel& robot) : robot_(robot) {}

  std::vector<ViewItem> run(const SceneDescription& scene) && {
    for (const SceneObstacle& obstacle : scene.obstacles) {
      add(obstacle.name, -1, obstacle.world_from_shape, obstacle.shape);
    }
    for (const SceneAttachment& object : scene.attached) {
      add(object.name, robot_.find_link(object.link), object.link_from_object, object.shape);
    }
    for (const auto& [name, pose] : half_spaces_) add_square(name, pose);
    std::vector<ViewItem> items;
    if (!meshes_.parts.empty()) items.push_back(std::move(meshes_));
    if (!spheres_.parts.empty()) items.push_back(std::move(spheres_));
    return items;
  }

 private:
  template <class Shape>
  void add(const std::string& name, int link, const Pose& pose, const Shape& shape) {
    name_ = name;
    link_ = link;
    pose_ = pose;
    std::visit([this](const auto& source) { this->add(source); }, shape);
  }
  void add(const MeshFile& file) { add_shape(file, {}); }
  void add(const Primitive& primitive) {
    if (std::holds_alternative<HalfSpace>(primitive)) {
      half_spaces_.emplace_back(name_, pose_);
    } else if (const auto* sphere = std::get_if<SolidSphere>(&primitive)) {
      add_spheres(std::vector<Sphere>{{Eigen::Vector3d::Zero(), sphere->radius}});
    } else {
      add_shape(primitive, {.chord_error = kChordShare * size_of(primitive)});
    }
  }
  void add(const PointsSource& source) { add_spheres(point_spheres(source)); }
  void add(const SpheresSource& source) { add_spheres(load_spheres(source.path).spheres); }
  void add(const TreeSource& source) { add_spheres(load_tree(source.path).spheres()); }

  void add_shape(const std::variant<MeshFile, Primitive>& geometry,
                 const LinkMeshOptions& options) {
    const LinkDescription shape{
        .name = name_, .visual = {}, .collision = {LinkShape{{}, pose_, geometry}}};
    if (auto mesh = link_mesh(shape, options)) add_mesh(std::move(*mesh));
  }
  void add_mesh(TriangleMesh mesh) {
    if (link_ < 0) {
      for (const Eigen::Vector3d& vertex : mesh.vertices) box_.extend(vertex);
    }
    meshes_.parts.push_back({std::move(mesh), link_, name_});
  }
  void add_spheres(std::span<const Sphere> spheres) {
    std::vector<Sphere> placed;
    for (const Sphere& sphere : spheres) {
      placed.push_back({pose_ * sphere.center, sphere.radius});
      if (link_ < 0) box_.extend(placed.back().center);
    }
    spheres_.parts.push_back({std::move(placed), link_, name_});
  }

  // The surface of a half-space below and around the rest.
  void add_square(const std::string& name, const Pose& pose) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double half = 0.5 * kLeastSide;
    if (!box_.isEmpty()) {
      middle = pose.inverse() * Eigen::Vector3d(box_.center());
      half = std::max(half, 0.75 * box_.diagonal().norm());
    }
    TriangleMesh square;
    for (const auto& [x, y] :
         {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
      square.vertices.push_back(pose *
                                Eigen::Vector3d(middle.x() + half * x, middle.y() + half * y, 0.0));
    }
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    meshes_.parts.push_back({std::move(square), -1, name, true});
  }

  const RobotModel& robot_;
  ViewItem meshes_{.name = "obstacles and tools", .parts = {}};
  ViewItem spheres_{.name = "obstacles and tools of spheres", .parts = {}};
  std::vector<std::pair<std::string, Pose>> half_spaces_{};  // drawn when all else is known
  Eigen::AlignedBox3d box_{};                                // of the obstacles
  std::string name_{};  // of what is added, its link and its place
  int link_ = -1;
  Pose pose_{};
};

std::vector<float> floats_of(std::span<const double> numbers) {
  std::vector<float> floats(numbers.size());
  std::ranges::transform(numbers, floats.begin(), [](double x) { return static_cast<float>(x); });
  return floats;
}

// The configurations that are shown, by their indices.
std::vector<std::size_t> shown_of(std::size_t count) {
  constexpr std::size_t kGaps = kMostShownConfigurations - 1;
  const std::size_t step = count < 2 ? 1 : (count - 1 + kGaps - 1) / kGaps;
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < count; i += step) shown.push_back(i);
  if (shown.back() != count - 1) shown.push_back(count - 1);
  return shown;
}

// A trajectory as the page takes it, `report` with the verdicts of it. Of n shown configurations:
// `lines` of the file, `positions`, `clearance` (its lower bound, metres) and `nearest` (two
// indices into `bodies`), as 32-bit words, and `skipped`, whether two links were anywhere left out
// of a clearance because they are proved free there; `verdicts`, a letter for each configuration,
// or for each step from one to the next where motions were proved: f free, c collision, u not
// proved, l outside the joint limits where these are enforced. `points` are what was examined and
// touches: "at" on the scale of the shown configurations, line, next line (0 for a configuration of
// the file), fraction, "configuration" unless it is a shown one, and contacts, 12 floats each: the
// two bodies, depth, point, and of either body link, tree and sphere, -1 for what has none.
class Recording {
 public:
  Recording(const RobotChecker& checker, const Trajectory& trajectory, const CheckReport& report,
            const TrajectoryView& view)
      : checker_(checker),
        trajectory_(trajectory),
        report_(report),
        view_(view),
        shown_(shown_of(trajectory.size())),
        clearances_(shown_.size()),
        contacts_(shown_.size()),
        scratches_(make_scratches(checker, view.threads)) {}

  Json run() && {
    examine_shown();
    Json json{{"file", view_.file},
              {"motions", view_.has_motions},
              {"shortest", view_.continuous == ContinuousMotion::kShortest},
              {"configurations", trajectory_.size()},
              {"verdict", verdict_of(report_)},
              {"shown", shown_.size()}};
    put_configurations(json);
    put_steps(json);
    json["bodies"] = names_;
    return json;
  }

 private:
  // Clearance and contacts of the shown configurations, each thread with a scratch of its own.
  void examine_shown() {
    std::vector<std::future<void>> shares;
    for (std::size_t t = 0; t < scratches_.size(); ++t) {
      shares.push_back(std::async(std::launch::async, [this, t] { examine_share(t); }));
    }
    for (std::future<void>& share : shares) share.get();
  }
  void examine_share(std::size_t thread) {
    for (std::size_t j = thread; j < shown_.size(); j += scratches_.size()) {
      const std::span configuration = trajectory_.configuration(shown_[j]);
      clearances_[j] =
          checker_.clearance(configuration, scratches_[thread], {.skip_proved_free = true});
      contacts_[j] = checker_.explain(configuration, scratches_[thread]);
      if (thread == 0 && view_.progress && j % 64 == 0) {
        view_.progress(static_cast<double>(j) / static_cast<double>(shown_.size()),
                       "measuring clearances");
      }
    }
  }

  void put_configurations(Json& json) {
    std::vector<std::int32_t> lines;
    std::vector<float> positions;
    std::vector<float> clearance;
    std::vector<std::int32_t> nearest;
    for (std::size_t j = 0; j < shown_.size(); ++j) {
      lines.push_back(static_cast<std::int32_t>(trajectory_.lines[shown_[j]]));
      const std::vector<float> numbers = floats_of(trajectory_.configuration(shown_[j]));
      positions.insert(positions.end(), numbers.begin(), numbers.end());
      // Rounded toward zero, so that it stays a lower bound.
      float bound = static_cast<float>(clearances_[j].lower);
      if (static_cast<double>(bound) > clearances_[j].lower) bound = std::nextafter(bound, 0.0F);
      clearance.push_back(bound);
      nearest.push_back(index_of(clearances_[j].first.name));
      nearest.push_back(index_of(clearances_[j].second.name));
    }
    json["lines"] = encode_words(lines);
    json["positions"] = encode_words(positions);
    json["clearance"] = encode_words(clearance);
    json["nearest"] = encode_words(nearest);
    json["skipped"] = std::ranges::any_of(clearances_, &RobotClearance::skipped);
  }

  // The verdict of each step and the points with contacts, in their order.
  void put_steps(Json& json) {
    std::string verdicts;
    json["points"] = Json::array();
    for (std::size_t j = 0; j < shown_.size(); ++j) {
      const std::size_t begin = shown_[j];
      const bool is_last = j + 1 == shown_.size();
      const std::size_t end = is_last ? begin + 1 : shown_[j + 1];
      if (!contacts_[j].empty()) {
        json["points"].push_back(
            Json::array({j, trajectory_.lines[begin], 0, 0.0, nullptr, encode(contacts_[j])}));
      }
      if (!view_.has_motions || !is_last) verdicts += step_verdict(begin, end, j, json["points"]);
    }
    json["verdicts"] = verdicts;
  }

  // Where limits are enforced. They are a box of positions: a motion between two configurations
  // within it stays there.
  bool is_outside_limits(std::size_t index) const {
    return report_.enforces_limits &&
           joint_outside_limits(checker_.robot(), trajectory_.configuration(index)) != nullptr;
  }

  // The worst verdict of the configurations or motions of a step; its first contact goes to the
  // points, unless it is that of the shown configuration with which the step begins.
  char step_verdict(std::size_t begin, std::size_t end, std::size_t j, Json& points) {
    const TrajectoryVerdicts& verdicts = report_.found.verdicts;
    char worst = 'f';
    for (std::size_t i = begin; i < end; ++i) {
      const EdgeResult* motion = view_.has_motions ? &verdicts.motions[i] : nullptr;
      if (is_outside_limits(i) || (motion && is_outside_limits(i + 1))) worst = 'l';
      if (motion && motion->verdict == Verdict::kUnknown && worst == 'f') worst = 'u';
      if (motion ? motion->verdict != Verdict::kCollision : verdicts.free[i] != 0) continue;
      const double fraction = motion ? motion->contact_at : 0.0;
      if (fraction > 0.0 || i > begin) points.push_back(point(j, begin, end, i, fraction));
      return 'c';
    }
    return worst;
  }

  // What touches in a configuration that is not among the shown ones.
  Json point(std::size_t j, std::size_t begin, std::size_t end, std::size_t index,
             double fraction) {
    const std::span from = trajectory_.configuration(index);
    std::vector<double> configuration(from.begin(), from.end());
    if (fraction > 0.0) {
      configuration = checker_.configuration_on_edge(from, trajectory_.configuration(index + 1),
                                                     fraction, view_.continuous);
    }
    const double share =
        (static_cast<double>(index - begin) + fraction) / static_cast<double>(end - begin);
    const std::size_t next = view_.has_motions ? trajectory_.lines[index + 1] : 0;
    return Json::array({static_cast<float>(static_cast<double>(j) + share),
                        trajectory_.lines[index], next, static_cast<float>(fraction),
                        encode_words(floats_of(configuration)),
                        encode(checker_.explain(configuration, scratches_.front()))});
  }

  std::string encode(std::vector<CheckedContact> contacts) {
    std::stable_sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
      return a.overlap_depth > b.overlap_depth;
    });
    contacts.resize(std::min(contacts.size(), kMostShownContacts));
    std::vector<float> numbers;
    for (const CheckedContact& contact : contacts) {
      const Eigen::Vector3d& at = contact.world_point;
      for (const double number : {static_cast<double>(index_of(contact.first.name)),
                                  static_cast<double>(index_of(contact.second.name)),
                                  contact.overlap_depth, at.x(), at.y(), at.z()}) {
        numbers.push_back(static_cast<float>(number));
      }
      for (const CheckedBody* body : {&contact.first, &contact.second}) {
        const bool is_link = body->kind == CheckedBody::Kind::kLink;
        const int link = is_link ? checker_.robot().find_link(body->name) : -1;
        for (const int number : {link, static_cast<int>(body->tree), body->sphere}) {
          numbers.push_back(static_cast<float>(number));
        }
      }
    }
    return encode_words(numbers);
  }

  std::int32_t index_of(const std::string& name) {
    if (name.empty()) return -1;
    const auto [found, is_new] = indices_.emplace(name, static_cast<std::int32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return found->second;
  }

  const RobotChecker& checker_;
  const Trajectory& trajectory_;
  const CheckReport& report_;
  const TrajectoryView& view_;
  std::vector<std::size_t> shown_;
  std::vector<RobotClearance> clearances_;
  std::vector<std::vector<CheckedContact>> contacts_;
  std::vector<RobotChecker::Scratch> scratches_;
  std::vector<std::string> names_{};
  std::map<std::string, std::int32_t> indices_{};
};

ViewItem checked_spheres(const RobotModel& robot) {
  ViewItem item{.name = "checked spheres", .parts = {}, .checked = true};
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      item.parts.push_back({*tree, static_cast<int>(link)});
    }
  }
  return item;
}

ViewScene scene_of(const CheckedScene& checked, const TrajectoryView& view) {
  ViewScene scene{.title = view.file, .items = {}};
  scene.robot = view_robot(checked.robot);
  scene.robot["pose"] = view_pose(checked.scene.world_from_root);
  try {
    ViewItem meshes =
        view_meshes(checked.robot, geometry_named(checked.geometry), checked.geometry);
    if (!meshes.parts.empty()) scene.items.push_back(std::move(meshes));
  } catch (const Error& error) {
    warn(std::string("the page shows no meshes of the robot: ") + error.what());
  }
  scene.items.push_back(checked_spheres(checked.checker.robot()));
  for (ViewItem& item : Obstacles(checked.robot.model).run(checked.scene)) {
    scene.items.push_back(std::move(item));
  }
  scene.trajectory = Recording(checked.checker, checked.trajectory, checked.report, view).run();
  return scene;
}

}  // namespace

void write_check_page(const std::string& page, const CheckedScene& checked,
                      const TrajectoryView& view) {
  write_page(page, scene_of(checked, view));
}

}  // namespace spherule
