// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace spherule {

// Ground truth for the solids themselves (FclSolid).
class Oracle {
 public:
  explicit Oracle(const Workload& workload);
  ~Oracle();

  // Bit i: body i of the workload touches an obstacle. One word for each configuration.
  std::vector<std::uint32_t> touching_bodies(std::span<const ArmPositions> configurations) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace spherule
