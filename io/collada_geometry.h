// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "io/collada_document.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// Values that an accessor picks from an array: so many numbers for each element.
struct ColladaValues {
  std::vector<double> numbers;
  std::size_t components = 1;

  std::size_t count() const { return numbers.size() / components; }
};

// The <source> with numbers, of elements of so many; accessors that reach beyond the array are
// refused.
ColladaValues collada_values(const ColladaDocument& document,
                             const ColladaDocument::Element& source, std::size_t components);

// The <input> of this meaning; null if there is none.
const ColladaDocument::Element* collada_input(const ColladaDocument::Element& parent,
                                              const char* semantic);

// The mesh of a <geometry>: its triangles, polygons, polygon lists, strips and fans over the
// positions of its <vertices>, in their order; lines are left out. `vertex_error` charges the
// rounding of the decimals. Throws Error for shapes that are no mesh and polygons with holes.
TriangleMesh collada_mesh(const ColladaDocument& document, const ColladaDocument::Element& geometry,
                          const std::string& subject);

}  // namespace spherule::internal
