// SPDX-License-Identifier: BSD-3-Clause
// Robots whose URDF the program xacro makes: a stand-in for it on the PATH.
#include "base/error.h"
#include "robot/files/urdf.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

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
