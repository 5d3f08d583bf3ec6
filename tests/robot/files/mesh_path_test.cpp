// SPDX-License-Identifier: BSD-3-Clause
// Names of mesh files in a URDF, and the files they mean.

#include "base/error.h"
#include "robot/files/urdf.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

// As what follows package:// and file:// in ROS, which hands it to a reader of URLs. A path is
// none.
TEST(MeshPaths, FindsFilesWhoseUrlsEscapeCharacters) {
  const TempDir folder;
  fs::create_directories(folder.path() / "the arm");
  folder.write("package.xml", "<package><name>p</name></package>");
  for (const char* name : {"the arm/a b.stl", "c%20d.stl", "c d.stl", "e%2.stl"}) {
    folder.write(name, "");
  }
  const auto find = [&](const std::string& name) {
    const fs::path file = folder.write(
        "robot.urdf", "<robot name='r'><link name='base'><visual><geometry><mesh filename='" +
                          name + "'/></geometry></visual></link></robot>");
    const RobotDescription robot = read_urdf(file);
    const fs::path path = std::get<MeshFile>(robot.links[0].visual[0].geometry).path;
    return fs::relative(path, folder.path()).string();
  };
  EXPECT_EQ(find("package://p/the%20arm/a%20b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("package://p/the arm/%61 b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("file://" + folder.path().string() + "/the%20arm/a%20b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("package://p/c%20d.stl"), "c%20d.stl");
  EXPECT_EQ(find("package://p/e%2.stl"), "e%2.stl");
  for (const char* missing : {"the%20arm/a%20b.stl", "package://p/the%20arm/a%2", "package://p/%",
                              "package://p/c d.stl%00", "package://p/c%2gd.stl"}) {
    EXPECT_THROW(find(missing), Error) << missing;
  }
}

}  // namespace
}  // namespace spherule::test
