// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle_mesh.h"

#include "base/error.h"
#include "tests/spheretree/temporary_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace spherule::test {
namespace {

TEST(TriangleMesh, ValidateNamesWhatCannotBeUsed) {
  const TriangleMesh good{{{0, 0, 0}, {1, 0, 0}, {1e15, 0, 0}}, {{0, 1, 2}}};
  const auto error = [](const TriangleMesh& mesh) {
    return error_of([&] { validate(mesh, "part"); });
  };
  EXPECT_EQ(error(good), "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  TriangleMesh bad = good;
  bad.triangles.clear();
  EXPECT_TRUE(error(bad).starts_with("part: ")) << error(bad);
  for (const double coordinate : {nan, infinity, 1.1e15}) {
    bad = good;
    bad.vertices[1].y() = coordinate;
    EXPECT_NE(error(bad).find("vertex 1"), std::string::npos) << error(bad);
  }
  for (const int index : {-1, 3}) {
    bad = good;
    bad.triangles.emplace_back(0, index, 1);
    EXPECT_NE(error(bad).find("triangle 1"), std::string::npos) << error(bad);
  }
  for (const double vertex_error : {-1.0, nan, infinity}) {
    bad = good;
    bad.vertex_error = vertex_error;
    EXPECT_NE(error(bad).find("vertex error"), std::string::npos) << error(bad);
  }
}

}  // namespace
}  // namespace spherule::test
