// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "geometry/vertex_rounding.h"
#include "io/mesh_readers.h"
#include "io/placement.h"
#include "io/polygon_triangles.h"
#include "io/xml_text.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// COLLADA (Khronos, "COLLADA - Digital Asset Schema Release 1.5.0"). What stands in <extra> and
// <technique> is data of other programs, and is not looked at.

namespace spherule::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Element = tinyxml2::XMLElement;

// The entries of a transform, relative to its norms: decimals, sine and cosine of an angle of up to
// 360 degrees that is off by 2^-50, the norm of the axis, and their few products.
constexpr double kEntryError = 0x1p-45;

// Elements may be written with the prefix of the namespace.
std::string_view local_name(const Element& element) {
  const std::string_view name = element.Name();
  return name.substr(name.rfind(':') + 1);
}

// Steps of the budget for the length of a text that is copied or compared.
std::size_t steps_for(std::string_view text) {
  return text.size() / 16;
}

// The XML of the file, with checked access.
class ColladaDocument {
 public:
  // `subject` names the file in an Error; it and the budget have to outlive the document. Throws
  // Error if the text is not well-formed XML, or is not COLLADA.
  ColladaDocument(std::string_view text, const std::string& subject, SceneBudget& budget)
      : subject_(subject), budget_(budget), root_(&parse_xml(document_, text, subject)) {
    if (local_name(*root_) != "COLLADA") throw Error(subject_, "not a mesh: not COLLADA");
    index(*root_);
  }

  const Element& root() const { return *root_; }
  // Every <asset>, the document's too.
  const std::vector<const Element*>& assets() const { return assets_; }

  // The element of this name whose id a reference "#id" names. Throws Error if there is none or
  // more than one, and for a reference into another file.
  const Element& referred(const char* name, const Element& from, const char* attribute) const {
    const std::string reference = text_attribute(from, attribute);
    if (!reference.starts_with('#')) {
      fail(from, "refers to " + in_quotes(reference) + ", which is not in this file");
    }
    const std::string id = reference.substr(1);
    budget_.take_steps(steps_for(id));
    const auto it = ids_.find({name, id});
    if (it != ids_.end() && it->second != nullptr) return *it->second;
    fail(from, "refers to the " + std::string(name) + " " + in_quotes(id) + ", which is " +
                   (it == ids_.end() ? "not there" : "there several times"));
  }

  // The child elements of this name, or all. Every child, comments too, is a step of the budget.
  std::vector<const Element*> children(const Element& parent, const char* name = nullptr) const {
    std::vector<const Element*> result;
    for (auto* at = parent.FirstChild(); at != nullptr; at = at->NextSibling()) {
      budget_.take_steps(1);
      const Element* const element = at->ToElement();
      if (element == nullptr) continue;  // a comment or text
      if (name == nullptr || std::string_view(element->Name()) == name) result.push_back(element);
    }
    return result;
  }

  // The only child of this name, which has to be there.
  const Element& child(const Element& parent, const char* name) const {
    const std::vector<const Element*> found = children(parent, name);
    if (found.empty()) fail(parent, "has no <" + std::string(name) + ">");
    if (found.size() > 1) fail(parent, "has more than one <" + std::string(name) + ">");
    return *found.front();
  }

  std::string text_attribute(const Element& element, const char* name) const {
    const char* const text = element.Attribute(name);
    if (text == nullptr) fail(element, "has no attribute " + in_quotes(name));
    budget_.take_steps(steps_for(text));
    return text;
  }

  // A whole number that is not negative, `absent` if there is no such attribute.
  std::size_t whole_attribute(const Element& element, const char* name, std::size_t absent) const {
    const char* const text = element.Attribute(name);
    if (text == nullptr) return absent;
    budget_.take_steps(steps_for(text));
    const std::optional<std::int64_t> value = whole_number(text);
    if (!value || *value < 0 || *value > std::numeric_limits<std::uint32_t>::max()) {
      fail(element, "the attribute " + in_quotes(name) + " is not a whole number below 2^32");
    }
    return static_cast<std::size_t>(*value);
  }

  // What stands in an element, nothing but white space and comments between. Each is a step of the
  // budget.
  std::vector<double> numbers(const Element& element) const {
    return values<double>(element, finite_number, "a finite number");
  }
  std::vector<std::int64_t> whole_numbers(const Element& element) const {
    return values<std::int64_t>(element, whole_number, "a whole number");
  }

  std::string text(const Element& element) const {
    std::string result;
    for (auto* at = element.FirstChild(); at != nullptr; at = at->NextSibling()) {
      budget_.take_steps(1);
      if (at->ToComment() != nullptr) {
        result += ' ';
        continue;
      }
      if (at->ToText() == nullptr) fail(element, "holds something between its numbers");
      budget_.take_steps(steps_for(at->Value()));
      result += at->Value();
    }
    return result;
  }

  // Throws Error with the line of the element.
  [[noreturn]] void fail(const Element& element, const std::string& reason) const {
    throw Error(subject_, "line " + std::to_string(element.GetLineNum()) + ": <" +
                              std::string(element.Name()) + "> " + reason);
  }

 private:
  void index(const Element& element) {
    for (const Element* at = element.FirstChildElement(); at != nullptr;
         at = at->NextSiblingElement()) {
      const std::string_view name = at->Name();
      if (name == "extra" || name == "technique") continue;
      if (local_name(*at) != name) fail(*at, "a namespace prefix is not supported");
      if (name == "asset") assets_.push_back(at);
      if (const char* id = at->Attribute("id")) {
        const auto [it, is_new] = ids_.try_emplace({at->Name(), id}, at);
        if (!is_new) it->second = nullptr;
      }
      index(*at);
    }
  }

  template <class Value, class Parse>
  std::vector<Value> values(const Element& element, const Parse& parse, const char* kind) const {
    const std::string content = text(element);
    const std::vector<std::string_view> words = words_of(content);
    budget_.take_steps(words.size());
    std::vector<Value> result;
    result.reserve(words.size());
    for (const std::string_view word : words) {
      const std::optional<Value> value = parse(word);
      if (!value) fail(element, in_quotes(word) + " is not " + kind);
      result.push_back(*value);
    }
    return result;
  }

  const std::string& subject_;
  SceneBudget& budget_;
  tinyxml2::XMLDocument document_;
  const Element* root_;
  std::vector<const Element*> assets_;
  // By name and id; null if several elements share them.
  std::map<std::pair<std::string, std::string>, const Element*> ids_;
};

// The points that the accessor of a <source> picks from its array; parameters without a name are
// passed over. An accessor that reaches beyond the array is refused.
std::vector<Vector3d> points_of(const ColladaDocument& document, const Element& source) {
  const Element& accessor = document.child(document.child(source, "technique_common"), "accessor");
  const Element& array = document.referred("float_array", accessor, "source");
  const std::vector<double> values = document.numbers(array);
  if (document.whole_attribute(array, "count", values.size()) != values.size()) {
    document.fail(array, "does not hold as many numbers as it says");
  }
  std::vector<std::size_t> picked;
  std::size_t width = 0;
  for (const Element* param : document.children(accessor, "param")) {
    if (param->Attribute("type", "float4x4") != nullptr) document.fail(*param, "is no number");
    if (param->Attribute("name") != nullptr) picked.push_back(width);
    ++width;
  }
  if (picked.size() != 3) {
    document.fail(accessor, "picks " + std::to_string(picked.size()) + " numbers, not 3");
  }
  const std::size_t count = document.whole_attribute(accessor, "count", 0);
  const std::size_t stride = document.whole_attribute(accessor, "stride", 1);
  const std::size_t offset = document.whole_attribute(accessor, "offset", 0);
  // The attributes are below 2^32, so that no product overflows.
  if (stride < width || (count > 0 && (offset > values.size() ||
                                       (count - 1) * stride + width > values.size() - offset))) {
    document.fail(accessor, "reaches beyond its array");
  }
  std::vector<Vector3d> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = offset + i * stride;
    result.emplace_back(values[at + picked[0]], values[at + picked[1]], values[at + picked[2]]);
  }
  return result;
}

// The mesh of a <geometry>: its triangles, polygons, polygon lists, strips and fans over the
// positions of its <vertices>, in their order; lines are left out. `vertex_error` charges the
// rounding of the decimals. Shapes that are no mesh and polygons with holes are refused.
class MeshReader {
 public:
  MeshReader(const ColladaDocument& document, const Element& mesh, const std::string& subject)
      : document_(document), subject_(subject) {
    const Element& vertices = document.child(mesh, "vertices");
    const Element* positions = vertices.FirstChildElement("input");
    while (positions != nullptr && positions->Attribute("semantic", "POSITION") == nullptr) {
      positions = positions->NextSiblingElement("input");
    }
    if (positions == nullptr) document.fail(vertices, "has no positions");
    mesh_.vertices = points_of(document, document.referred("source", *positions, "source"));
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

Affine transform_of(const ColladaDocument& document, const Element& element) {
  const std::string_view name = element.Name();
  const std::vector<double> numbers = document.numbers(element);
  const std::size_t needed = name == "matrix" ? 16 : name == "rotate" ? 4 : 3;
  if (numbers.size() != needed) {
    document.fail(element, "has " + std::to_string(numbers.size()) + " numbers, not " +
                               std::to_string(needed));
  }
  if (name == "matrix") {
    const std::optional<Affine> result =
        affine_from(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data()));
    if (!result) document.fail(element, "is a transform that is not affine and finite");
    return *result;
  }
  const Vector3d vector(numbers[0], numbers[1], numbers[2]);
  if (name == "translate") return {Matrix3d::Identity(), vector};
  if (name == "scale") return {Matrix3d(vector.asDiagonal()), Vector3d::Zero()};
  const double degrees = std::fmod(numbers[3], 360.0);  // exact
  if (degrees == 0.0) return {Matrix3d::Identity(), Vector3d::Zero()};
  const Vector3d axis = vector.stableNormalized();
  if (!(std::abs(axis.norm() - 1.0) < 1e-9)) document.fail(element, "has no axis");
  const Eigen::AngleAxisd turn(degrees * (std::numbers::pi / 180.0), axis);
  return {turn.toRotationMatrix(), Vector3d::Zero()};
}

// The transforms of a <node>, the first one outermost; those that are the identity are left out.
std::vector<Affine> collada_transforms(const ColladaDocument& document, const Element& node) {
  std::vector<Affine> result;
  for (const Element* at = node.FirstChildElement(); at != nullptr; at = at->NextSiblingElement()) {
    const std::string_view name = at->Name();
    if (name == "skew" || name == "lookat") document.fail(*at, "is not supported");
    if (name != "matrix" && name != "rotate" && name != "translate" && name != "scale") continue;
    const Affine made = transform_of(document, *at);
    if (made.linear != Matrix3d::Identity() || !made.offset.isZero(0.0)) result.push_back(made);
  }
  return result;
}

class ColladaReader {
 public:
  ColladaReader(std::string_view bytes, const std::string& subject)
      : subject_(subject), budget_(subject, steps_of(bytes)), document_(bytes, subject, budget_) {}

  // A number takes two bytes or more, so each can be read at least twice.
  static std::size_t steps_of(std::string_view bytes) {
    return (std::size_t{1} << 24) + bytes.size();
  }

  TriangleMesh run() {
    const double unit = metres(document_);
    if (unit != 1.0) {
      chain_.push_back(
          {Eigen::Matrix3d(unit * Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero()});
    }
    visit_children(shown_scene());
    return std::move(result_);
  }

  // What the file states of its unit. An asset of a part of the file would override it there, and
  // the axes, too: the ones that differ are refused.
  static double metres(const ColladaDocument& document) {
    const Element* const asset = document.root().FirstChildElement("asset");
    const auto stated = [&](const char* name) {
      return asset == nullptr ? nullptr : asset->FirstChildElement(name);
    };
    const double unit = metres_of(document, stated("unit"));
    const std::string axis = axis_of(document, stated("up_axis"));
    for (const Element* other : document.assets()) {
      for (const Element* at : document.children(*other)) {
        const std::string_view name = at->Name();
        if ((name == "unit" && metres_of(document, at) != unit) ||
            (name == "up_axis" && axis_of(document, at) != axis)) {
          document.fail(*at, "differs from that of the whole file, which is not supported");
        }
      }
    }
    return unit;
  }

 private:
  static double metres_of(const ColladaDocument& document, const Element* unit) {
    const char* const text = unit == nullptr ? nullptr : unit->Attribute("meter");
    if (text == nullptr) return 1.0;
    const double size = finite_number(text).value_or(0.0);
    if (!(size > 0.0 && size <= 1e15)) document.fail(*unit, "states no usable size in metres");
    return size;
  }

  static std::string axis_of(const ColladaDocument& document, const Element* axis) {
    if (axis == nullptr) return "Y_UP ";  // as words are joined below
    std::string words;
    const std::string text = document.text(*axis);
    for (const std::string_view word : words_of(text)) words.append(word).append(" ");
    return words;
  }

  const Element& shown_scene() const {
    if (const Element* const scene = document_.root().FirstChildElement("scene")) {
      return document_.referred("visual_scene", document_.child(*scene, "instance_visual_scene"),
                                "url");
    }
    const Element* const library = document_.root().FirstChildElement("library_visual_scenes");
    if (library == nullptr) document_.fail(document_.root(), "names no scene to show");
    return document_.child(*library, "visual_scene");
  }

  void visit_children(const Element& parent) {
    for (const Element* at : document_.children(parent)) {
      const std::string_view name = at->Name();
      if (name == "node") {
        visit(*at);
      } else if (name == "instance_node") {
        const Element& node = document_.referred("node", *at, "url");
        if (std::find(open_.begin(), open_.end(), &node) != open_.end()) {
          document_.fail(*at, "shows a node within itself");
        }
        visit(node);
      } else if (name == "instance_geometry") {
        TriangleMesh part = mesh_of(document_.referred("geometry", *at, "url"));
        budget_.take(part);
        budget_.take_moves(part.vertices.size(), chain_.size());
        place(part, chain_, 0.0, kEntryError);
        append(result_, part, subject_);
      } else if (name == "instance_controller") {
        document_.fail(*at, "shows a skin or morph targets, which are not supported");
      }
    }
  }

  void visit(const Element& node) {
    budget_.take_node();
    if (!may_have_surface(node)) return;
    const std::size_t before = chain_.size();
    const std::vector<Affine>& own = transforms_of(node);
    chain_.insert(chain_.end(), own.begin(), own.end());
    budget_.check_depth(chain_.size());
    open_.push_back(&node);
    budget_.check_depth(open_.size());
    visit_children(node);
    open_.pop_back();
    chain_.erase(chain_.begin() + static_cast<std::ptrdiff_t>(before), chain_.end());
  }

  // Cameras and lights have none, and their transforms do not matter.
  bool may_have_surface(const Element& node) const {
    return std::ranges::any_of(document_.children(node), [](const Element* at) {
      const std::string_view name = at->Name();
      return name == "node" || name == "instance_node" || name == "instance_geometry" ||
             name == "instance_controller";
    });
  }

  // The results of the following are kept: each element is parsed once however often it is shown.
  const TriangleMesh& mesh_of(const Element& geometry) {
    const auto [it, is_new] = meshes_.try_emplace(&geometry);
    if (is_new) it->second = collada_mesh(document_, geometry, subject_);
    return it->second;
  }

  const std::vector<Affine>& transforms_of(const Element& node) {
    const auto [it, is_new] = transforms_.try_emplace(&node);
    if (is_new) it->second = collada_transforms(document_, node);
    return it->second;
  }

  const std::string& subject_;
  SceneBudget budget_;
  ColladaDocument document_;
  std::vector<const Element*> open_;  // nodes
  std::vector<Affine> chain_;
  std::map<const Element*, TriangleMesh> meshes_;
  std::map<const Element*, std::vector<Affine>> transforms_;
  TriangleMesh result_;
};

}  // namespace

TriangleMesh read_collada(std::string_view bytes, const std::string& subject) {
  return ColladaReader(bytes, subject).run();
}

double collada_unit(std::string_view text, const std::string& subject) {
  SceneBudget budget(subject, ColladaReader::steps_of(text));
  return ColladaReader::metres(ColladaDocument(text, subject, budget));
}

}  // namespace spherule::internal
