// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cad/internal/surface_deviation.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace spherule::internal {

struct CadFace {
  std::string name;
  TessellatedFace tessellation;
  bool reversed = false;  // its triangles turn the other way in the part
  double largest = 0.0;   // of the numbers its surface is evaluated from: coordinates and radii
  std::string fault;      // why the boundary in `tessellation` is not whole; empty if it is
};

// The shape that a STEP or IGES file holds, in millimetres: all that is known of OpenCASCADE stands
// behind it.
class CadShape {
 public:
  // `bytes` are those of the file. Throws Error.
  CadShape(const std::filesystem::path& path, std::string_view bytes);
  ~CadShape();

  double diagonal() const;   // of the box
  double tolerance() const;  // the largest of its edges, vertices and faces
  const std::string& stated_unit() const { return stated_unit_; }
  std::size_t face_count() const;
  std::size_t free_edge_count() const;

  // Tessellates anew and hands over each face. Throws Error for a face that has no triangles.
  void tessellate(double deflection, double angle, const std::function<void(const CadFace&)>& take);

 private:
  struct Shape;
  std::unique_ptr<Shape> shape_;
  std::string subject_;
  std::string stated_unit_;
};

}  // namespace spherule::internal
