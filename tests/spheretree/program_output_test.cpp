// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "tests/collide/counting_new.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace spherule::test::program_output_test {
namespace {

using internal::ProgramOutput;
using internal::run_program;

// Several times what a pipe holds.
constexpr int kBytes = 300000;

ProgramOutput run_shell(const std::string& script, int descriptor = STDOUT_FILENO,
                        const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"-c", script, "sh"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program("sh", arguments, descriptor);
}

// Every byte occurs, 0 and the end of a line too.
std::string random_bytes(std::uint64_t seed) {
  Random random(seed);
  std::string bytes;
  for (int i = 0; i < kBytes; ++i) bytes.push_back(static_cast<char>(random.index(256)));
  return bytes;
}

class RunProgram : public ::testing::Test {
 protected:
  // No test leaves a process behind, ended or not.
  void TearDown() override {
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }

  TempDir folder_;
};

TEST_F(RunProgram, ReturnsEveryByte) {
  const std::string bytes = random_bytes(1);
  const std::string file = folder_.write("bytes", bytes).string();
  const ProgramOutput output = run_program("cat", std::vector{file}, STDOUT_FILENO);
  EXPECT_TRUE(output.bytes == bytes) << output.bytes.size();
  EXPECT_EQ(output.status, 0);
  EXPECT_EQ(output.not_started, "");
  EXPECT_EQ(run_shell("").bytes, "");
}

TEST_F(RunProgram, OfAnotherDescriptorStandardOutputIsDiscarded) {
  const std::string bytes = random_bytes(2);
  const std::string file = folder_.write("bytes", bytes).string();
  for (const int descriptor : {3, 7}) {
    ::testing::internal::CaptureStdout();
    const ProgramOutput output =
        run_shell("echo discarded; cat \"$1\" >&" + std::to_string(descriptor), descriptor, {file});
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_TRUE(output.bytes == bytes) << output.bytes.size();
  }
}

TEST_F(RunProgram, StandardErrorIsThatOfThisProcess) {
  ::testing::internal::CaptureStderr();
  const ProgramOutput output = run_shell("echo of the program >&2; echo answer");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "of the program\n");
  EXPECT_EQ(output.bytes, "answer\n");
}

TEST_F(RunProgram, ArgumentsArriveAsTheyAre) {
  const std::vector<std::string> arguments = {"a b", "", "'\"$HOME*", "two\nlines"};
  EXPECT_EQ(run_shell("printf '<%s>' \"$@\"", STDOUT_FILENO, arguments).bytes,
            "<a b><><'\"$HOME*><two\nlines>");
}

TEST_F(RunProgram, TellsHowItEnded) {
  const ProgramOutput failed = run_shell("echo so far; exit 3");
  EXPECT_TRUE(WIFEXITED(failed.status));
  EXPECT_EQ(WEXITSTATUS(failed.status), 3);
  EXPECT_EQ(failed.bytes, "so far\n");
  const ProgramOutput killed = run_shell("echo so far; kill -TERM $$");
  EXPECT_TRUE(WIFSIGNALED(killed.status));
  EXPECT_EQ(WTERMSIG(killed.status), SIGTERM);
  EXPECT_EQ(killed.bytes, "so far\n");
}

TEST_F(RunProgram, SaysWhyItCannotBeRun) {
  const auto reason = [](const std::string& program) {
    const ProgramOutput output = run_program(program, {}, STDOUT_FILENO);
    EXPECT_EQ(output.bytes, "");
    return output.not_started;
  };
  EXPECT_EQ(reason("spherule_no_such_program"), std::strerror(ENOENT));
  EXPECT_EQ(reason((folder_.path() / "none").string()), std::strerror(ENOENT));
  EXPECT_EQ(reason(folder_.write("plain", "#!/bin/sh\n").string()), std::strerror(EACCES));
}

// A pipe may then get its number.
TEST_F(RunProgram, WorksWhereStandardOutputIsClosed) {
  const int kept = ::dup(STDOUT_FILENO);
  ASSERT_GE(kept, 0);
  ::close(STDOUT_FILENO);
  const ProgramOutput first = run_shell("echo first");
  const ProgramOutput third = run_shell("echo discarded; echo third >&3", 3);
  ::dup2(kept, STDOUT_FILENO);
  ::close(kept);
  EXPECT_EQ(first.bytes, "first\n");
  EXPECT_EQ(third.bytes, "third\n");
}

TEST_F(RunProgram, EachThreadGetsItsOwnOutput) {
  std::vector<std::string> files;
  std::vector<ProgramOutput> outputs(4);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    files.push_back(folder_.write("of" + std::to_string(i), random_bytes(i)).string());
  }
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      threads.emplace_back(
          [&, i] { outputs[i] = run_program("cat", std::vector{files[i]}, STDOUT_FILENO); });
    }
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_TRUE(outputs[i].bytes == random_bytes(i)) << i;
  }
}

// TearDown() finds no process, neither one that runs nor one that was not waited for.
TEST_F(RunProgram, EndsTheProgramWhereItsOutputFindsNoMemory) {
  const std::vector<std::string> arguments = {"60"};
  most_bytes = 4096;  // the part that is read at once is larger
  EXPECT_THROW(run_program("sleep", arguments, STDOUT_FILENO), std::bad_alloc);
  most_bytes = SIZE_MAX;
}

TEST_F(RunProgram, ThrowsWhereNobodyKnowsHowItEnded) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_THROW(run_shell("echo answer"), Error);
  std::signal(SIGCHLD, before);
}

}  // namespace
}  // namespace spherule::test::program_output_test
