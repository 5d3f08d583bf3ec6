// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/own_headers.h"

#include "tests/structure/repository.h"
#include "tests/structure/source_names.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

TEST(OwnHeaders, AreIncludedByTheSourcesThatUseTheirNames) {
  const Sources sources = all_sources(kRoot);
  EXPECT_GT(sources.size(), 800u);
  for (const std::string& what : missing_own_headers(sources)) ADD_FAILURE() << what;
}

TEST(OwnHeaders, ThatAreMissingAreFound) {
  const test::TempDir folder;
  for (const char* room : {"spheretree", "mesh", "collide"}) {
    fs::create_directory(folder.path() / room);
  }
  folder.write("spheretree/ball.h",
               "struct Ball {\n  int size;\n};\nconstexpr int kLargest = 3;\nclass Known;\n"
               "Ball made(\n    int size);\n");
  folder.write("spheretree/near.h",
               "#include \"spheretree/ball.h\"\nint near(const Ball& ball);\n");
  folder.write("collide/part.h", "struct Part {};\n");
  folder.write("mesh/good.cpp",
               "#include \"spheretree/near.h\"\nint all() { return near(made(kLargest)); }\n");
  folder.write(
      "mesh/bad.cpp",
      "// near\nint all() {\n  const Ball& ball = made(2);\n  return near(ball) + kLargest;\n}\n"
      "Known* known(Part* part);\n");
  const std::vector<std::string> files = {"spheretree/ball.h", "spheretree/near.h",
                                          "collide/part.h", "mesh/good.cpp", "mesh/bad.cpp"};
  EXPECT_EQ(missing_own_headers(read_sources(folder.path(), files)),
            (std::vector<std::string>{"mesh/bad.cpp: Ball needs spheretree/ball.h",
                                      "mesh/bad.cpp: kLargest needs spheretree/ball.h",
                                      "mesh/bad.cpp: made needs spheretree/ball.h",
                                      "mesh/bad.cpp: near needs spheretree/near.h"}));
}

TEST(OwnHeaders, NamesAreDeclaredOrUsed) {
  const SourceNames names = names_in(R"(#define Skipped /* none */
enum class Kind { kNone, kMany };
using other::Request;
template <class T, typename... Parts>
int sum(const Parts&... parts);
int width_of(const Box& box) {
  const auto [low, high] = ends(box);  // Comment
  return box.size * factor(2) + internal::scaled(high) - other::away(low) + "Text"[0];
}
class Named;
class Named::Inner {};
TEST(Suite, Name) { 1'000; '"'; R"x("Raw)x"; }
)");
  using Set = std::set<std::string, std::less<>>;
  EXPECT_EQ(names.offered, Set({"Kind", "kNone", "kMany"}));
  EXPECT_EQ(names.offered_functions, Set({"sum", "width_of"}));
  for (const char* name : {"Box", "ends", "factor", "scaled"}) {
    EXPECT_TRUE(names.used.contains(name)) << name;
    EXPECT_EQ(names.called.contains(name), name != std::string("Box")) << name;
  }
  for (const char* name :
       {"Skipped", "none", "size", "away", "Comment", "Text", "Raw", "Suite", "Inner"}) {
    EXPECT_FALSE(names.used.contains(name) || names.declared.contains(name)) << name;
  }
  EXPECT_EQ(names.of_scope.at("other"), (std::set<std::string>{"Request", "away"}));
  for (const char* name : {"Request", "T", "Parts", "parts", "box", "low", "high", "Named"}) {
    EXPECT_TRUE(names.declared.contains(name)) << name;
  }
}

}  // namespace
}  // namespace spherule
