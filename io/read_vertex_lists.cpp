// SPDX-License-Identifier: BSD-3-Clause
#include "base/bytes.h"
#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "base/text_scanner.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"
#include "io/ply_data.h"
#include "io/polygon_triangles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The formats that are lists of vertices and faces: OBJ, OFF, PLY and STL.

namespace spherule::internal {
namespace {

void charge_decimals(TriangleMesh& mesh) {
  mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
}

void add_vertex(TextScanner& in, TriangleMesh& mesh) {
  const double x = in.number(), y = in.number(), z = in.number();
  mesh.vertices.emplace_back(x, y, z);
}

// Wavefront OBJ.

// Statements of curves and surfaces, those of old versions of the format too, and of other files.
constexpr std::array<std::string_view, 8> kUnsupported = {"surf", "curv", "call", "bsp",
                                                          "bzp",  "cdc",  "cdp",  "res"};

void read_vertex(TextScanner& in, TriangleMesh& mesh) {
  add_vertex(in, mesh);
  // One more number is a weight, three are a colour, which is not used.
  const std::string_view weight = in.token_on_line();
  if (weight.empty() || !in.token_on_line().empty()) return;
  if (in.number(weight) != 1.0) in.fail("a vertex with a weight other than 1");
}

// A corner is "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal"; it counts
// from 1, or backwards from the last vertex so far if it is negative. Returned counting from 0.
std::int64_t read_corner(const TextScanner& in, std::string_view token, std::size_t vertices) {
  const std::int64_t index = in.integer(token.substr(0, token.find('/')));
  if (index == 0) in.fail("a face refers to vertex 0; the first one is 1");
  return index > 0 ? index - 1 : static_cast<std::int64_t>(vertices) + index;
}

// OFF.

// A number of items that are each at least two characters long.
std::size_t read_count(TextScanner& in, std::size_t text_size) {
  const std::int64_t count = in.integer();
  if (count < 0 || static_cast<std::uint64_t>(count) > text_size / 2) {
    in.fail("the file cannot hold " + std::to_string(count) + " items");
  }
  return static_cast<std::size_t>(count);
}

// PLY.

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

// STL, in text and binary.

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kDataStart = kHeaderBytes + 4;
constexpr std::size_t kFacetBytes = 50;  // normal, three corners, two bytes of attributes

std::uint32_t facet_count(std::string_view bytes) {
  return number_at<std::uint32_t>(bytes.data() + kHeaderBytes);
}

// The size decides, because the header of a binary file may begin with "solid" as well.
bool has_size_of_binary(std::string_view bytes) {
  return bytes.size() >= kDataStart &&
         bytes.size() - kDataStart == kFacetBytes * std::size_t{facet_count(bytes)};
}

TriangleMesh read_binary(std::string_view bytes, const std::string& subject) {
  TriangleMesh mesh;
  const std::size_t count = facet_count(bytes);
  if (count > std::size_t{std::numeric_limits<int>::max()} / 3) {
    throw Error(subject, "more than 2^31 vertices");
  }
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* const facet = bytes.data() + kDataStart + i * kFacetBytes;
    const auto number = [&](std::size_t k) { return number_at<float>(facet + 4 * k); };
    for (std::size_t k = 3; k < 12; k += 3) {  // the normal first
      mesh.vertices.emplace_back(number(k), number(k + 1), number(k + 2));
    }
    const int first = static_cast<int>(3 * i);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

bool is_word(std::string_view token, std::string_view lower_case) {
  return std::equal(
      token.begin(), token.end(), lower_case.begin(), lower_case.end(),
      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void expect(TextScanner& in, std::string_view word) {
  const std::string_view token = in.token();
  if (token.empty()) in.fail("the file is cut short");
  if (!is_word(token, word)) {
    in.fail(in_quotes(word) + " expected, found " + in_quotes(token));
  }
}

// From after "facet" to "endfacet".
void read_facet(TextScanner& in, TriangleMesh& mesh) {
  expect(in, "normal");
  for (int i = 0; i < 3; ++i) in.token();  // not used; some writers put "nan" there
  expect(in, "outer");
  expect(in, "loop");
  std::vector<std::int64_t> corners;
  std::string_view token = in.token();
  for (; is_word(token, "vertex"); token = in.token()) {
    corners.push_back(static_cast<std::int64_t>(mesh.vertices.size()));
    add_vertex(in, mesh);
  }
  if (token.empty()) in.fail("the file is cut short");
  if (!is_word(token, "endloop")) in.fail("'endloop' expected");
  expect(in, "endfacet");
  if (corners.size() < 3) in.fail("a facet with fewer than three vertices");
  add_polygon(mesh, corners, mesh.vertices.size(), in.subject());
}

// Passes over the name of a solid, which ends with the line or where a facet begins; whether one
// does. Then what follows is what follows "facet".
bool skip_name(TextScanner& in) {
  for (std::string_view word = in.token_on_line(); !word.empty(); word = in.token_on_line()) {
    if (!is_word(word, "facet")) continue;
    const std::size_t after = in.position();
    const bool begins = is_word(in.token(), "normal");
    in.seek(after);
    if (begins) return true;
  }
  return false;
}

TriangleMesh read_text(std::string_view text, const std::string& subject) {
  TextScanner in(text, subject);
  TriangleMesh mesh;
  for (std::string_view solid = in.token(); !solid.empty(); solid = in.token()) {
    if (!is_word(solid, "solid")) in.fail("'solid' expected");
    if (skip_name(in)) read_facet(in, mesh);
    std::string_view token = in.token();
    for (; is_word(token, "facet"); token = in.token()) read_facet(in, mesh);
    if (token.empty()) in.fail("the file is cut short: 'endsolid' is missing");
    if (!is_word(token, "endsolid")) in.fail("'facet' or 'endsolid' expected");
    if (skip_name(in)) in.fail("a facet in the line of 'endsolid'");
  }
  charge_decimals(mesh);
  return mesh;
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
  charge_decimals(mesh);
  return mesh;
}

TriangleMesh read_off(std::string_view bytes, const std::string& subject) {
  TextScanner in(bytes, subject, {.comment = '#'});
  const std::string_view keyword = in.token();
  // Texture coordinates, colours and normals follow the coordinates and are skipped.
  constexpr std::array<std::string_view, 8> kKeywords = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                         "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
  if (std::ranges::find(kKeywords, keyword) == kKeywords.end())
    in.fail("not an OFF file of three dimensions in text form");
  const std::size_t vertices = read_count(in, bytes.size());
  const std::size_t faces = read_count(in, bytes.size());
  in.skip_line();  // the number of edges

  TriangleMesh mesh;
  mesh.vertices.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    add_vertex(in, mesh);
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
  charge_decimals(mesh);
  return mesh;
}

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
  if (data.is_text()) charge_decimals(mesh);
  return mesh;
}

TriangleMesh read_stl(std::string_view bytes, const std::string& subject) {
  if (has_size_of_binary(bytes)) return read_binary(bytes, subject);
  const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), bytes.size());
  const bool looks_like_text = is_word(bytes.substr(begin, 5), "solid") &&
                               bytes.substr(0, 512).find('\0') == std::string_view::npos;
  if (looks_like_text) return read_text(bytes, subject);
  if (bytes.size() < kDataStart) throw Error(subject, "not an STL file");
  throw Error(subject,
              "not an STL file, or cut short: as a binary one it would hold " +
                  std::to_string(facet_count(bytes)) + " triangles in " +
                  std::to_string(kDataStart + kFacetBytes * std::size_t{facet_count(bytes)}) +
                  " bytes, but it has " + std::to_string(bytes.size()));
}

}  // namespace spherule::internal
