// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/rooms.h"

#include <algorithm>
#include <initializer_list>

namespace spherule {
namespace {

// Rooms that belong to one library: each library has the folder of its CMakeLists.txt.
constexpr std::string_view kLibraryFolders[] = {
    "spheretree",     "mesh",    "mesh/io", "simplifier",   "simplifier/baseline",
    "simplifier/cad", "collide", "robot",   "adapters/fcl", "adapters/ompl"};

Names joined(std::initializer_list<Names> lists) {
  Names all;
  for (const Names& names : lists) all.insert(all.end(), names.begin(), names.end());
  return all;
}

}  // namespace

const std::vector<Room>& rooms() {
  static const Names kMesh = {"spheretree", "mesh", "mesh/geometry", "mesh/shells"};
  static const Names kSimplifier =
      joined({kMesh,
              {"simplifier", "simplifier/support", "simplifier/solid", "simplifier/stage1",
               "simplifier/proof", "simplifier/stage2", "simplifier/stage2/search",
               "simplifier/stage2/bound", "simplifier/stage2/paper"}});
  static const Names kCollide =
      joined({kMesh,
              {"collide", "collide/search", "collide/solids", "collide/mechanism", "collide/motion",
               "collide/meshes", "collide/kernels"}});
  static const Names kRobot = {"robot/model", "robot/files", "robot/formats",
                               "robot/pairs", "robot/cover", "robot/check"};
  static const Names kPublic =
      joined({{"spheretree", "mesh", "mesh/io", "simplifier", "collide"},
              kRobot,
              {"simplifier/baseline", "simplifier/cad", "adapters/fcl", "adapters/ompl"}});
  static const Names kCli = joined({kPublic, {"spheretree/text"}});
  static const Names kAll =
      joined({kPublic, kSimplifier, kCollide, {"spheretree/text", "mesh/parsing", "bench"}});
  static const std::vector<Room> kRooms = {
      {"spheretree", {"spheretree/text"}, {"Eigen"}, {{"nlohmann", "io/sphere_file.cpp"}}},
      {"spheretree/text", {}, {}, {}, true},

      {"mesh", kMesh, {"Eigen"}},
      {"mesh/geometry", {"spheretree", "mesh"}, {"Eigen"}, {}, true},
      {"mesh/shells", {"spheretree", "mesh", "mesh/geometry"}, {"Eigen"}, {}, true},
      {"mesh/parsing", {"spheretree", "spheretree/text"}, {"Eigen"}, {}, true},
      {"mesh/io",
       {"spheretree", "spheretree/text", "mesh", "mesh/geometry", "mesh/parsing"},
       {"Eigen"},
       {{"expat", "io/xml_events.cpp"},
        {"nlohmann", "io/gltf_document.h"},
        {"tinyxml2", "io/collada_document.h"},
        {"zlib", "io/zip_member.cpp"}}},

      {"simplifier",
       joined({kSimplifier, {"spheretree/text"}}),
       {"Eigen", "tbb"},
       {{"nlohmann", "simplifier/zone_file.cpp"}}},
      {"simplifier/support", {"spheretree"}, {"Eigen", "tbb"}, {}, true},
      {"simplifier/solid",
       {"spheretree", "mesh", "simplifier", "simplifier/support"},
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/stage1",
       joined({kMesh, {"simplifier", "simplifier/support", "simplifier/solid"}}),
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/proof",
       joined({kMesh, {"simplifier", "simplifier/support", "simplifier/solid"}}),
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/stage2/search",
       {"spheretree", "simplifier/support"},
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/stage2/bound",
       joined({kMesh, {"simplifier", "simplifier/support", "simplifier/solid"}}),
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/stage2",
       joined({kMesh,
               {"simplifier", "simplifier/support", "simplifier/solid", "simplifier/proof",
                "simplifier/stage2/search", "simplifier/stage2/bound"}}),
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/stage2/paper",
       joined({kMesh,
               {"simplifier", "simplifier/support", "simplifier/solid", "simplifier/proof",
                "simplifier/stage2"}}),
       {"Eigen", "tbb"},
       {},
       true},
      {"simplifier/baseline",
       kSimplifier,
       {"Eigen", "tbb"},
       {{"meshoptimizer", "simplifier/baseline/decimation.cpp"},
        {"openvdb", "simplifier/baseline/level_set_packing.cpp"},
        {"qhull", "simplifier/baseline/convex_hull.cpp"},
        {"qhull", "simplifier/baseline/internal/voronoi.cpp"},
        {"bullet", "simplifier/baseline/convex_decomposition.cpp"}}},
      {"simplifier/cad",
       joined({kSimplifier, {"mesh/parsing"}}),
       {"Eigen"},
       {{"opencascade", "io/cad/cad_translation.cpp"},
        {"opencascade", "io/cad/cad_translation.cpp"},
        {"opencascade", "io/cad/cad_translation.h"},
        {"opencascade", "io/cad/cad_shape.cpp"},
        {"opencascade", "io/cad/cad_translation.cpp"},
        {"opencascade", "io/cad/cad_translation.h"},
        {"opencascade", "io/cad/cad_shape.cpp"}}},

      {"collide", kCollide, {"Eigen"}},
      {"collide/search", {"spheretree", "collide"}, {"Eigen"}, {}, true},
      {"collide/solids", joined({kMesh, {"collide", "collide/search"}}), {"Eigen"}, {}, true},
      {"collide/mechanism", {"spheretree", "collide", "collide/search"}, {"Eigen"}, {}, true},
      {"collide/motion", {"spheretree", "collide", "collide/search"}, {"Eigen"}, {}, true},
      {"collide/meshes",
       joined({kMesh, {"collide", "collide/search", "collide/solids", "collide/mechanism"}}),
       {"Eigen"},
       {},
       true},
      {"collide/kernels",
       {"spheretree", "collide", "collide/search", "collide/solids", "collide/mechanism"},
       {"Eigen"},
       {},
       true},

      {"robot/model", {"spheretree", "spheretree/text", "collide", "collide/kernels"}, {"Eigen"}},
      {"robot/files",
       {"spheretree", "spheretree/text", "mesh/parsing", "collide", "robot/model"},
       {"Eigen"},
       {{"nlohmann", "robot/files/scene_file.cpp"}, {"tinyxml2", "robot/files/xml_file.cpp"}}},
      {"robot/formats",
       {"spheretree", "spheretree/text", "robot/model", "robot/files"},
       {"Eigen"},
       {{"nlohmann", "robot/formats/sphere_formats_json.cpp"},
        {"tinyxml2", "robot/formats/sphere_formats_xml.cpp"},
        {"yaml-cpp", "robot/formats/yaml_nodes.h"},
        {"yaml-cpp", "robot/formats/internal/yaml_nodes.cpp"}}},
      {"robot/pairs",
       {"spheretree", "spheretree/text", "collide", "robot/model", "robot/files"},
       {"Eigen"}},
      {"robot/cover",
       {"spheretree", "spheretree/text", "mesh", "mesh/geometry", "mesh/io", "mesh/parsing",
        "simplifier", "collide", "robot/model", "robot/files", "robot/formats", "robot/pairs"},
       {"Eigen"}},
      {"robot/check",
       {"spheretree", "spheretree/text", "collide", "collide/kernels", "robot/model", "robot/files",
        "robot/pairs", "robot/cover"},
       {"Eigen"}},

      {"adapters/fcl", {"spheretree", "mesh", "simplifier", "collide"}, {"Eigen", "fcl", "ccd"}},
      {"adapters/ompl", joined({{"spheretree", "collide"}, kRobot}), {"Eigen", "ompl"}},

      {"cli/text", kCli, {"Eigen", "nlohmann"}},
      {"cli/help", {"spheretree", "spheretree/text"}, {"CLI"}},
      {"cli/options", joined({kCli, {"cli/text", "cli/help"}}), {"CLI"}},
      {"cli/files",
       joined({kCli, {"cli/text", "cli/help", "cli/options", "cli/cad"}}),
       {"Eigen", "CLI", "nlohmann"}},
      {"cli/robots",
       joined({kCli, {"cli/text", "cli/help", "cli/options", "cli/files"}}),
       {"Eigen", "CLI", "nlohmann"}},
      {"cli/pages",
       joined({kCli, {"cli/text", "cli/options", "cli/files", "cli/robots"}}),
       {"Eigen", "nlohmann"}},
      {"cli/parts",
       joined({kCli,
               {"cli/text", "cli/help", "cli/options", "cli/files", "cli/pages", "cli/modules"}}),
       {"Eigen", "CLI", "nlohmann"}},
      {"cli/modules", kPublic, {"Eigen"}},
      {"cli/cad", joined({kCli, {"cli/modules"}}), {"Eigen", "nlohmann"}},
      {"cli",
       joined({kCli,
               {"cli/text", "cli/help", "cli/options", "cli/files", "cli/robots", "cli/pages",
                "cli/parts"}}),
       {"Eigen", "CLI", "nlohmann"}},
      {"python", kPublic, {"Eigen", "pybind11"}},
      {"bench", kAll, {"Eigen", "benchmark", "fcl", "ccd", "bullet", "nlohmann", "ompl"}},
      {"tests",
       joined({kAll, {"cli/cad"}}),
       {"Eigen", "gtest", "gmock", "fcl", "ccd", "boost", "gmp", "kdl", "nlohmann", "ompl", "tbb",
        "tinyxml2", "urdfdom", "zlib", "opencascade", "assimp"}},
      // Users of the installed package: they see the library from outside.
      {"tests/consumer", {}, {"Eigen", "fcl", "spherule"}},
      {"examples", {}, {"spherule", "mpi", "ompl", "Eigen"}},
  };
  return kRooms;
}

namespace {

bool holds(std::string_view folder, std::string_view path) {
  return path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

}  // namespace

bool may_include(const Room* from, const Room* to) {
  if (!from || !to) return false;
  return from == to ||
         std::find(from->rooms.begin(), from->rooms.end(), to->folder) != from->rooms.end();
}

const Room* room_of(std::string_view path) {
  const Room* best = nullptr;
  for (const Room& room : rooms()) {
    if (holds(room.folder, path) && (!best || room.folder.size() > best->folder.size())) {
      best = &room;
    }
  }
  return best;
}

std::string_view library_of(std::string_view path) {
  std::string_view best;
  for (const std::string_view folder : kLibraryFolders) {
    if (holds(folder, path) && folder.size() > best.size()) best = folder;
  }
  return best;
}

}  // namespace spherule
