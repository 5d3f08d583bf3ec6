// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <string>
#include <vector>

namespace spherule::test {

// A name and a maker of a shape of about 20 to 100 millimetres.
struct NamedShape {
  std::string name;
  std::function<TopoDS_Shape()> make;
};

// Solids and single faces whose deviation can be proved: every kind of surface with a bound.
const std::vector<NamedShape>& provable_shapes();
// The one of this name.
TopoDS_Shape shape_named(const std::string& name);

// A face at a distance from a free-form one, of which nothing is proved.
TopoDS_Shape offset_face();
// Sheets 1 high along (0, 0, 0), (1, 0, 0), (1, 1, 0), of degree one with weights w, w, 0.99 w at
// the knots 0, 1, 11, and how much the derivative jumps at 1.
struct BentSheet {
  TopoDS_Face extruded;
  TopoDS_Face bent_along_u;
  TopoDS_Face bent_along_v;
  double jump;
};
BentSheet bent_sheet(double weight);
// A square of edges without a face.
TopoDS_Shape wire();
// A box of 20 and another at (100, 0, 0), turned by a quarter about z, as an assembly.
TopoDS_Shape assembly();

}  // namespace spherule::test
