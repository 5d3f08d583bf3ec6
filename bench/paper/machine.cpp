// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/machine.h"

#include <Eigen/Core>
#include <fcl/config.h>

#include <fstream>
#include <thread>

namespace spherule {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler() {
#ifdef __clang__
  return __VERSION__;
#else
  return std::string("GCC ") + __VERSION__;
#endif
}

}  // namespace

std::vector<std::pair<std::string, std::string>> machine_facts(
    const std::filesystem::path& packages) {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"processor", processor()},
      {"cores", std::to_string(std::thread::hardware_concurrency())},
      {"compiler", compiler()},
      {"FCL", FCL_VERSION},
      {"Eigen", std::to_string(EIGEN_WORLD_VERSION) + '.' + std::to_string(EIGEN_MAJOR_VERSION) +
                    '.' + std::to_string(EIGEN_MINOR_VERSION)}};
  std::ifstream file(packages);
  for (std::string name, version; file >> name >> version;) facts.emplace_back(name, version);
  return facts;
}

}  // namespace spherule
