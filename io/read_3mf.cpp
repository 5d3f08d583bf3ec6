// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "base/text_scanner.h"
#include "io/length_unit.h"
#include "io/mesh_readers.h"
#include "io/placed_part.h"
#include "io/scene_budget.h"
#include "io/xml_events.h"
#include "io/zip_member.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The 3MF core specification 1.3: a ZIP archive with XML inside, of objects that are meshes or are
// put together from objects before them, and of build items that show objects.

namespace spherule::internal {
namespace {

constexpr std::string_view kCore("http://schemas.microsoft.com/3dmanufacturing/core/2015/02|");
constexpr std::string_view kRelation(
    "http://schemas.openxmlformats.org/package/2006/relationships|Relationship");
constexpr std::string_view kModelType(
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel");
// Moves an object to another file of the package.
constexpr std::string_view kPath(
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06|path");
// Names sets of triangles of the mesh, and adds none.
constexpr std::string_view kTriangleSets(
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07|");

constexpr int kMaxComponentDepth = 64;

struct Component {
  const struct Object* object;
  std::optional<Affine> transform;
};

struct Object {
  TriangleMesh mesh;
  std::vector<Component> components;
  int depth = 0;  // of components below
};

// Finds the part that holds the model in the relations of the package.
class RootFinder : public XmlHandler {
 public:
  void open(std::string_view name, const XmlAttributes& attributes, std::size_t) override {
    if (name != kRelation || attributes.find("Type") != kModelType) return;
    if (target.empty()) target = attributes.find("Target").value_or("");
  }
  void close() override {}

  std::string target;
};

// Reads the unit at the root of a model, and no further.
class UnitFinder : public XmlHandler {
 public:
  struct Done {};

  void open(std::string_view, const XmlAttributes& attributes, std::size_t) override {
    unit = attributes.find("unit").value_or("millimeter");
    throw Done();
  }
  void close() override {}

  std::string unit;
};

std::string model_text(std::string_view bytes, const std::string& subject) {
  RootFinder root;
  parse_xml(read_zip_member(bytes, "_rels/.rels", subject), subject, root);
  // Absolute or relative to the root of the package, which is the same here.
  if (root.target.starts_with('/')) root.target.erase(0, 1);
  while (root.target.starts_with("./")) root.target.erase(0, 2);
  if (root.target.empty()) throw Error(subject, "the package names no 3MF model");
  return read_zip_member(bytes, root.target, subject);
}

class ModelReader : public XmlHandler {
 public:
  ModelReader(std::string_view text, const std::string& subject)
      : in_(text, subject), subject_(subject), budget_(subject, 0) {}

  void open(std::string_view name, const XmlAttributes& attributes, std::size_t position) override {
    in_.seek(position);
    path_.emplace_back(name.starts_with(kCore) ? name.substr(kCore.size()) : name);
    if (path_.size() == 1) {
      begin_model(attributes);
    } else if (at({"model", "resources", "object"})) {
      begin_object(attributes);
    } else if (at({"model", "resources", "object", "mesh", "vertices", "vertex"})) {
      object_->mesh.vertices.emplace_back(number(attributes, "x"), number(attributes, "y"),
                                          number(attributes, "z"));
    } else if (at({"model", "resources", "object", "mesh", "triangles", "triangle"})) {
      triangles_.push_back(
          {integer(attributes, "v1"), integer(attributes, "v2"), integer(attributes, "v3")});
    } else if (at({"model", "resources", "object", "components", "component"})) {
      object_->components.push_back(component(attributes));
    } else if (at({"model", "build", "item"})) {
      items_.push_back(component(attributes));
    } else {
      check_shape(name);
    }
  }

  void close() override {
    if (at({"model", "resources", "object"})) end_object();
    path_.pop_back();
  }

  // Components of components may multiply without bound; what they show may not.
  TriangleMesh shown() {
    TriangleMesh result;
    std::vector<Affine> chain;
    for (const Component& item : items_) show(item, chain, result);
    return result;
  }

 private:
  bool at(std::initializer_list<std::string_view> path) const {
    return std::equal(path_.begin(), path_.end(), path.begin(), path.end());
  }

  // XML Schema lets a number have blanks around it, and a plus sign.
  std::string_view required(const XmlAttributes& attributes, std::string_view name) const {
    const std::optional<std::string_view> value = attributes.find(name);
    if (!value) in_.fail("there is no attribute " + in_quotes(name));
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = std::min(value->find_first_not_of(kBlanks), value->size());
    return value->substr(begin, value->find_last_not_of(kBlanks) + 1 - begin);
  }

  std::int64_t integer(const XmlAttributes& attributes, std::string_view name) const {
    std::string_view text = required(attributes, name);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    return in_.integer(text);
  }

  double number(const XmlAttributes& attributes, std::string_view name) const {
    return in_.number(required(attributes, name));
  }

  void begin_model(const XmlAttributes& attributes) const {
    if (path_[0] != "model") in_.fail("not a 3MF model");
    const std::string_view extensions = attributes.find("requiredextensions").value_or("");
    if (!extensions.empty()) {
      in_.fail("it requires extensions, which are not supported: " + in_quotes(extensions));
    }
  }

  void begin_object(const XmlAttributes& attributes) {
    const std::int64_t id = integer(attributes, "id");
    const auto [entry, is_new] = objects_.try_emplace(id);
    if (!is_new) in_.fail("object " + std::to_string(id) + " is there twice");
    object_ = &entry->second;
    open_id_ = id;
    triangles_.clear();
  }

  void end_object() {
    TriangleMesh& mesh = object_->mesh;
    for (const auto& corners : triangles_) {
      add_polygon(mesh, corners, mesh.vertices.size(), subject_);
    }
    for (const Component& part : object_->components) {
      object_->depth = std::max(object_->depth, part.object->depth + 1);
    }
    if (object_->depth > kMaxComponentDepth) in_.fail("components more than 64 deep");
    open_id_.reset();
  }

  Component component(const XmlAttributes& attributes) const {
    if (attributes.find(kPath)) in_.fail("an object in another part is not supported");
    const std::int64_t id = integer(attributes, "objectid");
    const auto object = objects_.find(id);
    if (object == objects_.end() || id == open_id_) {
      in_.fail("it shows object " + std::to_string(id) + ", which is not there before");
    }
    const std::optional<std::string_view> text = attributes.find("transform");
    return {&object->second, text ? std::optional(transform(*text)) : std::nullopt};
  }

  // Twelve numbers: the rows of a matrix that points, as rows, are multiplied by from the left.
  Affine transform(std::string_view text) const {
    TextScanner list(text, subject_);
    Eigen::Matrix3d linear;
    Eigen::Vector3d offset;
    for (int row = 0; row < 4; ++row) {
      for (int k = 0; k < 3; ++k) {
        const double entry = in_.number(list.token());
        if (std::abs(entry) > kMaxCoordinate) in_.fail("a transform beyond 1e15");
        (row < 3 ? linear(k, row) : offset[k]) = entry;
      }
    }
    if (!list.token().empty()) in_.fail("a transform of more than twelve numbers");
    return {linear, offset};
  }

  // An object may have shapes that are no mesh, and a mesh more than triangles: to leave them out
  // would lose surface.
  void check_shape(std::string_view name) const {
    constexpr std::string_view kKnown[] = {"mesh", "components", "metadatagroup", "vertices",
                                           "triangles"};
    const bool in_object = path_.size() == 4 && path_[2] == "object";
    const bool in_mesh = path_.size() == 5 && path_[2] == "object" && path_[3] == "mesh";
    if (!in_object && !in_mesh) return;
    if (name.starts_with(kTriangleSets)) return;
    if (std::ranges::find(kKnown, path_.back()) == std::end(kKnown)) {
      in_.fail("a shape that is not supported: " + in_quotes(path_.back()));
    }
  }

  void show(const Component& shown, std::vector<Affine>& chain, TriangleMesh& result) {
    budget_.take_node();
    if (shown.transform) chain.push_back(*shown.transform);
    budget_.take(shown.object->mesh);
    budget_.take_moves(shown.object->mesh.vertices.size(), chain.size());
    TriangleMesh part = shown.object->mesh;
    place(part, chain, kUnitRoundoff, kUnitRoundoff);
    append(result, part, subject_);
    for (const Component& inner : shown.object->components) show(inner, chain, result);
    if (shown.transform) chain.pop_back();
  }

  TextScanner in_;  // parses numbers, and knows the line
  const std::string& subject_;
  std::vector<std::string> path_;  // names of the open elements, the core namespace left out
  std::map<std::int64_t, Object> objects_;
  std::optional<std::int64_t> open_id_;  // of an object that does not count as there yet
  Object* object_ = nullptr;             // that is open, or was last
  std::vector<std::array<std::int64_t, 3>> triangles_;  // of it: vertices may come after them
  std::vector<Component> items_;
  SceneBudget budget_;
};

}  // namespace

TriangleMesh read_3mf(std::string_view bytes, const std::string& subject) {
  const std::string text = model_text(bytes, subject);
  ModelReader model(text, subject);
  parse_xml(text, subject, model);
  return model.shown();
}

double unit_of_3mf(std::string_view bytes, const std::string& subject) {
  UnitFinder finder;
  try {
    parse_xml(model_text(bytes, subject), subject, finder);
  } catch (const UnitFinder::Done&) {
  }
  const LengthUnit* const unit = unit_named(finder.unit);
  if (unit == nullptr) throw Error(subject, "states a unit that is not known: " + finder.unit);
  return unit->micrometres;
}

}  // namespace spherule::internal
