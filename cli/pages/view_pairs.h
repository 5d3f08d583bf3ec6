// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/robots/pair_kinds.h"
#include "cli/text/json.h"

#include <string>

namespace spherule {

// Whether a file tells of pairs of a robot's links and has no spheres: NAME.pairs, or an SRDF
// without approximations.
bool is_of_pairs_alone(const std::string& file);

// The pairs of links as the page takes them: indices of links, kind, verdict and, where they are
// proved free somewhere and not ignored, the boxes, a letter for each node ('A' a box that is not
// proved, 'B' a free one, from 'C' on one that is halved: its variable).
Json view_pairs(const PairKinds& kinds);

}  // namespace spherule
