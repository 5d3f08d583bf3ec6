// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/text.h"
#include "base/text_scanner.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {
namespace {

// Statements of curves and surfaces, those of old versions of the format too, and of other files.
constexpr std::array<std::string_view, 8> kUnsupported = {"surf", "curv", "call", "bsp",
                                                          "bzp",  "cdc",  "cdp",  "res"};

void read_vertex(TextScanner& in, TriangleMesh& mesh) {
  const double x = in.number(), y = in.number(), z = in.number();
  mesh.vertices.emplace_back(x, y, z);
  int more = 0;
  double weight = 1.0;
  for (std::string_view token = in.token_on_line(); !token.empty(); token = in.token_on_line()) {
    const double value = in.number(token);
    if (++more == 1) weight = value;
  }
  // One more number is a weight, three are a colour.
  if (more == 1 && weight != 1.0) in.fail("a vertex with a weight other than 1");
}

// A corner is "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal"; it counts
// from 1, or backwards from the last vertex so far if it is negative. Returned counting from 0.
std::int64_t read_corner(const TextScanner& in, std::string_view token, std::size_t vertices) {
  const std::int64_t index = in.integer(token.substr(0, token.find('/')));
  if (index == 0) in.fail("a face refers to vertex 0; the first one is 1");
  return index > 0 ? index - 1 : static_cast<std::int64_t>(vertices) + index;
}

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& subject) {
  TextScanner in(bytes, subject, {.comment = '#', .has_continued_lines = true});
  TriangleMesh mesh;
  std::vector<std::vector<std::int64_t>> faces;
  for (std::string_view word = in.token(); !word.empty(); word = in.token()) {
    if (word.find('\0') != std::string_view::npos) in.fail("not an OBJ file");
    if (word == "v") {
      read_vertex(in, mesh);
    } else if (word == "f" || word == "fo") {
      std::vector<std::int64_t>& corners = faces.emplace_back();
      for (std::string_view t = in.token_on_line(); !t.empty(); t = in.token_on_line()) {
        corners.push_back(read_corner(in, t, mesh.vertices.size()));
      }
    } else if (std::ranges::find(kUnsupported, word) != kUnsupported.end()) {
      in.fail(in_quotes(word) + " is not supported; only polygons are");
    }
    in.skip_line();
  }
  for (const std::vector<std::int64_t>& corners : faces) {
    add_polygon(mesh, corners, mesh.vertices.size(), subject);
  }
  mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
  return mesh;
}

}  // namespace spherule::internal
