// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/robot_spheres.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "base/threads.h"
#include "geometry/triangle_mesh.h"
#include "robot/cover/link_parts.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <numeric>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

namespace spherule {
namespace {

// Of a link's box diagonal: how far apart rounding leaves what was one vertex.
constexpr double kCrack = 1e-6;
// Up to such a radius, a quarter of kChordErrorOfError takes few triangles.
constexpr double kErrorsOfUsualRadius = 1000.0;

// What one cover is made for: links with the same shapes, lengths and no zones, or a single one.
struct Task {
  std::vector<std::size_t> links;  // indices
  TriangleMesh mesh{};             // empty where there are spheres
  std::vector<Sphere> spheres{};   // what the links are made of, where that is nothing else
  std::span<const LinkShape> shapes;
  double chord_error = 0.0;  // of the mesh, if shapes are curved
  SimplifyOptions options;
  double across = 0.0;  // the diagonal of the box of the mesh or spheres
  std::string doubt{};  // about its size; mostly empty
};

void require(bool ok, const std::string& subject, const std::string& what) {
  if (!ok) throw Error(subject, what);
}

// What simplify() would take for a default, or refuse under a name that is not the link's.
void check_lengths(double max_error, double min_external_diameter, double padding,
                   const std::string& prefix) {
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  require(max_error > 0.0 && usable(max_error), prefix + "max error",
          "must be positive and finite");
  require(usable(min_external_diameter), prefix + "min external diameter",
          "must be finite and not negative");
  require(usable(padding), prefix + "padding", "must be finite and not negative");
}

SimplifyOptions options_for(const std::string& link, const RobotCoverOptions& options) {
  SimplifyOptions result;
  result.max_error = options.max_error;
  result.min_external_diameter = options.min_external_diameter;
  result.tightness = options.tightness;
  result.padding = options.padding;
  result.seed = options.seed;
  result.effort = options.effort;
  result.seconds = options.seconds;
  result.stop = options.stop;
  const auto own = options.links.find(link);
  if (own == options.links.end()) return result;
  result.max_error = own->second.max_error.value_or(result.max_error);
  result.min_external_diameter =
      own->second.min_external_diameter.value_or(result.min_external_diameter);
  result.padding = own->second.padding.value_or(result.padding);
  result.zones = own->second.zones;
  check_lengths(result.max_error, result.min_external_diameter, result.padding,
                internal::subject_of(link) + " ");
  internal::of_link(link, [&] {
    SimplifyOptions complete = result;
    complete_lengths(complete, {});
    check_zones(complete.zones, complete.max_error, complete.min_external_diameter);
  });
  return result;
}

// Where the E of every link is far larger than the link, it was meant in another unit.
void require_errors_below_sizes(const std::vector<Task>& tasks) {
  constexpr double kFar = 10.0;
  double largest = 0.0;
  for (const Task& task : tasks) {
    if (task.options.max_error <= kFar * task.across) return;
    largest = std::max(largest, task.across);
  }
  const double max_error = tasks.front().options.max_error;
  std::ostringstream reason;
  reason << max_error << " m is far more than any link is across (" << largest
         << " m at most): if it was meant in millimetres, it is " << max_error / 1000.0 << " m";
  throw Error("max error", reason.str());
}

// Meshes not yet read.
std::vector<Task> tasks_of(const RobotDescription& robot, const RobotCoverOptions& options) {
  std::vector<Task> tasks;
  const std::vector<std::size_t> first = internal::first_equal_links(robot, options.geometry);
  // By the first equal link and the lengths: the task of those without zones.
  std::map<std::tuple<std::size_t, double, double, double>, std::size_t> known;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const LinkDescription& link = robot.links[i];
    if (link_shapes(link, options.geometry).empty()) continue;
    SimplifyOptions own = options_for(link.name, options);
    if (own.zones.empty()) {
      const auto [task, is_new] = known.try_emplace(
          {first[i], own.max_error, own.min_external_diameter, own.padding}, tasks.size());
      if (!is_new) {
        tasks[task->second].links.push_back(i);
        continue;
      }
    }
    tasks.push_back(
        {.links = {i}, .shapes = link_shapes(link, options.geometry), .options = std::move(own)});
  }
  return tasks;
}

std::vector<Task> read_links(const RobotDescription& robot, const RobotCoverOptions& options,
                             std::size_t threads) {
  std::vector<Task> tasks = tasks_of(robot, options);
  const bool collision = options.geometry == LinkGeometry::kCollision;
  require(!tasks.empty(), robot.name,
          std::string("no link has ") + (collision ? "collision" : "visual") +
              " geometry; try the other one, " + (collision ? "visual" : "collision"));
  internal::share_work(tasks.size(), threads, [&](std::size_t, std::size_t i) {
    Task& task = tasks[i];
    const LinkDescription& link = robot.links[task.links.front()];
    const double max_error = task.options.max_error;
    if (auto spheres = internal::exact_spheres(link, options.geometry, task.options.padding)) {
      task.spheres = *std::move(spheres);
      task.across = internal::box_of(task.spheres).diagonal().norm();
    } else {
      const double radius = internal::largest_radius(task.shapes);
      const double tightest = tightest_error(task.options.zones, max_error);
      const double chord_error =
          (radius <= kErrorsOfUsualRadius * tightest ? 0.25 : 1.0) * kChordErrorOfError * tightest;
      task.mesh = *link_mesh(
          link, {.geometry = options.geometry, .chord_error = chord_error, .weld = options.weld});
      if (radius > 0.0) task.chord_error = chord_error;
      task.across = internal::box_of(task.mesh).diagonal().norm();
    }
    const std::string fault = internal::size_fault(task.across, max_error);
    require(fault.empty(), internal::subject_of(link.name), fault);
  });
  require_errors_below_sizes(tasks);
  for (Task& task : tasks) {
    task.doubt = internal::size_doubt(task.across, task.options.max_error);
    if (task.doubt.empty() || !options.on_doubt) continue;
    for (const std::size_t link : task.links) options.on_doubt(robot.links[link].name, task.doubt);
  }
  return tasks;
}

std::vector<std::string> warnings_of(const Task& task, const Simplification& fit, double weld) {
  std::vector<std::string> warnings;
  if (!task.doubt.empty()) warnings.push_back(task.doubt);
  if (!task.spheres.empty()) return warnings;
  const MeshReport report = mesh_report(task.mesh, {.self_intersections = false});
  if (!report.closed) {
    std::ostringstream text;
    text
        << internal::openness(report)
        << ": the surface is covered in any case, but space that things of the size D can get into "
           "counts as outside";
    if (report.boundary_edges > 0 && weld == 0.0) {
      text << "; if rounding has left cracks, welding within " << kCrack * task.across
           << " m (--weld) shuts them";
    }
    warnings.push_back(text.str());
  }
  if (fit.larger_diameter) {
    warnings.push_back(internal::link_diameter_warning(fit.options.min_external_diameter));
  }
  const std::string broken = broken_promises(fit);
  if (!broken.empty()) warnings.push_back(broken);
  return warnings;
}

// Spheres are their own solid, and their own cover: they protrude by what rounding the padding
// added.
Simplification of_spheres(const Task& task) {
  Simplification fit;
  fit.options = task.options;
  complete_lengths(fit.options, {});
  fit.external = {.spheres = {},
                  .box = internal::box_of(task.spheres),
                  .min_external_diameter = fit.options.min_external_diameter,
                  .padding = task.options.padding,
                  .concave_edges = {}};
  fit.cover.spheres = task.spheres;
  const double over_shapes = *internal::protrusion_over_primitives(task.shapes, task.spheres);
  const double rounding = task.options.padding == 0.0
                              ? over_shapes
                              : std::max(0.0, sub_up(over_shapes, task.options.padding));
  Certificate& certificate = fit.certificate;
  certificate.covered = true;
  certificate.protrusion_over_simplified_max = rounding;
  certificate.protrusion_in_zones.assign(task.options.zones.size(), rounding);
  certificate.protrusion_over_mesh = Bounds{0.0, over_shapes};
  if (task.options.padding == 0.0) certificate.volume_ratio = 1.0;
  certificate.filled_volume = certificate.filled_volume_error = 0.0;
  certificate.sphere_count = task.spheres.size();
  return fit;
}

// No D of its own is chosen for a smaller E, unless the link is so large that a larger one may be.
constexpr double kErrorsOfUsualLink = 200.0;

// The spheres may protrude from the mesh around curved shapes by so much less than from these as
// the mesh does itself.
Simplification of_mesh(const Task& task) {
  SimplifyOptions options = task.options;
  if (task.chord_error > 0.0) {
    if (task.across <= kErrorsOfUsualLink * options.max_error) complete_lengths(options, {});
    // So that the sum is not above E by a rounding.
    const auto shrink = [&](double& error) { error = (error - task.chord_error) * kRelativeDown; };
    shrink(options.max_error);
    for (Zone& zone : options.zones) {
      if (zone.max_error) shrink(*zone.max_error);
    }
  }
  Simplification fit = simplify(task.mesh, options);
  if (task.chord_error == 0.0) return fit;
  fit.options.max_error = task.options.max_error;
  fit.options.zones = task.options.zones;
  const auto grow = [&](double& protrusion) { protrusion = add_up(protrusion, task.chord_error); };
  Certificate& certificate = fit.certificate;
  grow(*certificate.protrusion_over_simplified_max);
  for (double& protrusion : certificate.protrusion_in_zones) grow(protrusion);
  Bounds& over_mesh = *certificate.protrusion_over_mesh;
  grow(over_mesh.upper);
  if (const auto exact = internal::protrusion_over_primitives(task.shapes, fit.cover.spheres)) {
    over_mesh.upper = std::min(over_mesh.upper, *exact);
  }
  return fit;
}

LinkCover cover_link(const std::string& link, const Task& task, double weld) {
  const auto start = std::chrono::steady_clock::now();
  LinkCover cover;
  cover.link = link;
  internal::of_link(link,
                    [&] { cover.fit = task.spheres.empty() ? of_mesh(task) : of_spheres(task); });
  cover.spheres = cover.fit->cover.spheres;
  cover.triangles = task.mesh.triangles.size();
  cover.vertex_error = task.mesh.vertex_error;
  cover.warnings = warnings_of(task, *cover.fit, weld);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  cover.seconds = seconds.count();
  return cover;
}

// The cover of a link with the same shapes; no time went into it.
LinkCover of_equal_link(LinkCover cover, const std::string& link) {
  cover.link = link;
  cover.seconds = 0.0;
  cover.fit->times = {};
  return cover;
}

}  // namespace

void check_cover_options(const RobotDescription& robot, const RobotCoverOptions& options) {
  check_lengths(options.max_error, options.min_external_diameter, options.padding, "");
  for (const auto& entry : options.links) {
    const std::string& name = entry.first;
    const auto link = std::find_if(robot.links.begin(), robot.links.end(),
                                   [&](const LinkDescription& l) { return l.name == name; });
    if (link == robot.links.end()) {
      throw Error(internal::subject_of(name),
                  "the robot has no such link" +
                      internal::did_you_mean(name, robot.links, &LinkDescription::name));
    }
    require(!link_shapes(*link, options.geometry).empty(), internal::subject_of(name),
            "has options and no geometry to cover");
  }
}

RobotCover cover_robot(const RobotDescription& robot, const RobotCoverOptions& options) {
  check_cover_options(robot, options);
  const internal::ThreadLimit limit(options.threads);
  const std::size_t threads = internal::thread_count();
  std::vector<Task> tasks = read_links(robot, options, threads);

  RobotCover result{.robot = robot.name, .links = {}, .options = options};
  for (const LinkDescription& link : robot.links) result.links.push_back({.link = link.name});

  // The longest first, so that none of them is left at the end. The order changes no result.
  std::stable_sort(tasks.begin(), tasks.end(), [](const Task& a, const Task& b) {
    return a.mesh.triangles.size() > b.mesh.triangles.size();
  });
  std::atomic<std::size_t> done = 0;
  // Half of the threads begin a link each, as memory is needed for each; the others help within
  // links, which is what is left to do when the last links are long ones.
  internal::share_work(tasks.size(), (threads + 1) / 2, [&](std::size_t, std::size_t i) {
    Task& task = tasks[i];
    const std::string& name = robot.links[task.links.front()].name;
    const auto tell = [&] {
      const double share = static_cast<double>(done) / static_cast<double>(tasks.size());
      if (options.progress) options.progress(share, name.c_str());
    };
    if (options.progress) task.options.progress = [&tell](double, const char*) { tell(); };
    tell();
    LinkCover& cover = result.links[task.links.front()];
    cover = cover_link(name, task, options.weld);
    cover.fit->options.progress = {};
    cover.fit->options.stop = {};
    for (const std::size_t link : std::span(task.links).subspan(1)) {
      result.links[link] = of_equal_link(cover, robot.links[link].name);
    }
    ++done;
    tell();
  });
  return result;
}

std::vector<std::string> links_not_proved(const RobotCover& cover) {
  std::vector<std::string> names;
  for (const LinkCover& link : cover.links) {
    if (link.fit && !broken_promises(*link.fit).empty()) names.push_back(link.link);
  }
  return names;
}

std::vector<std::string> links_interrupted(const RobotCover& cover) {
  std::vector<std::string> names;
  for (const LinkCover& link : cover.links) {
    if (link.fit && link.fit->interrupted) names.push_back(link.link);
  }
  return names;
}

namespace {

bool is_below_joint_of_its_name(const RobotModel& robot, const std::string& link) {
  const int index = robot.find_link(link);
  const int joint = index < 0 ? -1 : robot.links()[static_cast<std::size_t>(index)].parent_joint;
  return joint >= 0 && robot.joints()[static_cast<std::size_t>(joint)].name == link;
}

}  // namespace

RobotSpheres robot_spheres(const RobotDescription& robot, const RobotCover& cover) {
  RobotSpheres result;
  result.robot = cover.robot;
  result.interrupted = !links_interrupted(cover).empty();
  for (const LinkCover& link : cover.links) result.links.push_back({link.link, link.spheres});
  const auto has_spheres = [&](int link) {
    return !cover.links[static_cast<std::size_t>(link)].spheres.empty();
  };
  const int count = static_cast<int>(cover.links.size());
  const internal::LinkRelations relations(robot.model);
  for (int first = 0; first < count; ++first) {
    if (!has_spheres(first)) continue;
    const auto related = relations.of(first, has_spheres);
    for (int second = first + 1; second < count; ++second) {
      const auto& relation = related[static_cast<std::size_t>(second)];
      if (!has_spheres(second) || relation.joined == internal::Joined::kFurther) continue;
      const std::string_view reason = relation.are_neighbours ? kAdjacentReason : kRigidReason;
      result.self_collision_ignore.push_back({cover.links[static_cast<std::size_t>(first)].link,
                                              cover.links[static_cast<std::size_t>(second)].link,
                                              std::string(reason)});
    }
  }
  // Other files know nothing of the links within planar and floating joints.
  std::erase_if(result.links, [&](const LinkSpheres& link) {
    return link.spheres.empty() && link.link.find('/') != std::string::npos &&
           is_below_joint_of_its_name(robot.model, link.link);
  });
  return result;
}

}  // namespace spherule
