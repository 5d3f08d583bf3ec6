// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "base/text_scanner.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <limits>
#include <vector>

namespace spherule::internal {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kDataStart = kHeaderBytes + 4;
constexpr std::size_t kFacetBytes = 50;  // normal, three corners, two bytes of attributes

static_assert(std::endian::native == std::endian::little, "binary files are read as they stand");

std::uint32_t facet_count(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes, sizeof count);
  return count;
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
    float numbers[12];  // the normal first
    std::memcpy(numbers, bytes.data() + kDataStart + i * kFacetBytes, sizeof numbers);
    for (int k = 3; k < 12; k += 3) {
      mesh.vertices.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
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
    const double x = in.number(), y = in.number(), z = in.number();
    mesh.vertices.emplace_back(x, y, z);
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
  mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
  return mesh;
}

}  // namespace

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
