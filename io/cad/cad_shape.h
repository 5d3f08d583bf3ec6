// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/cad/surface_deviation.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

class TopoDS_Face;

namespace spherule::internal {

// The surface of a face, in the frame of the part. Without a bound for offset surfaces, and for
// sweeps of curves that have none.
ParametricSurface surface_of(const TopoDS_Face& face);

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
  CadShape(CadShape&&) noexcept;
  CadShape& operator=(CadShape&&) noexcept;

  // The bodies of an assembly, each in its place: its parts, and of a part of several solids each
  // of these. A shape that stands in several places is tessellated in the first.
  struct Placed;
  static std::vector<Placed> bodies(const std::filesystem::path& path, std::string_view bytes);

  double diagonal() const;   // of the box
  double tolerance() const;  // the largest of its edges, vertices and faces
  const std::string& stated_unit() const { return stated_unit_; }
  std::size_t face_count() const;
  std::size_t free_edge_count() const;

  // Tessellates anew and hands over each face. Throws Error for a face that has no triangles.
  void tessellate(double deflection, double angle, const std::function<void(const CadFace&)>& take);

 private:
  struct Shape;
  CadShape(std::unique_ptr<Shape> shape, std::string subject, std::string stated_unit);

  std::unique_ptr<Shape> shape_;
  std::string subject_;
  std::string stated_unit_;
};

struct CadShape::Placed {
  std::string name;                    // no two are the same
  std::optional<CadShape> shape = {};  // of the first of its kind
  std::size_t copy_of = 0;             // where there is no shape: the body with it, and
  // the motion from there to here, in millimetres.
  Eigen::Matrix<double, 3, 4> from_original = Eigen::Matrix<double, 3, 4>::Identity();
};

}  // namespace spherule::internal
