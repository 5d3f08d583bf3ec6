// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/rules.h"

#include <gtest/gtest.h>

#include <utility>

namespace spherule {
namespace {

const std::string kLicence = "// SPDX-License-Identifier: BSD-3-Clause\n";

// The problems of a file with one include, joined.
std::string verdict(const std::string& path, const std::string& include) {
  std::string text;
  for (const std::string& problem :
       check_file(path, kLicence + "#pragma once\n#include " + include + "\n")) {
    text += problem + "\n";
  }
  return text;
}

TEST(Structure, SourcesKeepTheRules) {
  std::size_t files = 0;
  const auto problems = check_sources(SPHERULE_SOURCE_DIR, files);
  for (const std::string& problem : problems) ADD_FAILURE() << problem;
  EXPECT_GT(files, 80u);  // the scan did look
}

TEST(Structure, ArrowsOfTheTableAreAllowed) {
  for (const auto& [path, include] : std::vector<std::pair<std::string, std::string>>{
           {"spheretree/build.cpp", "\"spheretree/check.h\""},
           {"simplifier/cover.cpp", "\"geometry/sphere.h\""},
           {"collide/collide.cpp", "\"collide/search/packed_tree.h\""},
           {"collide/meshes/mesh_tree.h", "\"geometry/triangle_mesh.h\""},
           {"robot/check/robot_scene.cpp", "\"robot/pairs/proof_scope.h\""},
           {"robot/cover/link_mesh.cpp", "\"io/mesh_io.h\""},
           {"robot/model/kinematics.h", "\"collide/collide.h\""},
           {"robot/model/robot_model.cpp", "\"base/text.h\""},
           {"cli/commands/fit.cpp", "\"robot/model/kinematics.h\""},
           {"tests/bench/scene_test.cpp", "\"bench/scenes/work_cell.h\""},
           {"tests/spheretree/crc64_test.cpp", "\"spheretree/internal/crc64.h\""},
           {"io/sphere_file.cpp", "<nlohmann/json.hpp>"},
           {"io/xml_text.h", "<tinyxml2.h>"},
           {"collide/kernels/kernel_avx2.cpp", "<immintrin.h>"},
           {"collide/collide.h", "<vector>"},
           {"tests/consumer/collide/main.cpp", "<spherule/collide/collide.h>"}}) {
    EXPECT_EQ(verdict(path, include), "");
  }
}

TEST(Structure, WrongArrowsAreFound) {
  for (const auto& [path, include] : std::vector<std::pair<std::string, std::string>>{
           {"spheretree/build.cpp", "\"collide/collide.h\""},
           {"spheretree/build.cpp", "\"simplifier/types/cover.h\""},
           {"simplifier/cover.cpp", "\"collide/collide.h\""},
           {"collide/collide.cpp", "\"simplifier/types/cover.h\""},
           {"collide/collide.cpp", "\"base/text.h\""},
           {"base/text.cpp", "\"geometry/sphere.h\""},
           {"collide/collide.cpp", "\"robot/model/kinematics.h\""},
           {"robot/files/urdf.cpp", "\"adapters/fcl/collide.h\""},
           {"robot/files/urdf.cpp", "\"robot/check/robot_scene.h\""},
           {"robot/files/urdf.cpp", "\"cli/text/json.h\""},
           {"geometry/mesh_distance.cpp", "\"collide/meshes/mesh_tree.h\""},
           {"collide/meshes/mesh_tree.cpp", "\"io/mesh_io.h\""},
           {"simplifier/stage1/flood_grid.cpp", "\"simplifier/stage2/search/cover_search.h\""},
           {"cli/robots/robot_files.cpp", "\"cli/pages/view_page.h\""},
           {"cli/files/output.cpp", "\"cli/parts/fit_options.h\""},
           {"cli/commands/fit.cpp", "\"simplifier/stage1/flood_grid.h\""},
           {"cli/commands/fit.cpp", "\"bench/scenes/work_cell.h\""},
           {"cli/commands/fit.cpp", "\"tests/support/shapes.h\""},
           {"bench/pairs.cpp", "\"tests/support/shapes.h\""},
           {"collide/collide.cpp", "\"spheretree/internal/crc64.h\""},
           {"collide/collide.cpp", "\"collide.h\""},
           {"collide/collide.cpp", "  \"../spheretree/sphere.h\""}}) {
    EXPECT_NE(verdict(path, include), "") << path << " " << include;
  }
}

TEST(Structure, MisplacedThirdPartiesAreFound) {
  for (const auto& [path, include] : std::vector<std::pair<std::string, std::string>>{
           {"spheretree/tree_file.cpp", "<nlohmann/json.hpp>"},
           {"io/sphere_file.h", "<nlohmann/json.hpp>"},
           {"io/mesh_io.h", "<assimp/scene.h>"},
           {"simplifier/cover.cpp", "<assimp/scene.h>"},
           {"collide/collide.cpp", "<tbb/parallel_for.h>"},
           {"collide/collide.cpp", "<fcl/fcl.h>"},
           {"collide/collide.cpp", "<immintrin.h>"},
           {"cli/commands/fit.cpp", "<gtest/gtest.h>"},
           {"tests/cli/fit_test.cpp", "<spherule/collide/collide.h>"},
           {"collide/collide.cpp", "<some_new_library/api.h>"}}) {
    EXPECT_NE(verdict(path, include), "") << path << " " << include;
  }
}

TEST(Structure, HeadersThatAreNeitherPublicNorInternalAreFound) {
  const std::string cmake = "spherule_library(room\n  HEADERS a.h\n    b.h\n  SOURCES c.cpp d.h)\n";
  const auto count = [&](const std::vector<std::string>& headers) {
    return check_public_headers("room", cmake, headers).size();
  };
  EXPECT_EQ(count({"a.h", "b.h", "internal/e.h"}), 0u);
  EXPECT_EQ(count({"a.h", "d.h"}), 1u);
  const std::string more =
      cmake + "if(X)\n  target_sources(room PUBLIC FILE_SET HEADERS FILES d.h)\nendif()";
  EXPECT_EQ(check_public_headers("room", more, {"a.h", "d.h"}).size(), 0u);
  EXPECT_EQ(count({"e.h", "sub/a.h"}), 2u);
  EXPECT_EQ(check_public_headers("room", "spherule_library(room\n  HEADERS internal/a.h SOURCES b)",
                                 {"internal/a.h"})
                .size(),
            1u);
  EXPECT_EQ(check_public_headers("room", "spherule_library(room SOURCES a.cpp)", {}).size(), 1u);
}

TEST(Structure, SourcesThatDoNotIncludeTheirHeaderFirstAreFound) {
  const std::string own = "\n#include \"room/a.h\"\n";
  const std::string other = "\n#include \"room/b.h\"\n";
  EXPECT_TRUE(check_first_include("room/a.cpp", kLicence + own + other).empty());
  EXPECT_FALSE(check_first_include("room/a.cpp", kLicence + other + own).empty());
  EXPECT_FALSE(check_first_include("room/a.cpp", kLicence + "\n#include <a>\n" + own).empty());
  EXPECT_FALSE(check_first_include("room/a.cpp", kLicence).empty());
}

TEST(Structure, FormFaultsAreFound) {
  EXPECT_TRUE(check_file("collide/a.h", kLicence + "#pragma once\n").empty());
  EXPECT_FALSE(check_file("collide/a.h", kLicence).empty());
  EXPECT_FALSE(check_file("collide/a.h", "#pragma once\n").empty());
  EXPECT_FALSE(check_file("collide/a.cpp", "").empty());
  EXPECT_FALSE(check_file("elsewhere/a.cpp", kLicence).empty());
  EXPECT_TRUE(
      check_file("tests/run", "#!/bin/bash\n# SPDX-License-Identifier: BSD-3-Clause\n").empty());
  EXPECT_FALSE(check_file("tests/run", "#!/bin/bash\necho\n").empty());
  EXPECT_FALSE(check_file("cli/text/a.cpp", kLicence + "  Json json;\n").empty());
  EXPECT_TRUE(check_file("cli/text/a.cpp", kLicence + "  Json json = Json::object();\n").empty());
  std::string longest = kLicence;
  for (std::size_t line = 1; line < kMaxLines; ++line) longest += "\n";
  EXPECT_TRUE(check_file("collide/a.cpp", longest).empty());
  EXPECT_FALSE(check_file("collide/a.cpp", longest + "\n").empty());
}

}  // namespace
}  // namespace spherule
