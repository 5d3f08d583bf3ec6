// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cad/internal/surface_deviation.h"

class Geom2d_Curve;
class TopoDS_Face;

namespace opencascade {
template <class T>
class handle;
}

// OpenCASCADE's surfaces and curves with what is known of their derivatives.

namespace spherule::internal {

// The surface of a face, in the frame of the part. Without a bound for offset surfaces, and for
// sweeps of curves that have none.
ParametricSurface surface_of(const TopoDS_Face& face);

// The largest coordinate, of poles and locations, and radius that the face's surface is evaluated
// from. These may be far larger than the face.
double largest_length(const TopoDS_Face& face);

// Without a bound for offset curves, parabolas and hyperbolas.
ParameterCurve curve_of(const opencascade::handle<Geom2d_Curve>& curve);

}  // namespace spherule::internal
