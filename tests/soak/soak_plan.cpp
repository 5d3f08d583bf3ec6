// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_plan.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sys/resource.h>

namespace spherule {
namespace {

// A different number for each chunk of each question and seed.
std::uint64_t chunk_seed(std::uint64_t seed, const std::string& question, std::uint64_t number) {
  std::uint64_t mixed = seed;
  const auto mix = [&](std::uint64_t value) {  // splitmix64
    mixed += value + 0x9e3779b97f4a7c15U;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    mixed ^= mixed >> 31U;
  };
  for (const char c : question) mix(static_cast<unsigned char>(c));
  mix(number);
  return mixed >> 1U;
}

// Of this process and of those that it started.
double processor_seconds() {
  double seconds = 0.0;
  for (const auto whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    struct rusage usage = {};
    ::getrusage(whose, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return seconds;
}

std::uint64_t case_count(const SoakQuestion& question, double scale) {
  const double cases = std::round(static_cast<double>(question.cases) * scale);
  return std::max(std::uint64_t{1}, static_cast<std::uint64_t>(cases));
}

// 0 if it is not known before.
std::uint64_t chunk_count(const SoakQuestion& question, double scale) {
  if (question.cases == 0) return 0;
  return (case_count(question, scale) + question.of_chunk - 1) / question.of_chunk;
}

unsigned long long number(std::uint64_t n) {
  return n;
}

class ProgressLine {
 public:
  void show(const SoakQuestion& question, std::uint64_t done, std::uint64_t all) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(10)) return;
    last_ = now;
    std::fprintf(stderr, "%s, %s: %llu", question.part.c_str(), question.name.c_str(),
                 number(done));
    if (all > 0) std::fprintf(stderr, " of %llu", number(all));
    std::fprintf(stderr, " chunks\n");
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void print_row(const char* part, const SoakRecord& row, bool with_seconds, std::FILE* file) {
  std::fprintf(file, "| %s | %s | %llu | %llu | %llu | %llu | %llu | %llu | %llu | %llu |", part,
               row.question.c_str(), number(row.cases), number(row.answers), number(row.near),
               number(row.missed), number(row.crossed), number(row.other), number(row.extra),
               number(row.uncertain));
  if (with_seconds) std::fprintf(file, " %.0f |", row.seconds);
  std::fprintf(file, "\n");
}

}  // namespace

SoakRecord run_chunk(const SoakQuestion& question, std::uint64_t number,
                     const SoakSettings& settings) {
  SoakChunk chunk{.number = number,
                  .cases = question.of_chunk,
                  .seed = chunk_seed(settings.seed, question.name, number),
                  .scale = settings.scale};
  if (question.cases > 0) {
    const std::uint64_t before = number * question.of_chunk;
    const std::uint64_t all = case_count(question, settings.scale);
    chunk.cases = std::min(question.of_chunk, all - std::min(all, before));
  }
  const double start = processor_seconds();
  SoakRecord record = question.run(chunk);
  record.question = question.name;
  record.chunk = number;
  record.seconds = processor_seconds() - start;
  return record;
}

bool run_soak(const std::vector<SoakQuestion>& questions, SoakState& state,
              std::uint64_t most_chunks) {
  ProgressLine progress;
  for (const SoakQuestion& question : questions) {
    const std::uint64_t all = chunk_count(question, state.settings().scale);
    for (std::uint64_t i = 0; all == 0 || i < all; ++i) {
      const SoakRecord* record = state.find(question.name, i);
      if (record == nullptr) {
        if (most_chunks-- == 0) return false;
        state.add(run_chunk(question, i, state.settings()));
        record = state.find(question.name, i);
        progress.show(question, i + 1, all);
      }
      if (record->is_last) break;
    }
  }
  return true;
}

bool print_table(const std::vector<SoakQuestion>& questions, const SoakState& state,
                 bool with_seconds, std::FILE* file) {
  std::fprintf(
      file,
      "| part | question | cases | answers | near | missed | crossed bounds | other "
      "failures | extra | uncertain |%s\n|---|---|%s\n",
      with_seconds ? " processor s |" : "",
      with_seconds ? "---|---|---|---|---|---|---|---|---|" : "---|---|---|---|---|---|---|---|");
  SoakRecord all, part;
  all.question = part.question = "sum";
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const SoakQuestion& question = questions[i];
    SoakRecord row;
    bool is_there = false;
    for (const auto& [key, record] : state.records()) {
      if (key.first != question.name) continue;
      row.add(record);
      is_there = true;
    }
    row.question = question.name;
    if (is_there) print_row(question.part.c_str(), row, with_seconds, file);
    part.add(row);
    if (i + 1 < questions.size() && questions[i + 1].part == question.part) continue;
    if (part.cases > 0) {
      print_row(("**" + question.part + "**").c_str(), part, with_seconds, file);
    }
    all.add(part);
    part = SoakRecord();
    part.question = "sum";
  }
  for (const std::string& fault : all.faults) std::fprintf(file, "FAILED: %s\n", fault.c_str());
  return all.is_clean();
}

}  // namespace spherule
