// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How long work tells how far it is.
//
// @code{.cpp}
// #include <spherule/base/progress.h>
// #include <atomic>
// #include <cassert>
//
// std::atomic<double> furthest = 0.0;
// const spherule::Progress progress = [&](double share, const char*) { furthest = share; };
// progress(0.5, "placing external spheres");  // as a long function does from time to time
// assert(furthest == 0.5);
// @endcode

#include <functional>

namespace spherule {

// Called from time to time with the share that is done (0 to 1, or negative where unknown) and a
// few words on what is being done, which are valid during the call only. The share may begin again
// where something is done anew, on a coarser grid. It must be thread-safe: worker threads call it,
// several at once where links are covered or a lower bound is proved.
using Progress = std::function<void(double share, const char* what)>;

}  // namespace spherule
