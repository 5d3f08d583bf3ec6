// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/cases.h"
#include "tests/soak/process_cases.h"
#include "tests/soak/soak_commands.h"
#include "tests/soak/soak_plan.h"
#include "tests/soak/thread_cases.h"

#include <utility>

namespace spherule {
namespace {

// Every hundredth allocation fails; so many runs are a chunk.
constexpr double kEvery = 100.0;
constexpr std::uint64_t kRuns = 50;

using Check = std::uint64_t (*)(std::uint64_t, std::uint64_t, SoakReport&);

SoakQuestion judged(std::string part, std::string name, std::uint64_t cases, std::uint64_t of_chunk,
                    Check check) {
  return {std::move(part), std::move(name), cases, of_chunk, [check](const SoakChunk& chunk) {
            SoakReport report;
            const std::uint64_t made = check(chunk.cases, chunk.seed, report);
            return record_of(report, made);
          }};
}

SoakQuestion threaded(std::string name, std::uint64_t cases, std::uint64_t of_chunk,
                      SoakRecord (*check)(std::uint64_t, std::uint64_t)) {
  return {"threads", "threads, " + std::move(name), cases, of_chunk,
          [check](const SoakChunk& chunk) { return check(chunk.cases, chunk.seed); }};
}

// The kills and the memory.
void add_command_questions(const SoakPrograms& programs, std::vector<SoakQuestion>& questions) {
  if (programs.command.empty()) return;
  for (const SoakCommand& command : soak_commands()) {
    if (command.part == CommandPart::kMemory) continue;
    questions.push_back({"kills", "kill " + command.name, 84, 12, [=](const SoakChunk& chunk) {
                           return check_kills(programs.command, command, chunk.cases, chunk.seed);
                         }});
  }
  if (programs.failing_new.empty()) return;
  for (const SoakCommand& command : soak_commands()) {
    if (command.part == CommandPart::kKills) continue;
    questions.push_back(
        {"memory", "memory of " + command.name, 0, kRuns, [=](const SoakChunk& chunk) {
           const auto step = static_cast<std::uint64_t>(kEvery / chunk.scale);
           return check_memory(
               programs.command, programs.failing_new, command,
               {.first = (chunk.number * kRuns + 1) * step, .step = step, .runs = kRuns});
         }});
  }
}

}  // namespace

std::vector<SoakQuestion> soak_questions(const SoakPrograms& programs) {
  std::vector<SoakQuestion> questions = {
      judged("poses", "pairs of trees", 10'000'000, 20'000, check_poses),
      judged("poses", "distances", 1'000'000, 10'000, check_distances),
      judged("motions", "sweeps", 1'000'000, 2'000, check_sweeps),
      judged("motions", "edges among trees", 100'000, 500, check_edges),
      judged("motions", "edges in scenes", 100'000, 500, check_checker_edges),
      judged("configurations", "robots among trees", 1'000'000, 5'000, check_configurations),
      judged("configurations", "robots in scenes", 1'000'000, 5'000, check_checker_configurations)};
  add_command_questions(programs, questions);
  questions.push_back(threaded("trees", 2000, 100, check_shared_trees));
  questions.push_back(threaded("checkers", 500, 10, check_shared_checkers));
  questions.push_back(threaded("fits", 20, 2, check_fits_at_once));
  questions.push_back(threaded("files", 1000, 50, check_shared_files));
  return questions;
}

}  // namespace spherule
