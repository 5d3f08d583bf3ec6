// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/collada_document.h"
#include "io/placed_part.h"

#include <span>
#include <vector>

namespace spherule::internal {

// The entries of a transform, relative to its norms: decimals, sine and cosine of an angle of up to
// 360 degrees that is off by 2^-50, the norm of the axis, and their few products.
inline constexpr double kColladaEntryError = 0x1p-45;

// The transforms of a <node>, the first one outermost; those that are the identity are left out.
// Throws Error for transforms that are not affine and finite, and for <skew> and <lookat>, which
// are not supported.
std::vector<Affine> collada_transforms(const ColladaDocument& document,
                                       const ColladaDocument::Element& node);

// A matrix of sixteen numbers, row by row.
Affine collada_matrix(const ColladaDocument& document, const ColladaDocument::Element& element,
                      std::span<const double> entries);

}  // namespace spherule::internal
