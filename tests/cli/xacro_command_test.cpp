// SPDX-License-Identifier: BSD-3-Clause
// Commands on a robot whose URDF the program xacro makes: a stand-in for it on the PATH.
#include "tests/cli/command_test_support.h"
#include "tests/support/child_process.h"
#include "tests/support/effort.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

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
          "<box size=\"1 0.01 0.01\"/></geometry></collision></link></robot>\n</robot>\n");
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

// cuRobo cannot read the other.
TEST_F(XacroCommand, TheCuroboFileNamesTheUrdfThatIsWritten) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const std::vector<std::string> cover = {"robot", "arm.urdf.xacro", "--max-error",
                                          "0.2",   "--effort",       "0"};
  const auto run_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line = cover;
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--format", "curobo,urdf"}}) {
    EXPECT_EQ(run_with(more).find("cuRobo"), std::string::npos);
    const std::string file = read("arm-spheres/arm.curobo.yml");
    EXPECT_NE(file.find("urdf_path: arm-spheres/arm.spheres.urdf\n"), std::string::npos) << file;
    EXPECT_NE(file.find("asset_root_path: arm-spheres\n"), std::string::npos) << file;
    EXPECT_TRUE(exists("arm-spheres/arm.spheres.urdf"));
  }
  EXPECT_NE(run_with({"-o", "alone", "--format", "curobo"})
                .find("warning: urdf_path of the cuRobo file is arm.urdf.xacro, which cuRobo "
                      "cannot read"),
            std::string::npos);
  EXPECT_NE(read("alone/arm.curobo.yml").find("urdf_path: arm.urdf.xacro\n"), std::string::npos);
  // A file that is kept names what it named.
  write("mine.yml", read("alone/arm.curobo.yml"));
  EXPECT_EQ(run_with({"-o", "kept", "--format", "curobo", "--curobo", "mine.yml"}).find("cuRobo"),
            std::string::npos);
}

// Some managers of services ignore the ends of their children, which is inherited.
TEST_F(XacroCommand, RunsWhereTheParentIgnoresTheEndsOfChildren) {
  const Outcome outcome = finish(start_process(
      "/usr/bin/env", {"--ignore-signal=CHLD", SPHERULE_COMMAND, "info", "arm.urdf.xacro"},
      {.folder = folder_, .out = ".out", .error = ".err"}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace spherule
