// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Parts and assemblies that the tests make with OpenCASCADE, their files, and where it says that
// they are.

#include <Eigen/Core>

#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <filesystem>
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
// A square of edges without a face.
TopoDS_Shape wire();
// A box of 20 and another at (100, 0, 0), turned by a quarter about z, as an assembly.
TopoDS_Shape assembly();

// A part of an assembly, and where it stands.
struct AssemblyPart {
  std::string name;
  TopoDS_Shape shape;
  std::vector<TopLoc_Location> places;
};

// STEP, written by OpenCASCADE with products and instances, all in one assembly inside of a root.
// The parts' names are those of the products; of an instance too if `name_instances`.
void write_assembly(const std::vector<AssemblyPart>& parts, const std::filesystem::path& path,
                    bool name_instances = false);

// Boxes, no two alike, each in as many places, turned and shifted so that none intersects another.
std::vector<AssemblyPart> box_parts(int parts, int places);

// Written by OpenCASCADE; `unit` is that of the numbers in the file: "MM", "INCH", "M".
void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path,
                const std::string& unit = "MM");
void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path);

// Points of the faces, in millimetres: evenly spread in the parameters with seeded jitter, inside
// of the boundary as OpenCASCADE classifies them, some close to it and points of all edges among
// them. About so many for each face.
std::vector<Eigen::Vector3d> points_of(const TopoDS_Shape& shape, int per_face,
                                       std::uint64_t seed = 7);

// Compares the bounds of derivatives with OpenCASCADE's derivatives at random points of random
// rectangles of every face. The first that is broken; `tightest` becomes the largest quotient of
// a derivative of second order and its bound.
std::string broken_bounds(const TopoDS_Shape& shape, int rectangles, double& tightest);

}  // namespace spherule::test
