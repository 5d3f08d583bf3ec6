// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_record.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>

namespace spherule {
namespace {

constexpr std::size_t kMostFaults = 20;

// Calls use(name, member) for each number.
template <class Record, class Use>
void for_each_number(Record& record, Use use) {
  use("chunk", record.chunk);
  use("cases", record.cases);
  use("answers", record.answers);
  use("near", record.near);
  use("missed", record.missed);
  use("crossed", record.crossed);
  use("other", record.other);
  use("extra", record.extra);
  use("uncertain", record.uncertain);
  use("worst_slack", record.worst_slack);
  use("seconds", record.seconds);
  use("last", record.is_last);
}

}  // namespace

void SoakRecord::add_fault(const std::string& what) {
  ++other;
  if (faults.size() < kMostFaults) faults.push_back(what);
}

void SoakRecord::add(const SoakRecord& record) {
  cases += record.cases;
  answers += record.answers;
  near += record.near;
  missed += record.missed;
  crossed += record.crossed;
  other += record.other;
  extra += record.extra;
  uncertain += record.uncertain;
  worst_slack = std::max(worst_slack, record.worst_slack);
  seconds += record.seconds;
  faults.insert(faults.end(), record.faults.begin(), record.faults.end());
}

SoakRecord record_of(const SoakReport& report, std::uint64_t cases) {
  SoakRecord record;
  record.cases = cases;
  for (const Tally& tally : report.tallies()) {
    record.answers += tally.cases;
    record.near += tally.near;
    record.missed += tally.missed;
    record.crossed += tally.crossed;
    record.other += tally.other;
    record.extra += tally.extra;
    record.uncertain += tally.uncertain;
    record.worst_slack = std::max(record.worst_slack, tally.worst_slack);
  }
  record.faults = report.faults();
  return record;
}

std::string encode_record(const SoakRecord& record) {
  nlohmann::json json = {{"question", record.question}, {"faults", record.faults}};
  for_each_number(record, [&](const char* name, const auto& number) { json[name] = number; });
  return json.dump();
}

SoakRecord decode_record(std::string_view line, const std::string& place) {
  SoakRecord record;
  try {
    const nlohmann::json json = nlohmann::json::parse(line);
    json.at("question").get_to(record.question);
    json.at("faults").get_to(record.faults);
    for_each_number(record, [&](const char* name, auto& number) { json.at(name).get_to(number); });
  } catch (const nlohmann::json::exception& error) {
    throw Error(place, error.what());
  }
  return record;
}

}  // namespace spherule
