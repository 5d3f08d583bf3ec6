// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/point_cloud_file.h"

#include "spheretree/error.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

class PointCloudFileTest : public testing::Test {
 protected:
  PointCloudFile read(const std::string& name, std::string_view bytes, double scale = 1.0) const {
    return read_point_cloud(folder_.write(name, bytes), scale);
  }
  std::string fault(const std::string& name, std::string_view bytes, double scale = 1.0) const {
    try {
      read(name, bytes, scale);
    } catch (const Error& error) {
      return error.reason();
    }
    return "none";
  }

  const TempDir folder_;
};

template <class Value>
void append(std::string& bytes, Value value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian == (std::endian::native == std::endian::little))
    std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

const std::vector<Vector3d> kPoints = {{1.0, 2.0, 3.0}, {-0.5, 0.25, 1e6}};

TEST_F(PointCloudFileTest, Text) {
  const PointCloudFile cloud = read("scan.XYZ", "# x y z\n1 2 3 255 0 0\n-0.5,0.25,1e6\n");
  EXPECT_EQ(cloud.points, kPoints);
  EXPECT_GE(cloud.point_error, 1e6 * 0x1p-53);
  EXPECT_LE(cloud.point_error, 1e6 * 0x1p-50);
}

TEST_F(PointCloudFileTest, ScalesAndSaysWhatThatCosts) {
  const PointCloudFile cloud = read("scan.txt", "1 2 3\n", 0.001);
  EXPECT_EQ(cloud.points[0], Vector3d(1.0, 2.0, 3.0) * 0.001);
  EXPECT_GE(cloud.point_error, 0.003 * 0x1p-52);
}

TEST_F(PointCloudFileTest, PlyInText) {
  EXPECT_EQ(
      read("a.ply",
           "ply\r\nformat ascii 1.0\ncomment made by hand\nelement camera 1\nproperty float f\n"
           "element vertex 2\nproperty list uchar int seen\nproperty uchar red\n"
           "property double z\nproperty float y\nproperty float x\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "7\n2 5 6 255 3 2 1\n0 0 1e6 0.25 -0.5\n3 0 1 0\n")
          .points,
      kPoints);
}

TEST_F(PointCloudFileTest, PlyInBytes) {
  for (const bool big_endian : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\nelement pose 1\nproperty list uint8 short numbers\n"
                        "element vertex 2\nproperty double x\nproperty float y\nproperty ushort i\n"
                        "property float z\nend_header\n";
    append(bytes, std::uint8_t{2}, big_endian);
    append(bytes, std::int16_t{-3}, big_endian);
    append(bytes, std::int16_t{7}, big_endian);
    for (const Vector3d& point : kPoints) {
      append(bytes, point.x(), big_endian);
      append(bytes, static_cast<float>(point.y()), big_endian);
      append(bytes, std::uint16_t{9}, big_endian);
      append(bytes, static_cast<float>(point.z()), big_endian);
    }
    const PointCloudFile cloud = read("a.ply", bytes);
    EXPECT_EQ(cloud.points, kPoints);
    EXPECT_EQ(cloud.point_error, 0.0);
    // However it is cut short, it is refused.
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_NE(fault("a.ply", bytes.substr(0, length)), "none") << length;
    }
  }
}

TEST_F(PointCloudFileTest, Refuses) {
  EXPECT_EQ(fault("a.xyz", "# nothing\n"), "it has no points");
  EXPECT_EQ(fault("a.xyz", "1 2 3\n\n1 2\n"), "line 3: has no x, y and z");
  EXPECT_EQ(fault("a.xyz", "1 2 nan\n"), "line 1: \"nan\" is not a finite number");
  EXPECT_EQ(fault("a.xyz", "1 2 3\n1 2e15 3\n"), "point 1 is beyond 1e15 or not finite");
  EXPECT_NE(fault("a.stl", "1 2 3\n"), "none");
  EXPECT_NE(fault("a.xyz", "1 2 3\n", 0.0), "none");
  EXPECT_NE(fault("a.xyz", "1 2 3\n", std::nan("")), "none");
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  const std::string axes = "property float x\nproperty float y\n";
  EXPECT_EQ(fault("a.ply", head + axes + "end_header\n1 2\n"), "its vertices have no z");
  EXPECT_EQ(fault("a.ply", head + "end_header\n"), "its element vertex has no properties");
  EXPECT_EQ(fault("a.ply", head + axes + "property list uchar float z\nend_header\n1 2 1 3\n"),
            "its vertices have no z");
  EXPECT_EQ(fault("a.ply", head + axes + "property float z\nend_header\n1 2\n"),
            "vertex 0 has too few numbers");
  EXPECT_EQ(fault("a.ply", head + axes + "property float z\nend_header\n1 2 x\n"),
            "line 8: \"x\" is not a finite number");
  EXPECT_EQ(fault("a.ply", head + "property quad x\nend_header\n"),
            "line 4: is no line of a PLY header");
  EXPECT_EQ(fault("a.ply", "ply\nelement face 0\nproperty int x\nend_header\n"),
            "its header has no format");
  EXPECT_EQ(fault("a.ply", "ply\nformat ascii 1.0\nelement face 0\nproperty int x\nend_header\n"),
            "it has no vertices");
  EXPECT_EQ(fault("a.ply", "plx\n"), "it does not begin with \"ply\"");
  EXPECT_THROW(read_point_cloud(folder_.path() / "none.ply"), Error);
}

}  // namespace
}  // namespace spherule::test
