// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "robot/files/urdf.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>

// Names of mesh files in a URDF, and the files they mean.

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

// Robots whose URDF the program xacro makes: a stand-in for it on the PATH.

namespace spherule::test::xacro_test {
namespace {

namespace fs = std::filesystem;

class Xacro : public ::testing::Test {
 protected:
  void SetUp() override { path_ = std::getenv("PATH"); }
  void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }

  // Writes this as the program xacro, which is found before any other.
  void install(const std::string& script) {
    fs::create_directory(folder_.path() / "bin");
    const fs::path program = folder_.write("bin/xacro", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":" + path_).c_str(), 1);
  }
  void expect_refusal(const fs::path& file, const std::string& reason) {
    try {
      read_urdf(file);
      ADD_FAILURE() << "accepted: " << reason;
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), file.string());
      EXPECT_NE(error.reason().find(reason), std::string::npos) << error.reason();
    }
  }

  TempDir folder_;

 private:
  std::string path_;
};

// The script writes what follows the first line of the file it is given.
TEST_F(Xacro, WhatItMakesIsRead) {
  install("tail -n +2 \"$1\"\n");
  const std::string urdf =
      "<robot name='r'><link name='a'><visual><geometry><mesh filename='a.stl'/></geometry>"
      "</visual></link></robot>\n";
  const fs::path file = folder_.write("arm.urdf.xacro", "a line for the script\n" + urdf);
  folder_.write("a.stl", "");
  const RobotDescription robot = read_urdf(file);
  EXPECT_EQ(robot.name, "r");
  // A path from the folder of the file that was named.
  ASSERT_EQ(robot.links.at(0).visual.size(), 1U);
  EXPECT_EQ(read_urdf(fs::relative(file)).name, "r");
}

TEST_F(Xacro, WhatFailsNamesTheFile) {
  const fs::path file = folder_.write("arm.urdf.xacro", "<robot name='r'/>");
  install("exit 3\n");
  expect_refusal(file, "xacro makes no URDF of it (exit code 3)");
  install("kill -TERM $$\n");
  expect_refusal(file, "xacro was ended by a signal");
  install("true\n");
  expect_refusal(file, "not XML");
  ::setenv("PATH", folder_.path().c_str(), 1);
  expect_refusal(file,
                 "needs the program xacro, which makes a URDF of it and cannot be run: No such");
}

}  // namespace
}  // namespace spherule::test::xacro_test
