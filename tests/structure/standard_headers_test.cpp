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
  std::size_t files = 0;
  for (const std::string& file : files_of_sources(kRoot)) {
    if (!is_cpp(file)) continue;
    ++files;
    for (const std::string& what : missing_standard_headers(kRoot, file)) {
      ADD_FAILURE() << file << ": " << what;
    }
  }
  EXPECT_GT(files, 800u);
}

TEST(StandardHeaders, ThatAreMissingAreFound) {
  const test::TempDir folder;
  folder.write(
      "own.h",
      "#include <vector>\n// #include <cstddef>\nstd::vector<std::size_t> own();  // std::map\n");
  folder.write("own.cpp",
               "#include \"own.h\"\n#include <cstddef>\nstd::vector<std::size_t> own() {}\n");
  EXPECT_EQ(missing_standard_headers(folder.path(), "own.cpp").size(), 0u);
  EXPECT_EQ(missing_standard_headers(folder.path(), "own.h"),
            std::vector<std::string>{"std::size_t needs <cstddef>"});
  folder.write("eigen.cpp", "Eigen::Vector3d v;\nconst char* text = \"std::set\";\n");
  EXPECT_EQ(missing_standard_headers(folder.path(), "eigen.cpp").size(), 1u);
  folder.write("others.cpp", "#include <tbb/task_arena.h>\ntbb::task_arena a;\nYAML::Node node;\n");
  EXPECT_EQ(missing_standard_headers(folder.path(), "others.cpp"),
            std::vector<std::string>{"YAML:: needs <yaml-cpp/...>"});
}

}  // namespace
}  // namespace spherule
