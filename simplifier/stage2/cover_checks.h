// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cover.h"
#include "simplifier/solid/clearance.h"

#include <cstddef>
#include <string>

// What every way to cover S refuses, with an Error that names it.

namespace spherule::internal {

// An E that is not positive and finite.
void check_max_error(double max_error);

// Options out of range.
void check_options(const CoverOptions& options);

// Zones of an error of their own, for a method that knows one max error only.
void refuse_error_zones(const CoverOptions& options, const std::string& method);

// An E of which the searches could not tell such a share.
void check_resolved(const Clearance& clearance, double max_error, double share);

// No part is worth two million spheres: the error is then too small for the model.
void check_count(std::size_t spheres);

}  // namespace spherule::internal
