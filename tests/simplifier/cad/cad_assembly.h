// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule::test {

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

}  // namespace spherule::test
