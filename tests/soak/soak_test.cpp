// SPDX-License-Identifier: BSD-3-Clause
// The soak in small: its parts run, are clean, and an interrupted soak comes to the same table.
#include "base/error.h"
#include "base/files.h"
#include "tests/soak/process_cases.h"
#include "tests/soak/soak_plan.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

constexpr SoakSettings kSmall{.seed = 3, .scale = 1e-3};

// Those without processes and threads.
std::vector<SoakQuestion> judged_questions() {
  std::vector<SoakQuestion> questions = soak_questions({});
  std::erase_if(questions, [](const SoakQuestion& question) { return question.part == "threads"; });
  for (SoakQuestion& question : questions) question.of_chunk /= 4;
  return questions;
}

std::string table(const SoakState& state, bool& is_clean) {
  const test::TempDir folder;
  const fs::path file = folder.path() / "table";
  std::FILE* const stream = std::fopen(file.c_str(), "w");
  is_clean = print_table(judged_questions(), state, false, stream);
  std::fclose(stream);
  return read_file(file);
}

TEST(Soak, AnInterruptedSoakComesToTheSameTable) {
  const test::TempDir folder;
  const std::vector<SoakQuestion> questions = judged_questions();
  SoakState whole(folder.path() / "whole", kSmall, false);
  ASSERT_TRUE(run_soak(questions, whole));
  bool is_clean = false;
  const std::string expected = table(whole, is_clean);
  EXPECT_TRUE(is_clean) << expected;
  EXPECT_NE(expected.find("| **poses** | sum | 11"), std::string::npos) << expected;

  // Ends after some chunks, each time in the middle of a line.
  const fs::path file = folder.path() / "interrupted";
  bool is_done = false;
  for (int rounds = 0; !is_done; ++rounds) {
    ASSERT_LT(rounds, 100);
    SoakState state(file, kSmall, rounds > 0);
    const std::size_t before = state.records().size();
    is_done = run_soak(questions, state, 3);
    EXPECT_LE(state.records().size(), before + 3);
    EXPECT_TRUE(is_done || state.records().size() == before + 3);
    std::ofstream(file, std::ios::app) << R"({"answers":12,"ca)";
  }
  const SoakState state(file, kSmall, true);
  EXPECT_EQ(table(state, is_clean), expected);
  EXPECT_THROW(SoakState(file, {.seed = 4, .scale = kSmall.scale}, true), Error);
}

TEST(Soak, FaultsStandInTheTableAndFailIt) {
  const test::TempDir folder;
  SoakState state(folder.path() / "state", kSmall, false);
  SoakReport report;
  Tally& tally = report.add("collides");
  tally.count(Verdict::kFree, true);
  report.add_fault(tally, Fault::kMissed, "poses 1 2");
  SoakRecord record = record_of(report, 1);
  record.question = "pairs of trees";
  state.add(record);
  bool is_clean = true;
  const std::string text = table(state, is_clean);
  EXPECT_FALSE(is_clean);
  EXPECT_NE(text.find("| poses | pairs of trees | 1 | 1 | 1 | 1 | 0 | 0 |"), std::string::npos);
  EXPECT_NE(text.find("FAILED: collides, case 1: poses 1 2"), std::string::npos) << text;
}

const SoakCommand& command(const std::string& name) {
  return *std::ranges::find(soak_commands(), name, &SoakCommand::name);
}

// Their options are those that the command has today.
TEST(Soak, CommandsRun) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  for (const SoakCommand& command : soak_commands()) {
    EXPECT_NO_THROW(CommandFolder(SPHERULE_COMMAND, command)) << command.name;
  }
}

TEST(Soak, KilledCommandsLeaveWholeFiles) {
  const SoakRecord record = check_kills(SPHERULE_COMMAND, command("tree"), 6, 7);
  EXPECT_EQ(record.cases, 6U);
  for (const std::string& fault : record.faults) ADD_FAILURE() << fault;
}

// What is torn, gone or left is found.
TEST(Soak, FilesThatAreNotWholeAreFaults) {
  const CommandFolder folder(SPHERULE_COMMAND, command("tree"));
  const fs::path file = folder.path() / "out" / "bar.tree";
  const std::string bytes = read_file(file);
  EXPECT_TRUE(folder.look().has_new && folder.look().faults.empty());
  folder.put_older_files();
  EXPECT_TRUE(folder.look().has_old && folder.look().faults.empty());
  std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_EQ(folder.look().faults.size(), 1U);
  fs::rename(file, folder.path() / "out" / ".bar.tree.spherule-Ab12Cd");
  EXPECT_TRUE(folder.look().has_temporary && folder.has_temporary());
  EXPECT_EQ(folder.look().faults, std::vector<std::string>{"bar.tree is gone"});
}

// Among these numbers are some where functions that must not throw allocate: of the parser of
// options, and of the standard library (a folder is searched for leftovers). Where a path cannot be
// made canonical for want of memory, it is taken as it is.
TEST(Soak, AnAllocationThatFailsIsToldAndEndsTheCommand) {
  for (const FailingAllocations& failing :
       {FailingAllocations{2290, 10, 4}, FailingAllocations{6500, 4, 50}}) {
    const SoakRecord record =
        check_memory(SPHERULE_COMMAND, SPHERULE_FAILING_NEW, command("tree"), failing);
    EXPECT_EQ(record.cases, failing.runs);
    EXPECT_GE(record.near, failing.runs - failing.runs / 10);
    for (const std::string& fault : record.faults) ADD_FAILURE() << fault;
  }
}

// The last ones lie where the page's JSON is composed and written.
TEST(Soak, EachOfTheLastAllocationsMayFail) {
  const SoakCommand& view = command("view");
  const auto check = [&](const FailingAllocations& failing) {
    return check_memory(SPHERULE_COMMAND, SPHERULE_FAILING_NEW, view, failing);
  };
  constexpr std::uint64_t kStep = 250;
  const SoakRecord coarse = check({kStep, kStep, 1000});
  ASSERT_TRUE(coarse.is_last);
  const std::uint64_t runs = test::effort(kStep, 10);
  const SoakRecord record = check({kStep * coarse.cases, 1, runs});
  EXPECT_TRUE(record.is_last || record.cases == runs);
  const SoakRecord before = check({kStep * coarse.cases - runs, 1, runs});
  EXPECT_EQ(before.cases, runs);
  for (const SoakRecord& part : {coarse, record, before}) {
    for (const std::string& fault : part.faults) ADD_FAILURE() << fault;
  }
}

}  // namespace
}  // namespace spherule
