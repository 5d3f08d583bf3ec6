// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/report.h"

#include "base/files.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <sstream>

namespace spherule {
namespace {

using Json = nlohmann::ordered_json;

void print_sizes(const std::vector<SizeRow>& rows) {
  if (rows.empty()) return;
  std::printf("\nmore spheres over the same meshes (x: times the first row)\n");
  std::printf("%9s %10s %6s %10s %6s %10s %6s %10s %6s %11s %8s %7s\n", "spheres", "single ns", "x",
              "shuffled", "x", "batch", "x", "free ones", "x", "node tests", "hits", "missed");
  const SizeRow& first = rows.front();
  for (const SizeRow& row : rows) {
    std::printf("%9zu %10.1f %6.2f %10.1f %6.2f %10.1f %6.2f %10.1f %6.2f %11.1f %8zu %7zu\n",
                row.spheres, row.single_ns, row.single_ns / first.single_ns, row.shuffled_ns,
                row.shuffled_ns / first.shuffled_ns, row.batch_ns, row.batch_ns / first.batch_ns,
                row.free_ns, row.free_ns / first.free_ns, row.node_tests, row.collisions,
                row.missed);
  }
}

void print_small(const std::vector<SmallRow>& rows) {
  if (rows.empty()) return;
  std::printf("\nthe robot among few spheres, ns a check (x: times as fast as the flat scan)\n");
  std::printf("%9s %7s %7s %7s %9s %6s %9s %6s %9s %6s %10s %10s %7s %6s\n", "obstacles", "robot",
              "order", "hit %", "single", "x", "batch", "x", "collides", "x", "kinematics",
              "flat scan", "missed", "extra");
  for (const SmallRow& row : rows) {
    std::printf(
        "%9zu %7zu %7s %7.1f %9.1f %6.2f %9.1f %6.2f %9.1f %6.2f %10.1f %10.1f %7zu "
        "%6zu\n",
        row.obstacles, row.robot_spheres, row.order.c_str(), row.collision_percent, row.single_ns,
        row.flat_scan_ns / row.single_ns, row.batch_ns, row.flat_scan_ns / row.batch_ns,
        row.collides_ns, row.flat_scan_ns / row.collides_ns, row.kinematics_ns, row.flat_scan_ns,
        row.missed, row.extra);
  }
}

void print_distances(const std::vector<DistanceRow>& rows) {
  if (rows.empty()) return;
  std::printf(
      "\ntorch and workpiece at a distance, median ns (x: times as fast as FCL's meshes)\n");
  std::printf("%7s %8s | %9s %-13s %9s %-13s | %9s %7s %7s | %9s %9s %7s %7s\n", "d/size", "d mm",
              "fcl", "(setting)", "boxed", "(setting)", "collides", "x fcl", "x boxed", "same pose",
              "confirmed", "overl.%", "tests");
  for (const DistanceRow& row : rows) {
    std::printf(
        "%7.3f %8.2f | %9.0f %-13s %9.0f %-13s | %9.0f %7.2f %7.2f | %9.0f %9.0f %7.0f %7.0f\n",
        row.relative, 1e3 * row.distance, row.fcl_collide_ns, row.fcl_collide_setting.c_str(),
        row.fcl_boxed_collide_ns, row.fcl_boxed_collide_setting.c_str(), row.collides_ns,
        row.fcl_collide_ns / row.collides_ns, row.fcl_boxed_collide_ns / row.collides_ns,
        row.collides_same_poses_ns, row.confirmed_ns, row.overlap_percent, row.node_tests);
  }
  std::printf("%7s %8s | %9s %-13s | %9s %7s %7s\n", "d/size", "d mm", "fcl dist.", "(setting)",
              "distance", "x", "tests");
  for (const DistanceRow& row : rows) {
    std::printf("%7.3f %8.2f | %9.0f %-13s | %9.0f %7.2f %7.0f\n", row.relative, 1e3 * row.distance,
                row.fcl_distance_ns, row.fcl_distance_setting.c_str(), row.distance_ns,
                row.fcl_distance_ns / row.distance_ns, row.distance_node_tests);
  }
}

}  // namespace

void print_tables(const Studies& studies) {
  print_sizes(studies.sizes);
  print_small(studies.small_environments);
  print_distances(studies.distances);
  std::fflush(stdout);
}

Json to_json(const Studies& studies) {
  Json json{{"sizes", Json::array()},
            {"small_environments", Json::array()},
            {"distances", Json::array()}};
  for (const SizeRow& row : studies.sizes) {
    json["sizes"].push_back({{"factor", row.factor},
                             {"spheres", row.spheres},
                             {"single_ns", row.single_ns},
                             {"shuffled_ns", row.shuffled_ns},
                             {"batch_ns", row.batch_ns},
                             {"free_ns", row.free_ns},
                             {"node_tests", row.node_tests},
                             {"collisions", row.collisions},
                             {"missed", row.missed}});
  }
  for (const SmallRow& row : studies.small_environments) {
    json["small_environments"].push_back({{"obstacles", row.obstacles},
                                          {"robot_spheres", row.robot_spheres},
                                          {"order", row.order},
                                          {"collision_percent", row.collision_percent},
                                          {"single_ns", row.single_ns},
                                          {"batch_ns", row.batch_ns},
                                          {"collides_ns", row.collides_ns},
                                          {"kinematics_ns", row.kinematics_ns},
                                          {"flat_scan_ns", row.flat_scan_ns},
                                          {"missed", row.missed},
                                          {"extra", row.extra}});
  }
  for (const DistanceRow& row : studies.distances) {
    json["distances"].push_back({{"relative", row.relative},
                                 {"distance_m", row.distance},
                                 {"fcl_collide_ns", row.fcl_collide_ns},
                                 {"fcl_collide_setting", row.fcl_collide_setting},
                                 {"fcl_boxed_collide_ns", row.fcl_boxed_collide_ns},
                                 {"fcl_boxed_collide_setting", row.fcl_boxed_collide_setting},
                                 {"collides_ns", row.collides_ns},
                                 {"collides_same_poses_ns", row.collides_same_poses_ns},
                                 {"confirmed_ns", row.confirmed_ns},
                                 {"overlap_percent", row.overlap_percent},
                                 {"node_tests", row.node_tests},
                                 {"fcl_distance_ns", row.fcl_distance_ns},
                                 {"fcl_distance_setting", row.fcl_distance_setting},
                                 {"distance_ns", row.distance_ns},
                                 {"distance_node_tests", row.distance_node_tests}});
  }
  return json;
}

void write_plot_data(const Studies& studies, const std::string& name,
                     const std::filesystem::path& folder) {
  std::ostringstream sizes;
  sizes << "# spheres, single, shuffled, batch, free: ns\n";
  for (const SizeRow& row : studies.sizes) {
    sizes << row.spheres << ' ' << row.single_ns << ' ' << row.shuffled_ns << ' ' << row.batch_ns
          << ' ' << row.free_ns << '\n';
  }
  std::ostringstream small;
  small << "# obstacles, single, batch, collides, flat scan: ns; a data set for each robot and "
           "order\n";
  // Rows of one robot in one order, in the order in which these first appear.
  std::vector<std::vector<const SmallRow*>> sets;
  for (const SmallRow& row : studies.small_environments) {
    auto set = sets.begin();
    while (set != sets.end() &&
           (set->front()->robot_spheres != row.robot_spheres || set->front()->order != row.order)) {
      ++set;
    }
    if (set == sets.end()) set = sets.emplace(sets.end());
    set->push_back(&row);
  }
  for (const auto& set : sets) {
    if (&set != &sets.front()) small << "\n\n";  // gnuplot's mark of a new data set
    small << "\"" << set.front()->robot_spheres << " spheres, " << set.front()->order << "\"\n";
    for (const SmallRow* row : set) {
      small << row->obstacles << ' ' << row->single_ns << ' ' << row->batch_ns << ' '
            << row->collides_ns << ' ' << row->flat_scan_ns << '\n';
    }
  }
  std::ostringstream distances;
  distances << "# relative distance, ns: fcl collide, behind boxes, collides, in the same "
               "poses, confirmed, fcl distance, distance\n";
  for (const DistanceRow& row : studies.distances) {
    distances << row.relative << ' ' << row.fcl_collide_ns << ' ' << row.fcl_boxed_collide_ns << ' '
              << row.collides_ns << ' ' << row.collides_same_poses_ns << ' ' << row.confirmed_ns
              << ' ' << row.fcl_distance_ns << ' ' << row.distance_ns << '\n';
  }
  write_file_atomically(folder / (name + "-sizes.dat"), sizes.str());
  write_file_atomically(folder / (name + "-small.dat"), small.str());
  write_file_atomically(folder / (name + "-distances.dat"), distances.str());
}

}  // namespace spherule
