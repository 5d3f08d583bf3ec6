// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_state.h"

#include "base/error.h"
#include "base/files.h"

#include <array>
#include <cstddef>
#include <fstream>
#include <string_view>

namespace spherule {
namespace {

namespace fs = std::filesystem;

std::string header(const SoakSettings& settings) {
  return "spherule-soak 1 seed " + std::to_string(settings.seed) + " scale " +
         to_text(std::array{settings.scale});
}

}  // namespace

SoakState::SoakState(const fs::path& file, const SoakSettings& settings, bool resume)
    : file_(file), settings_(settings) {
  if (resume && fs::exists(file_)) {
    read();
  } else {
    write_file_atomically(file_, header(settings_) + "\n");
  }
}

void SoakState::read() {
  const std::string text = read_file(file_);
  const std::size_t whole = text.rfind('\n') + 1;  // 0 if there is none
  std::string_view rest(text.data(), whole);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(line.size() + 1);
    if (number == 1 && line != header(settings_)) {
      throw Error(file_.string(), "is of another soak: " + std::string(line));
    }
    if (number == 1) continue;
    const SoakRecord record =
        decode_record(line, file_.string() + ", line " + std::to_string(number));
    records_[{record.question, record.chunk}] = record;
  }
  if (whole == 0) throw Error(file_.string(), "is not the state of a soak");
  fs::resize_file(file_, whole);
}

const SoakRecord* SoakState::find(const std::string& question, std::uint64_t chunk) const {
  const auto found = records_.find({question, chunk});
  return found == records_.end() ? nullptr : &found->second;
}

void SoakState::add(const SoakRecord& record) {
  append(encode_record(record) + "\n");
  records_[{record.question, record.chunk}] = record;
}

void SoakState::append(const std::string& line) const {
  std::ofstream stream(file_, std::ios::binary | std::ios::app);
  if (!(stream << line).flush()) throw Error(file_.string(), "cannot be written");
}

}  // namespace spherule
