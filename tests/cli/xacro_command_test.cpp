// SPDX-License-Identifier: BSD-3-Clause
// Commands on a robot whose URDF the program xacro makes: a stand-in for it on the PATH.
#include "tests/cli/command_test_support.h"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace spherule {
namespace {

namespace fs = std::filesystem;

class XacroCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    path_ = std::getenv("PATH");
    write("xacro", "#!/bin/sh\nsed -n 's/^made: //p' \"$1\"\n");
    fs::permissions(folder_ / "xacro", fs::perms::owner_all);
    ::setenv("PATH", (folder_.string() + ":" + path_).c_str(), 1);
    // All its links are in what xacro makes.
    write("arm.urdf.xacro",
          "<robot name=\"raw\"><xacro:arm/>\n"
          "made: <robot name=\"arm\"><link name=\"base\"><collision><geometry>"
          "<box size=\"1 1 1\"/></geometry></collision></link></robot>\n</robot>\n");
  }
  void TearDown() override {
    ::setenv("PATH", path_.c_str(), 1);
    CommandTest::TearDown();
  }

 private:
  std::string path_;
};

TEST_F(XacroCommand, TakesItAsTheUrdf) {
  const Outcome robot = run({"robot", "arm.urdf.xacro", "--max-error", "0.2", "--effort", "0"});
  EXPECT_EQ(robot.exit_code, 0) << robot.err;
  const std::string urdf = read("arm-spheres/arm.spheres.urdf");
  EXPECT_NE(urdf.find("<sphere radius"), std::string::npos) << urdf;
  EXPECT_EQ(urdf.find("xacro"), std::string::npos) << urdf;
  const Outcome info = run({"info", "arm.urdf.xacro"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("arm"), std::string::npos) << info.out;
  EXPECT_EQ(
      run({"view", "arm.urdf.xacro", "arm-spheres/arm.spheres.json", "-o", "arm.html"}).exit_code,
      0);
  EXPECT_EQ(run({"audit-robot", "arm.urdf.xacro", "arm-spheres/arm.spheres.urdf"}).exit_code, 0);
}

}  // namespace
}  // namespace spherule
