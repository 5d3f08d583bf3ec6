// SPDX-License-Identifier: BSD-3-Clause
// The code of a guide is that of an example, which the tests of consumers build and run.
#include "tests/structure/repository.h"

#include <gtest/gtest.h>

#include <string>

namespace spherule {
namespace {

TEST(Guide, ItsCodeIsThatOfTheExample) {
  const std::string guide = text_of(kRoot / "docs/cpp_robot.md");
  const std::string example = text_of(kRoot / "examples/check_motion/main.cpp");
  const std::string begin = "```cpp\n";
  const std::size_t first = guide.find(begin);
  ASSERT_NE(first, std::string::npos);
  const std::size_t start = first + begin.size();
  const std::string code = guide.substr(start, guide.find("```", start) - start);
  EXPECT_EQ(code, example.substr(example.find("#include")));
}

}  // namespace
}  // namespace spherule
