// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/parts/fit_options.h"

#include <functional>

namespace spherule {

// `fit --each`: runs `fit` on every file of this shard, with the name of its output filled in, and
// returns the largest exit code. A file that cannot be used is told and ends nothing.
int fit_each(FitArguments& arguments, const std::function<int(FitArguments&)>& fit);

}  // namespace spherule
