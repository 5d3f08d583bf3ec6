// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

// Sentences about a link's size that follow its name; empty where nothing is to be said. `across`
// is the diagonal of the box of its mesh; lengths are in metres.
namespace spherule::internal {

// Why a link is not to be covered, or its spheres examined, for so small a max error.
std::string size_fault(double across, double max_error);

// That a link is so large that its mesh is rather in millimetres.
std::string size_doubt(double across, double max_error);

}  // namespace spherule::internal
