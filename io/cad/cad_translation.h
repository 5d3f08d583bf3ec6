// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// Reading a CAD file with OpenCASCADE. For sources that know its types.

namespace spherule::internal {

// A shape of an assembly that is no assembly itself, in its place.
struct CadLeaf {
  std::string name;
  TopoDS_Shape shape;
};

enum class Parts { kTogether, kApart };

// Shapes in millimetres.
struct Translation {
  TopoDS_Shape shape;           // all that the file holds
  std::string unit;             // as the file names it, in lower case
  std::vector<CadLeaf> leaves;  // with Parts::kApart: all faces of the shape, none twice
};

// `bytes` are those of the file. Throws Error as CadShape does.
Translation translate(const std::filesystem::path& path, std::string_view bytes, Parts parts);

}  // namespace spherule::internal
