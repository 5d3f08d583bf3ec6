// SPDX-License-Identifier: BSD-3-Clause
// The entry of libFuzzer. SPHERULE_FUZZ_TARGET (environment) names the target; with
// SPHERULE_FUZZ_SEEDS, a folder, the program writes the seeds of the target there and ends.
#include "base/error.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/temp_dir.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

using spherule::test::FuzzTarget;

const FuzzTarget& requested() {
  const char* const name = std::getenv("SPHERULE_FUZZ_TARGET");
  if (name == nullptr) {
    for (const FuzzTarget& target : spherule::test::fuzz_targets()) {
      std::cout << target.name << ' ' << target.dictionary << '\n';
    }
    std::exit(0);
  }
  return spherule::test::fuzz_target(name);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const FuzzTarget& target = requested();
  if (const char* const folder = std::getenv("SPHERULE_FUZZ_SEEDS")) {
    int count = 0;
    for (const std::string& seed : target.seeds()) {
      std::ofstream(std::string(folder) + "/seed" + std::to_string(count++), std::ios::binary)
          << seed;
    }
    std::exit(0);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzTarget& target = requested();
  static const spherule::test::TempDir folder;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = folder.write("input" + std::string(target.extension), target.file_of(bytes));
  try {
    target.read(file);
  } catch (const spherule::Error&) {
    return 0;  // refused
  }
  return 0;
}
