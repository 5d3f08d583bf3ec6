// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// The readers of the single formats, and what they share. Each turns the bytes of a file into a
// mesh in the unit of the file, vertices as they stand in it and not welded, with `vertex_error`
// set; numbers need not be in range yet. `subject` names the file in an Error.

namespace spherule::internal {

TriangleMesh read_3mf(std::string_view bytes, const std::string& subject);
TriangleMesh read_stl(std::string_view bytes, const std::string& subject);
TriangleMesh read_obj(std::string_view bytes, const std::string& subject);
TriangleMesh read_off(std::string_view bytes, const std::string& subject);
TriangleMesh read_ply(std::string_view bytes, const std::string& subject);

// The size in micrometres of the unit that a 3MF file states. Throws Error.
double unit_of_3mf(std::string_view bytes, const std::string& subject);

// Appends the triangles of a polygon (polygon_triangles.h), whose vertices are there. Points and
// lines (fewer than three corners) are no surface and are left out. Throws Error for an index that
// is not below `vertex_count`, for more corners than four times as many (no polygon comes by its
// vertices that often, even where bridges lead to its holes), and for a polygon that takes too long
// to divide.
void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject);

// The triangle of a strip that ends at corner `last`, from 2 on: with the two corners before it,
// every second one turned over, so that all are turned alike.
std::array<std::int64_t, 3> strip_triangle(std::span<const std::int64_t> strip, std::size_t last);

}  // namespace spherule::internal
