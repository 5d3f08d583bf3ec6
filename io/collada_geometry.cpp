// SPDX-License-Identifier: BSD-3-Clause
#include "io/collada_geometry.h"

#include "base/rounding.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace spherule::internal {
namespace {

using Element = ColladaDocument::Element;

class MeshReader {
 public:
  MeshReader(const ColladaDocument& document, const Element& mesh, const std::string& subject)
      : document_(document), subject_(subject) {
    const Element& vertices = document.child(mesh, "vertices");
    const Element* const positions = collada_input(vertices, "POSITION");
    if (positions == nullptr) document.fail(vertices, "has no positions");
    const ColladaValues values =
        collada_values(document, document.referred("source", *positions, "source"), 3);
    for (std::size_t i = 0; i < values.numbers.size(); i += 3) {
      mesh_.vertices.emplace_back(values.numbers[i], values.numbers[i + 1], values.numbers[i + 2]);
    }
    mesh_.vertex_error = rounding_distance(largest_coordinate(mesh_), kUnitRoundoff);
    vertices_id_ = document.text_attribute(vertices, "id");
    for (const Element* at = mesh.FirstChildElement(); at != nullptr;
         at = at->NextSiblingElement()) {
      add(*at);
    }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  void add(const Element& primitive) {
    const std::string_view name = primitive.Name();
    if (name == "triangles") {
      add_triangles(primitive);
    } else if (name == "polylist") {
      add_polylist(primitive);
    } else if (name == "polygons" || name == "tristrips" || name == "trifans") {
      if (primitive.FirstChildElement("ph") != nullptr) {
        document_.fail(primitive, "has a polygon with holes, which is not supported");
      }
      const Layout layout = layout_of(primitive);
      for (const Element* p = primitive.FirstChildElement("p"); p != nullptr;
           p = p->NextSiblingElement("p")) {
        const std::vector<std::int64_t> corners = corners_of(*p, layout);
        name == "polygons" ? polygon(corners) : strip(corners, name == "trifans");
      }
    } else if (name != "source" && name != "vertices" && name != "lines" && name != "linestrips" &&
               name != "extra") {
      document_.fail(primitive, "is a shape that is not supported");
    }
  }

  // Of the indices of a corner: how many they are, and which is that of the vertex.
  struct Layout {
    std::size_t stride = 0;
    std::size_t vertex = 0;
  };

  Layout layout_of(const Element& primitive) const {
    constexpr std::size_t kMaxOffset = 255;
    Layout result;
    const Element* vertex = nullptr;
    for (const Element* input = primitive.FirstChildElement("input"); input != nullptr;
         input = input->NextSiblingElement("input")) {
      const std::size_t offset = document_.whole_attribute(*input, "offset", kMaxOffset + 1);
      if (offset > kMaxOffset) document_.fail(*input, "has no usable offset");
      result.stride = std::max(result.stride, offset + 1);
      if (document_.text_attribute(*input, "semantic") != "VERTEX") continue;
      if (vertex != nullptr) document_.fail(*input, "is the second one of vertices");
      if (document_.text_attribute(*input, "source") != "#" + vertices_id_) {
        document_.fail(*input, "refers to vertices of another mesh");
      }
      vertex = input;
      result.vertex = offset;
    }
    if (vertex == nullptr) document_.fail(primitive, "has no vertices");
    return result;
  }

  std::vector<std::int64_t> corners_of(const Element& p, const Layout& layout) const {
    const std::vector<std::int64_t> indices = document_.whole_numbers(p);
    if (indices.size() % layout.stride != 0) document_.fail(p, "ends within a corner");
    std::vector<std::int64_t> corners;
    corners.reserve(indices.size() / layout.stride);
    for (std::size_t i = layout.vertex; i < indices.size(); i += layout.stride) {
      corners.push_back(indices[i]);
    }
    return corners;
  }

  // The corners of the one list of a primitive, none if it has no list.
  std::vector<std::int64_t> all_corners(const Element& primitive) const {
    if (primitive.FirstChildElement("p") == nullptr) return {};
    return corners_of(document_.child(primitive, "p"), layout_of(primitive));
  }

  void add_triangles(const Element& triangles) {
    const std::vector<std::int64_t> corners = all_corners(triangles);
    const std::size_t count = document_.whole_attribute(triangles, "count", corners.size() / 3);
    if (corners.size() != 3 * count) {
      document_.fail(triangles, "has other indices than its count of triangles needs");
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) polygon(std::span(corners).subspan(i, 3));
  }

  void add_polylist(const Element& list) {
    const std::vector<std::int64_t> corners = all_corners(list);
    std::vector<std::int64_t> counts;
    if (list.FirstChildElement("vcount") != nullptr) {
      counts = document_.whole_numbers(document_.child(list, "vcount"));
    }
    std::size_t at = 0;
    for (const std::int64_t count : counts) {
      if (count < 0 || static_cast<std::uint64_t>(count) > corners.size() - at) {
        document_.fail(list, "has fewer indices than its polygons need");
      }
      polygon(std::span(corners).subspan(at, static_cast<std::size_t>(count)));
      at += static_cast<std::size_t>(count);
    }
    if (at != corners.size()) document_.fail(list, "has more indices than its polygons need");
  }

  void polygon(std::span<const std::int64_t> corners) {
    add_polygon(mesh_, corners, mesh_.vertices.size(), subject_);
  }

  void strip(const std::vector<std::int64_t>& corners, bool is_fan) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      polygon(is_fan ? std::array{corners[0], corners[i - 1], corners[i]}
                     : strip_triangle(corners, i));
    }
  }

  const ColladaDocument& document_;
  const std::string& subject_;
  std::string vertices_id_;
  TriangleMesh mesh_;
};

}  // namespace

const Element* collada_input(const Element& parent, const char* semantic) {
  for (const Element* input = parent.FirstChildElement("input"); input != nullptr;
       input = input->NextSiblingElement("input")) {
    const char* const of = input->Attribute("semantic");
    if (of != nullptr && std::string_view(of) == semantic) return input;
  }
  return nullptr;
}

// Parameters without a name are passed over; the numbers are those of the others, in order. An
// accessor of matrices has one parameter of sixteen numbers.
ColladaValues collada_values(const ColladaDocument& document, const Element& source,
                             std::size_t components) {
  const Element& accessor = document.child(document.child(source, "technique_common"), "accessor");
  const Element& array = document.referred("float_array", accessor, "source");
  const std::vector<double> values = document.numbers(array);
  if (document.whole_attribute(array, "count", values.size()) != values.size()) {
    document.fail(array, "does not hold as many numbers as it says");
  }
  std::vector<std::size_t> picked;
  std::size_t width = 0;
  for (const Element* param : document.children(accessor, "param")) {
    const char* const type = param->Attribute("type");
    const bool is_matrix = type != nullptr && std::string_view(type) == "float4x4";
    const std::size_t size = is_matrix ? 16 : 1;
    const bool is_named = param->Attribute("name") != nullptr || is_matrix;
    for (std::size_t k = 0; k < size && is_named; ++k) picked.push_back(width + k);
    width += size;
  }
  if (picked.size() != components) {
    document.fail(accessor, "picks " + std::to_string(picked.size()) + " numbers, not " +
                                std::to_string(components));
  }
  const std::size_t count = document.whole_attribute(accessor, "count", 0);
  const std::size_t stride = document.whole_attribute(accessor, "stride", 1);
  const std::size_t offset = document.whole_attribute(accessor, "offset", 0);
  // The attributes are below 2^32, so that no product overflows.
  if (stride < width || (count > 0 && (offset > values.size() ||
                                       (count - 1) * stride + width > values.size() - offset))) {
    document.fail(accessor, "reaches beyond its array");
  }
  ColladaValues result{.numbers = {}, .components = components};
  result.numbers.reserve(count * components);
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::size_t k : picked) result.numbers.push_back(values[offset + i * stride + k]);
  }
  return result;
}

TriangleMesh collada_mesh(const ColladaDocument& document, const Element& geometry,
                          const std::string& subject) {
  for (const char* shape : {"convex_mesh", "brep"}) {
    if (const Element* const found = geometry.FirstChildElement(shape)) {
      document.fail(*found, "is a shape that is not supported");
    }
  }
  if (geometry.FirstChildElement("mesh") == nullptr) return {};  // a spline has no surface
  return MeshReader(document, document.child(geometry, "mesh"), subject).take();
}

}  // namespace spherule::internal
