// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/parts/fit_options.h"

namespace spherule {

// `fit` of several files, or of the bodies of an assembly. Returns the exit code: kNo if a promise
// about any body is not proved.
int fit_bodies(FitArguments& arguments);

}  // namespace spherule
