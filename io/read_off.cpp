// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/text_scanner.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"

#include <vector>

namespace spherule::internal {
namespace {

// A number of items that are each at least two characters long.
std::size_t read_count(TextScanner& in, std::size_t text_size) {
  const std::int64_t count = in.integer();
  if (count < 0 || static_cast<std::uint64_t>(count) > text_size / 2) {
    in.fail("the file cannot hold " + std::to_string(count) + " items");
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

TriangleMesh read_off(std::string_view bytes, const std::string& subject) {
  TextScanner in(bytes, subject, {.comment = '#'});
  const std::string_view keyword = in.token();
  // Texture coordinates, colours and normals follow the coordinates and are skipped.
  const bool known = keyword == "OFF" || keyword == "COFF" || keyword == "NOFF" ||
                     keyword == "CNOFF" || keyword == "STOFF" || keyword == "STCOFF" ||
                     keyword == "STNOFF" || keyword == "STCNOFF";
  if (!known) in.fail("not an OFF file of three dimensions in text form");
  const std::size_t vertices = read_count(in, bytes.size());
  const std::size_t faces = read_count(in, bytes.size());
  in.skip_line();  // the number of edges

  TriangleMesh mesh;
  mesh.vertices.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    const double x = in.number(), y = in.number(), z = in.number();
    mesh.vertices.emplace_back(x, y, z);
    in.skip_line();
  }
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < faces; ++i) {
    corners.resize(read_count(in, bytes.size()));
    for (std::int64_t& corner : corners) corner = in.integer();
    add_polygon(mesh, corners, vertices, subject);
    in.skip_line();  // a colour
  }
  if (!in.token().empty()) in.fail("more lines than the header announces");
  mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
  return mesh;
}

}  // namespace spherule::internal
