// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"

#include "base/error.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public TemporaryFolder {};

TEST_F(AtomicFile, WritesExactlyTheBytes) {
  for (const std::string& bytes :
       {std::string(), std::string("a\r\n\0b", 5), std::string(1000000, 'x')}) {
    write_file_atomically(path("file"), bytes);
    EXPECT_EQ(bytes_of(path("file")), bytes);
    EXPECT_EQ(read_file(path("file")), bytes);
    EXPECT_EQ(files_in_folder(), 1U);
  }
}

TEST_F(AtomicFile, NewFilesGetTheUsualPermissionsAndOldOnesKeepTheirs) {
  const mode_t mask = ::umask(027);
  write_file_atomically(path("new"), "x");
  ::umask(mask);
  EXPECT_EQ(static_cast<int>(fs::status(path("new")).permissions()), 0640);
  fs::permissions(path("new"), fs::perms::owner_read | fs::perms::owner_write);
  write_file_atomically(path("new"), "y");
  EXPECT_EQ(static_cast<int>(fs::status(path("new")).permissions()), 0600);
}

TEST_F(AtomicFile, FollowsSymbolicLinksWhetherOrNotTheFileIsThere) {
  fs::create_directory(path("folder"));
  fs::create_symlink("folder/second", path("first"));
  fs::create_symlink("../target", path("folder/second"));
  write_file_atomically(path("first"), "new");
  EXPECT_TRUE(fs::is_symlink(path("first")));
  EXPECT_TRUE(fs::is_symlink(path("folder/second")));
  EXPECT_FALSE(fs::is_symlink(path("target")));
  EXPECT_EQ(bytes_of(path("target")), "new");
  write_file_atomically(path("first"), "newer");
  EXPECT_TRUE(fs::is_symlink(path("first")));
  EXPECT_EQ(bytes_of(path("target")), "newer");
}

TEST_F(AtomicFile, RefusesLinksThatLeadNowhere) {
  fs::create_symlink("missing/file", path("link"));
  fs::create_symlink("other", path("one"));
  fs::create_symlink("one", path("other"));
  for (const fs::path& bad : {path("link"), path("one")}) {
    const std::string error = error_of([&] { write_file_atomically(bad, "x"); });
    EXPECT_TRUE(error.starts_with(bad.string() + ": ")) << error;
    EXPECT_TRUE(fs::is_symlink(bad));
  }
  EXPECT_EQ(files_in_folder(), 3U);
}

TEST_F(AtomicFile, AFailureLeavesNothingBehindAndTheOldFileAsItWas) {
  fs::create_directory(path("folder"));
  for (const fs::path& bad : {path("folder"), path("missing/file"), path("folder/"), fs::path(),
                              path(std::string(256, 'n'))}) {
    const std::string error = error_of([&] { write_file_atomically(bad, "x"); });
    EXPECT_TRUE(error.starts_with(bad.string() + ": ")) << error;
    EXPECT_FALSE(error.empty());
    EXPECT_EQ(error_of([&] { check_writable(bad); }), error);
  }
  EXPECT_EQ(files_in_folder(), 1U);
  EXPECT_TRUE(fs::is_empty(path("folder")));
  // A device is not replaced by a file.
  EXPECT_NE(error_of([] { write_file_atomically("/dev/null", "x"); }), "");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFile, WhatKilledProcessesLeftIsRemovedAndNothingElse) {
  const std::string longest(255, 'n');
  for (const std::string& name : {std::string("file"), longest}) {
    const std::string start = "." + name.substr(0, 238) + ".spherule-";
    for (const char* end : {"abcdef", "locked", "short"}) std::ofstream(path(start + end));
    std::ofstream(path("." + name.substr(0, 238) + ".backup"));
    fs::create_directory(path(start + "folder"));
    const int used = ::open(path(start + "locked").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(used, LOCK_EX), 0);
    check_writable(path(name));
    EXPECT_FALSE(fs::exists(path(name)));
    EXPECT_FALSE(fs::exists(path(start + "abcdef")));
    EXPECT_EQ(files_in_folder(), 4U);
    ::close(used);
    write_file_atomically(path(name), "x");
    EXPECT_EQ(bytes_of(path(name)), "x");
    EXPECT_FALSE(fs::exists(path(start + "locked")));
    EXPECT_EQ(files_in_folder(), 4U);
    for (const fs::directory_entry& entry : fs::directory_iterator(path("."))) {
      fs::remove_all(entry.path());
    }
  }
}

// The temporary file of one that is still writing is not a leftover for another.
TEST_F(AtomicFile, ThoseWhoWriteTheSameFileAtOnceAllSucceed) {
  constexpr int kWriters = 8;
  const mode_t mask = ::umask(027);
  std::atomic<int> failed = 0;
  std::vector<std::thread> writers;
  for (int i = 0; i < kWriters; ++i) {
    writers.emplace_back([&, i] {
      for (int n = 0; n < 25; ++n) {
        try {
          write_file_atomically(path("file"), std::string(100, static_cast<char>('a' + i)));
        } catch (const Error&) {
          ++failed;
        }
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(::umask(mask), 027U);
  EXPECT_EQ(static_cast<int>(fs::status(path("file")).permissions()), 0640);
  EXPECT_EQ(failed, 0);
  const std::string bytes = bytes_of(path("file"));
  EXPECT_EQ(bytes, std::string(100, bytes.front()));
  EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, AFullDiskIsReportedAndTheOldFileStays) {
  write_file_atomically(path("file"), "old");
  // A limit on the size of files stands for the full disk; it must not end the program.
  struct rlimit limit = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = limit;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error =
      error_of([&] { write_file_atomically(path("file"), std::string(100000, 'x')); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  ::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("cannot be written"), std::string::npos) << error;
  EXPECT_EQ(bytes_of(path("file")), "old");
  EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, ReadRefusesWhatIsNoFile) {
  for (const fs::path& bad : {path(""), path("missing"), fs::path("/dev/zero")}) {
    const std::string error = error_of([&] { read_file(bad); });
    EXPECT_TRUE(error.starts_with(bad.string() + ": ")) << error;
  }
}

TEST_F(AtomicFile, OnlyRegularFilesAreForNamesInFiles) {
  write_file_atomically(path("file"), "old");
  fs::create_symlink("file", path("link"));
  fs::create_symlink("pipe", path("link to pipe"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const fs::path& good : {path("file"), path("link"), path("missing")}) {
    EXPECT_NO_THROW(require_regular_file(good)) << good;
  }
  for (const fs::path& bad :
       {path("pipe"), path("link to pipe"), path(""), fs::path("/dev/zero")}) {
    EXPECT_EQ(error_of([&] { require_regular_file(bad); }),
              bad.string() + ": is not a regular file");
  }
}

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

// Of one descriptor; standard output is discarded if it is another, standard error is ours.
TEST_F(RunProgram, ReturnsEveryByteOfTheDescriptor) {
  const std::string bytes = random_bytes(1);
  const std::string file = folder_.write("bytes", bytes).string();
  for (const int descriptor : {STDOUT_FILENO, 3, 7}) {
    const bool is_other = descriptor != STDOUT_FILENO;
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const ProgramOutput output =
        run_shell("echo of the program >&2; " + std::string(is_other ? "echo discarded; " : "") +
                      "cat \"$1\" >&" + std::to_string(descriptor),
                  descriptor, {file});
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "of the program\n");
    EXPECT_TRUE(output.bytes == bytes) << output.bytes.size();
    EXPECT_EQ(output.status, 0);
    EXPECT_EQ(output.not_started, "");
  }
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

TEST_F(RunProgram, ThrowsWhereNobodyKnowsHowItEnded) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_THROW(run_shell("echo answer"), Error);
  std::signal(SIGCHLD, before);
}

}  // namespace
}  // namespace spherule::test
