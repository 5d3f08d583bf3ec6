// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/text.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"
#include "io/ply_data.h"

#include <algorithm>
#include <span>
#include <vector>

namespace spherule::internal {
namespace {

// The triangles of strips; -1 begins a new one.
void add_strip(const std::vector<std::int64_t>& strip, const PlyData& data,
               std::vector<std::vector<std::int64_t>>& faces) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == -1) {
      begin = i + 1;
    } else if (strip[i] < 0) {
      data.fail("a strip refers to a negative vertex");
    } else if (i >= begin + 2) {
      const auto triangle = strip_triangle(std::span(strip).subspan(begin), i - begin);
      faces.emplace_back(triangle.begin(), triangle.end());
    }
  }
}

void read_faces(PlyData& data, const PlyElement& element,
                std::vector<std::vector<std::int64_t>>& faces) {
  const auto is_corners = [](const PlyProperty& p) {
    return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (std::ranges::none_of(element.properties, is_corners)) {
    data.fail(in_quotes(element.name) + " lacks the list vertex_indices");
  }
  std::vector<std::int64_t> corners;
  data.for_each_item(element, [&] {
    for (const PlyProperty& p : element.properties) {
      if (!is_corners(p)) {
        data.skip(p);
        continue;
      }
      data.next_list(p, corners);
      if (element.name == "face") {
        faces.push_back(corners);
      } else {
        add_strip(corners, data, faces);
      }
    }
  });
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& subject) {
  PlyData data(bytes, subject);
  TriangleMesh mesh;
  std::vector<std::vector<std::int64_t>> faces;
  for (const PlyElement& element : data.elements()) {
    if (element.name == "vertex") {
      mesh.vertices = data.read_points(element);
    } else if (element.name == "face" || element.name == "tristrips") {
      read_faces(data, element, faces);
    } else {
      data.skip(element);
    }
  }
  data.expect_end();
  for (const std::vector<std::int64_t>& corners : faces) {
    add_polygon(mesh, corners, mesh.vertices.size(), subject);
  }
  if (data.is_text()) {
    mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
  }
  return mesh;
}

}  // namespace spherule::internal
