// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// See parallel_for.h. Loops know nothing of each other: each is isolated.
namespace tbb {

class task_group_context {
 public:
  enum kind_type { isolated };
  explicit task_group_context(kind_type) {}
};

}  // namespace tbb
