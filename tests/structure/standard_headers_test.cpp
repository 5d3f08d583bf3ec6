// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/standard_headers.h"

#include "tests/structure/repository.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace spherule {
namespace {

TEST(StandardHeaders, AreIncludedByTheSourcesThatUseTheirNames) {
  const Sources sources = all_sources(kRoot);
  EXPECT_GT(sources.size(), 800u);
  for (const auto& [file, source] : sources) {
    for (const std::string& what : missing_standard_headers(sources, file)) {
      ADD_FAILURE() << file << ": " << what;
    }
  }
}

TEST(StandardHeaders, ThatAreMissingAreFound) {
  const test::TempDir folder;
  folder.write(
      "own.h",
      "#include <vector>\n// #include <cstddef>\nstd::vector<std::size_t> own();  // std::map\n");
  folder.write("own.cpp",
               "#include \"own.h\"\n#include <cstddef>\nstd::vector<std::size_t> own() {}\n");
  folder.write("eigen.cpp", "Eigen::Vector3d v;\nconst char* text = \"std::set\";\n");
  folder.write("others.cpp", "#include <tbb/task_arena.h>\ntbb::task_arena a;\nYAML::Node node;\n");
  const Sources sources =
      read_sources(folder.path(), {"own.h", "own.cpp", "eigen.cpp", "others.cpp"});
  EXPECT_EQ(missing_standard_headers(sources, "own.cpp").size(), 0u);
  EXPECT_EQ(missing_standard_headers(sources, "own.h"),
            std::vector<std::string>{"std::size_t needs <cstddef>"});
  EXPECT_EQ(missing_standard_headers(sources, "eigen.cpp").size(), 1u);
  EXPECT_EQ(missing_standard_headers(sources, "others.cpp"),
            std::vector<std::string>{"YAML:: needs <yaml-cpp/...>"});
}

}  // namespace
}  // namespace spherule
