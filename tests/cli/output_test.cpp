// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <chrono>
#include <signal.h>
#include <sys/resource.h>
#include <thread>

namespace spherule {
namespace {

class OutputTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {40, 20, 10});
  }
};

using Files = std::vector<std::string>;

TEST_F(OutputTest, FailureLeavesTheOlderFile) {
  write("out.json", "precious");
  write("bad.stl", "solid bad\nfacet normal 0 0 0\nouter loop\nvertex 0 0 nan\n");
  expect_refusal({"fit", "bad.stl", "-o", "out.json"}, "bad.stl: ");
  expect_refusal({"fit", "missing.stl", "-o", "out.json"}, "missing.stl: ");
  expect_refusal({"tree", "missing.json", "-o", "out.json"}, "missing.json: ");
  expect_refusal({"view", "missing.json", "-o", "out.json"}, "missing.json: ");
  EXPECT_EQ(read("out.json"), "precious");
  EXPECT_EQ(files(), (Files{"bad.stl", "box.stl", "out.json"}));
}

TEST_F(OutputTest, PlacesAreCheckedBeforeTheWork) {
  // Fine enough to take minutes, were it begun.
  const Files fit = {"fit", "box.stl", "--max-error", "0.01"};
  const auto with = [&](const Files& more) {
    Files all = fit;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_refusal(with({"-o", "nowhere/out.json"}), "nowhere/out.json: no such folder");
  expect_refusal(with({"-o", "out.json", "--report", "nowhere/r.json"}), "nowhere/r.json: ");
  expect_refusal(with({"-o", "box.stl"}), "box.stl: is named twice");
  expect_refusal(with({"-o", "out.json", "--tree", "./out.json"}), "out.json: is named twice");
  std::filesystem::create_symlink("link.json", folder_ / "link.tree");  // to what is not there yet
  expect_refusal(with({"-o", "link.json", "--tree", "link.tree"}), "link.tree: is named twice");
  std::filesystem::remove(folder_ / "link.tree");
  expect_refusal(with({"-o", "."}), "is a folder");
  expect_refusal(with({"-o", "/dev/full"}), "/dev/full: exists and is not a regular file");
  expect_refusal(with({"-o", std::string(256, 'n')}), "the name is too long");
  EXPECT_EQ(files(), Files{"box.stl"});
}

// While it lives, this process and those that it starts have a limit of `amount`.
class Limited {
 public:
  Limited(int resource, rlim_t amount) : resource_(resource) {
    EXPECT_EQ(::getrlimit(kind(), &old_), 0);
    struct rlimit limit = old_;
    limit.rlim_cur = amount;
    EXPECT_EQ(::setrlimit(kind(), &limit), 0);
  }
  Limited(const Limited&) = delete;
  Limited& operator=(const Limited&) = delete;
  ~Limited() { EXPECT_EQ(::setrlimit(kind(), &old_), 0); }

 private:
  __rlimit_resource kind() const { return static_cast<__rlimit_resource>(resource_); }

  int resource_;
  struct rlimit old_ = {};
};

TEST_F(OutputTest, ALimitOfFileSizesIsAnError) {
  write("out.tree", "precious");
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 2000; ++i) many.push_back({1.0 * i, 0.0, 0.0, 1.0});
  write_spheres("many.json", many);
  {
    const Limited file_size(RLIMIT_FSIZE, 4096);
    expect_refusal({"tree", "many.json", "-o", "out.tree"}, "out.tree: cannot be written: ");
  }
  EXPECT_EQ(read("out.tree"), "precious");
  EXPECT_EQ(files(), (Files{"box.stl", "many.json", "out.tree"}));
}

// At whatever allocation the memory ends, also among those that destructors make.
TEST_F(OutputTest, RunningOutOfMemoryIsAnError) {
  if (test::kSanitized) GTEST_SKIP() << "the address sanitizer needs all of the address space";
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 20000; ++i) many.push_back({1.0 * i, 0.0, 0.0, 1.0});
  write_spheres("many.json", many);
  constexpr rlim_t kMegabyte = 1U << 20U;
  // Libraries that are loaded do not always say what they lack.
  rlim_t megabytes = 8;
  for (;; ++megabytes) {
    const Limited memory(RLIMIT_AS, megabytes * kMegabyte);
    if (run({"--version"}).exit_code == 0) break;
  }
  int refused = 0;
  for (bool done = false; !done; ++megabytes) {
    write("out.tree", "precious");
    const Limited memory(RLIMIT_AS, megabytes * kMegabyte);
    const Outcome outcome = run({"tree", "many.json", "-o", "out.tree"});
    done = outcome.exit_code == 0;
    if (done) break;
    ++refused;
    ASSERT_EQ(outcome.exit_code, 2) << megabytes << " MB: " << outcome.err;
    EXPECT_EQ(outcome.err, "spherule: out of memory\n");
    EXPECT_EQ(read("out.tree"), "precious");
  }
  EXPECT_GT(refused, 2);
  EXPECT_EQ(files(), (Files{"box.stl", "many.json", "out.tree"}));
}

TEST_F(OutputTest, SuccessReplacesTheOlderFileAndLeavesNothingBeside) {
  write("out.json", "old");
  ASSERT_EQ(run({"fit", "box.stl", "-o", "out.json", "--max-error", "12"}).exit_code, 0);
  EXPECT_EQ(read_json("out.json").at("format"), "spherule-spheres");
  EXPECT_FALSE(read_json("out.json").contains("interrupted"));
  EXPECT_EQ(files(), (Files{"box.stl", "out.json"}));
}

TEST_F(OutputTest, InterruptionLeavesNoHalfWrittenFile) {
  write("out.json", "precious");
  for (const int milliseconds : {1, 20, 300}) {
    const pid_t process = start(
        {"fit", "box.stl", "-o", "out.json", "--max-error", "0.02", "--report", "report.json"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
    EXPECT_EQ(finish(process).exit_code, -SIGINT);
    EXPECT_EQ(read("out.json"), "precious");
    EXPECT_EQ(files(), (Files{"box.stl", "out.json"}));
  }
}

// Once there is a proved answer, an interruption of the search for a better one does not lose it.
TEST_F(OutputTest, InterruptedSearchWritesWhatIsProved) {
  for (int milliseconds = 500;; milliseconds *= 2) {
    ASSERT_LT(milliseconds, 100000);
    const pid_t process = start({"fit", "box.stl", "-o", "out.json", "--max-error", "2", "--effort",
                                 "1000000", "--tree", "out.tree", "--report", "report.json"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
    const Outcome outcome = finish(process);
    ASSERT_EQ(outcome.exit_code, -SIGINT) << outcome.out << outcome.err;
    if (!exists("out.json")) continue;  // there was no answer yet
    EXPECT_NE(outcome.err.find("spherule: interrupted: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("(proved)"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\ninterrupted: the search"), std::string::npos) << outcome.out;
    break;
  }
  EXPECT_EQ(files(), (Files{"box.stl", "out.json", "out.tree", "report.json"}));
  EXPECT_EQ(run({"audit", "box.stl", "out.json"}).exit_code, 0);
  // Who finds the files later is told.
  EXPECT_EQ(read_json("out.json").at("interrupted"), true);
  EXPECT_EQ(read_json("report.json").at("interrupted"), true);
  for (const char* file : {"out.json", "report.json"}) {
    const std::string told = run({"info", file}).out;
    EXPECT_NE(told.find("\ninterrupted: the search"), std::string::npos) << told;
  }
}

// As a shell has programs in the background ignore it.
TEST_F(OutputTest, WhatTheParentIgnoresStaysIgnored) {
  const auto before = ::signal(SIGINT, SIG_IGN);
  const pid_t process =
      start({"fit", "box.stl", "-o", "out.json", "--max-error", "2", "--seconds", "2"});
  ::signal(SIGINT, before);
  for (int i = 0; i < 15; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    kill(process, SIGINT);
  }
  const Outcome outcome = finish(process);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
}

// Interrupted at any moment, a command that writes leaves the old file, or the new one whole.
TEST_F(OutputTest, InterruptionWhileWriting) {
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 4000; ++i) many.push_back({1.0 * i, 0.5 * (i % 7), 0.0, 1.0});
  write_spheres("many.json", many);
  ASSERT_EQ(run({"tree", "many.json", "-o", "out.tree"}).exit_code, 0);
  const std::string whole = read("out.tree");
  for (int delay = 0; delay < 60; ++delay) {
    write("out.tree", "old");
    const pid_t process = start({"tree", "many.json", "-o", "out.tree"});
    std::this_thread::sleep_for(std::chrono::microseconds(1000 * delay));
    kill(process, SIGINT);
    finish(process);
    const std::string left = read("out.tree");
    EXPECT_TRUE(left == "old" || left == whole) << "after " << delay << " ms";
    EXPECT_EQ(files(), (Files{"box.stl", "many.json", "out.tree"}));
  }
}

}  // namespace
}  // namespace spherule
