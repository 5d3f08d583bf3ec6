// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Refuses threads that do not round to nearest.
//
// @code{.cpp}
// #include <spherule/spheretree/error.h>
// #include <spherule/spheretree/rounding_mode.h>
// #include <cassert>
// #include <cfenv>
//
// bool is_refused = false;
// std::fesetround(FE_UPWARD);
// try {
//   spherule::require_rounding_to_nearest();
// } catch (const spherule::Error&) {
//   is_refused = true;
// }
// std::fesetround(FE_TONEAREST);
// assert(is_refused);
// @endcode

namespace spherule {

// Throws Error unless this thread rounds to nearest, as every proved bound presumes. build_tree(),
// refit(), check(), load_tree(), place_external_spheres(), cover(), repair(), certify(),
// prove_link_pairs(), prove_attached_pairs() and the constructors of PairCache,
// MechanismCheck::Scratch and RobotChecker::Scratch call it, and so does what calls these; single
// queries, enclosing_sphere() and readers of meshes do not. If the mode is changed after that
// nothing is promised; in tests no contact was missed. Determined by sums, as std::fegetround()
// does not see every floating-point unit of a processor.
void require_rounding_to_nearest();

}  // namespace spherule
