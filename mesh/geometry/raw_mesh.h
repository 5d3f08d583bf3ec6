// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

// What the readers of the single formats share. Each turns the bytes of a file into a mesh in the
// unit of the file, vertices as they stand in it and not welded, with `vertex_error` set; numbers
// need not be in range yet. `subject` names the file in an Error.

namespace spherule::internal {

TriangleMesh read_3mf(std::string_view bytes, const std::string& subject);
TriangleMesh read_stl(std::string_view bytes, const std::string& subject);
TriangleMesh read_obj(std::string_view bytes, const std::string& subject);
TriangleMesh read_off(std::string_view bytes, const std::string& subject);
TriangleMesh read_ply(std::string_view bytes, const std::string& subject);

// The size in micrometres of the unit that a 3MF file states. Throws Error.
double unit_of_3mf(std::string_view bytes, const std::string& subject);

// What stands behind the last dot of the name, in lower case.
std::string lower_extension(const std::filesystem::path& path);

// Throws Error unless the factor is positive and finite.
void check_scale(double scale);

// The bytes of the file. Throws Error, naming it, if it is not a file or is empty.
std::string read_regular_file(const std::filesystem::path& path);

// Appends the polygon as a fan about its first corner. The winding number of a fan is that of the
// polygon, so a planar polygon that is not convex is covered too. Points and lines (fewer than
// three corners) are no surface and are left out. Throws Error for an index that is not below
// `vertex_count`.
void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject);

// Largest absolute coordinate of the vertices; infinite if one is not a number.
double largest_coordinate(const TriangleMesh& mesh);

// Bound on the distance by which a point moves when each coordinate, of magnitude up to `largest`,
// changes by `relative` of it: sqrt(3) largest relative, rounded up.
double rounding_distance(double largest, double relative);

// Multiplies the vertices and `vertex_error`, to which the rounding is added.
void apply_scale(TriangleMesh& mesh, double scale);

// The same triangles over distinct vertices that are all used: vertices are one if their
// coordinates are equal bit for bit (zeros of both signs count as equal). In order of first use.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace spherule::internal
