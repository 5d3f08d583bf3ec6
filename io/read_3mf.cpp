// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "io/mesh_io.h"
#include "io/mesh_readers.h"
#include "io/placement.h"
#include "io/polygon_triangles.h"
#include "io/xml_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <zlib.h>

// The 3MF core specification 1.3: a ZIP archive with XML inside, of objects that are meshes or are
// put together from objects before them, and of build items that show objects.

namespace spherule::internal {
namespace {

using Element = tinyxml2::XMLElement;

// No member of an archive may unpack to more than this.
constexpr std::size_t kMaxMemberSize = std::size_t{1} << 29;
// Of an XML part, whose parser needs some hundred bytes for each: in all, and for each byte of the
// archive, so that a small archive takes no more than it would unpacked.
constexpr std::size_t kMaxTags = std::size_t{1} << 25, kTagsOfByte = 16, kFewTags = 1 << 20;

// Layout and values of the ZIP application note (APPNOTE 6.3).
constexpr std::string_view kLocalMark("PK\3\4"), kEntryMark("PK\1\2"), kEndMark("PK\5\6"),
    kEnd64Mark("PK\6\6"), kLocator64Mark("PK\6\7");
constexpr std::size_t kLocalSize = 30, kEntrySize = 46, kEndSize = 22, kEnd64Size = 56,
                      kLocator64Size = 20, kMaxCommentSize = 0xFFFF;
constexpr std::uint64_t kIn64 = 0xFFFFFFFF;  // in a field of 32 bits: see the ZIP64 record
constexpr std::uint64_t kStored = 0, kDeflated = 8;
// Deflate cannot do better than 258 bytes for two bits.
constexpr std::uint64_t kMaxRatio = 1032;

struct Entry {
  std::uint64_t flags = 0, method = 0, checksum = 0, packed = 0, size = 0, offset = 0;
};

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

class Archive {
 public:
  Archive(std::string_view bytes, const std::string& subject) : bytes_(bytes), subject_(subject) {}

  Entry find(std::string_view name) const {
    std::optional<Entry> found;
    const auto [begin, count] = directory();
    std::uint64_t at = begin;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (part(at, kEntrySize).substr(0, 4) != kEntryMark) fail("its directory is damaged");
      const std::uint64_t name_size = field(at + 28, 2), extra_size = field(at + 30, 2);
      const std::uint64_t extra_at = at + kEntrySize + name_size;
      if (same_name(part(at + kEntrySize, name_size), name)) {
        if (found) fail("it holds " + std::string(name) + " twice");
        found = entry(at, extra_at, extra_at + extra_size);
      }
      at = extra_at + extra_size + field(at + 32, 2);
    }
    if (!found) fail("it holds no " + std::string(name));
    return *found;
  }

  std::string content(const Entry& entry) const {
    if (entry.flags & 1) fail("it is encrypted");
    if (part(entry.offset, kLocalSize).substr(0, 4) != kLocalMark) fail("it is damaged");
    const std::uint64_t skipped = field(entry.offset + 26, 2) + field(entry.offset + 28, 2);
    const std::string_view packed = part(entry.offset + kLocalSize + skipped, entry.packed);
    if (entry.size > kMaxMemberSize || entry.packed > kMaxMemberSize) {
      fail("a part of it is larger than 2^29 bytes");
    }
    std::string result;
    if (entry.method == kStored) {
      result = packed;
    } else if (entry.method == kDeflated) {
      result = inflated(packed, entry.size);
    } else {
      fail("it is packed by method " + std::to_string(entry.method) + ", not by deflate");
    }
    if (result.size() != entry.size || crc_of(result) != entry.checksum) {
      fail("it is damaged: a checksum or a size is wrong");
    }
    return result;
  }

 private:
  struct Directory {
    std::uint64_t begin, count;
  };

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(subject_, "not a readable ZIP archive: " + reason);
  }

  std::string_view part(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) fail("it is cut short or damaged");
    return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
  }

  // A little-endian number.
  std::uint64_t field(std::uint64_t at, std::size_t size) const {
    std::uint64_t value = 0;
    const std::string_view image = part(at, size);
    for (std::size_t i = size; i-- > 0;) {
      value = value << 8 | static_cast<unsigned char>(image[i]);
    }
    return value;
  }

  // By the end record, which only a comment may follow.
  Directory directory() const {
    const std::size_t tail = bytes_.size() - std::min(bytes_.size(), kEndSize + kMaxCommentSize);
    for (std::size_t at = bytes_.rfind(kEndMark); at != std::string_view::npos && at >= tail;
         at = at == 0 ? std::string_view::npos : bytes_.rfind(kEndMark, at - 1)) {
      if (bytes_.size() - at < kEndSize || at + kEndSize + field(at + 20, 2) != bytes_.size()) {
        continue;
      }
      if (at >= kLocator64Size && bytes_.substr(at - kLocator64Size, 4) == kLocator64Mark) {
        const std::uint64_t end = field(at - kLocator64Size + 8, 8);
        if (part(end, kEnd64Size).substr(0, 4) != kEnd64Mark) fail("its directory is damaged");
        return {field(end + 48, 8), field(end + 32, 8)};
      }
      return {field(at + 16, 4), field(at + 10, 2)};
    }
    fail("it has no end record");
  }

  Entry entry(std::uint64_t at, std::uint64_t extra, std::uint64_t extra_end) const {
    Entry result{field(at + 8, 2),  field(at + 10, 2), field(at + 16, 4),
                 field(at + 20, 4), field(at + 24, 4), field(at + 42, 4)};
    // The ZIP64 record among the extra fields holds those numbers, in this order, that did not fit.
    constexpr std::uint64_t kZip64 = 1;
    while (extra + 4 <= extra_end && field(extra, 2) != kZip64) extra += 4 + field(extra + 2, 2);
    extra += 4;
    for (std::uint64_t* number : {&result.size, &result.packed, &result.offset}) {
      if (*number != kIn64) continue;
      if (extra + 8 > extra_end) fail("its directory is damaged");
      *number = field(extra, 8);
      extra += 8;
    }
    return result;
  }

  std::string inflated(std::string_view packed, std::uint64_t size) const {
    if (size / kMaxRatio > packed.size()) fail("it is damaged: a size is wrong");
    // One byte more than declared, so that a longer content shows.
    std::string result(static_cast<std::size_t>(size) + 1, '\0');
    z_stream stream{};
    constexpr int kRawDeflate = -15;
    if (inflateInit2(&stream, kRawDeflate) != Z_OK) fail("there is not enough memory");
    // zlib takes its input as not constant, and does not change it.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    stream.avail_in = static_cast<uInt>(packed.size());
    const int outcome = inflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    inflateEnd(&stream);
    if (outcome != Z_STREAM_END) fail("it is damaged: a part cannot be unpacked");
    return result;
  }

  static std::uint64_t crc_of(const std::string& bytes) {
    return ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  }

  std::string_view bytes_;
  const std::string& subject_;
};

// The content of one file of a ZIP archive (ZIP64 too; stored or deflated). Upper and lower case of
// ASCII letters in `name` are one, as in the names of OPC packages. The size that the archive
// declares is believed only as far as the packed bytes can yield it, and the checksum must be
// right. Throws Error: not an archive, no such member or several, encrypted, packed in another way,
// damaged, too large.
std::string read_zip_member(std::string_view archive, std::string_view name,
                            const std::string& subject) {
  const Archive opened(archive, subject);
  return opened.content(opened.find(name));
}

// The document of an XML part of the package.
class XmlPart {
 public:
  XmlPart(std::string_view archive, std::string_view name, const std::string& subject)
      : root_(&parse_xml(document_, text(archive, name, subject), subject)) {}

  const Element& root() const { return *root_; }

 private:
  static std::string text(std::string_view archive, std::string_view name,
                          const std::string& subject) {
    std::string text = read_zip_member(archive, name, subject);
    const auto tags = static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return c == '<' || c == '='; }));
    if (tags > std::min(kMaxTags, kFewTags + kTagsOfByte * archive.size())) {
      throw Error(subject, "XML of too many tags and attributes");
    }
    return text;
  }

  tinyxml2::XMLDocument document_;
  const Element* root_;
};

constexpr std::string_view kCore("http://schemas.microsoft.com/3dmanufacturing/core/2015/02");
constexpr std::string_view kRelations(
    "http://schemas.openxmlformats.org/package/2006/relationships");
constexpr std::string_view kModelType(
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel");
// Its attribute `path` moves an object to another file of the package.
constexpr std::string_view kProduction(
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06");
// Names sets of triangles of the mesh, and adds none.
constexpr std::string_view kTriangleSets(
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07");

constexpr int kMaxComponentDepth = 64;

struct Name {
  std::string_view space;  // empty: none
  std::string_view local;

  // Whether it is this one of the core specification, or has no namespace.
  bool is(std::string_view core) const {
    return local == core && (space.empty() || space == kCore);
  }
};

// An XML part whose elements and attributes have names within namespaces.
class NamedXml {
 public:
  explicit NamedXml(const std::string& subject) : subject_(subject) {}

  // Calls `visit` with the name of the element, and it, while the prefixes that it defines hold.
  template <class Visit>
  void enter(const Element& element, const Visit& visit) {
    std::vector<std::string_view> defined;
    for (const auto* at = element.FirstAttribute(); at != nullptr; at = at->Next()) {
      const std::string_view name = at->Name();
      if (name != "xmlns" && !name.starts_with("xmlns:")) continue;
      defined.push_back(name.substr(std::min<std::size_t>(name.size(), 6)));
      spaces_[defined.back()].push_back(at->Value());
    }
    visit(resolved(element, element.Name(), true), element);
    for (const std::string_view prefix : defined) spaces_[prefix].pop_back();
  }

  template <class Visit>
  void enter_children(const Element& parent, const Visit& visit) {
    for (const Element* at = parent.FirstChildElement(); at != nullptr;
         at = at->NextSiblingElement()) {
      enter(*at, visit);
    }
  }

  bool has_attribute(const Element& element, std::string_view space, std::string_view local) {
    for (const auto* at = element.FirstAttribute(); at != nullptr; at = at->Next()) {
      const Name name = resolved(element, at->Name(), false);
      if (name.space == space && name.local == local) return true;
    }
    return false;
  }

  [[noreturn]] void fail(const Element& element, const std::string& reason) const {
    throw Error(subject_, "line " + std::to_string(element.GetLineNum()) + ": " + reason);
  }

 private:
  Name resolved(const Element& element, std::string_view name, bool is_element) const {
    const std::size_t colon = name.find(':');
    const bool has_prefix = colon != std::string_view::npos;
    if (!has_prefix && !is_element) return {{}, name};
    const std::string_view prefix = has_prefix ? name.substr(0, colon) : std::string_view();
    const std::string_view local = has_prefix ? name.substr(colon + 1) : name;
    if (prefix == "xml" || prefix == "xmlns") return {prefix, local};
    const auto found = spaces_.find(prefix);
    if (found != spaces_.end() && !found->second.empty()) return {found->second.back(), local};
    if (has_prefix) fail(element, "a prefix without a namespace: " + in_quotes(prefix));
    return {{}, local};
  }

  const std::string& subject_;
  // Of each prefix, empty for names without one, the namespaces that hold; the last one counts.
  std::map<std::string_view, std::vector<std::string_view>> spaces_;
};

// The name of the part that holds the model, by the relations of the package.
std::string model_name(std::string_view bytes, const std::string& subject) {
  const XmlPart relations(bytes, "_rels/.rels", subject);
  std::string target;
  NamedXml xml(subject);
  xml.enter(relations.root(), [&](const Name&, const Element& root) {
    xml.enter_children(root, [&](const Name& name, const Element& relation) {
      const char* const found = relation.Attribute("Target");
      const bool is_model = name.space == kRelations && name.local == "Relationship" &&
                            relation.Attribute("Type", kModelType.data()) != nullptr;
      if (is_model && target.empty() && found != nullptr) target = found;
    });
  });
  // Absolute or relative to the root of the package, which is the same here.
  if (target.starts_with('/')) target.erase(0, 1);
  while (target.starts_with("./")) target.erase(0, 2);
  if (target.empty()) throw Error(subject, "the package names no 3MF model");
  return target;
}

struct Component {
  const struct Object* object;
  std::optional<Affine> transform;
};

struct Object {
  TriangleMesh mesh;
  std::vector<Component> components;
  int depth = 0;  // of components below
};

class ModelReader {
 public:
  explicit ModelReader(const std::string& subject)
      : subject_(subject), xml_(subject), budget_(subject, 0) {}

  // Components of components may multiply without bound; what they show may not.
  TriangleMesh run(const Element& root) {
    xml_.enter(root, [&](const Name& name, const Element& model) { read_model(name, model); });
    TriangleMesh result;
    std::vector<Affine> chain;
    for (const Component& item : items_) show(item, chain, result);
    return result;
  }

 private:
  void read_model(const Name& name, const Element& model) {
    if (!name.is("model")) xml_.fail(model, "not a 3MF model");
    const char* const extensions = model.Attribute("requiredextensions");
    if (extensions != nullptr && *extensions != '\0') {
      xml_.fail(model, "it requires extensions, which are not supported: " + in_quotes(extensions));
    }
    xml_.enter_children(model, [&](const Name& part_name, const Element& part) {
      xml_.enter_children(part, [&](const Name& entry_name, const Element& entry) {
        if (part_name.is("resources") && entry_name.is("object")) read_object(entry);
        if (part_name.is("build") && entry_name.is("item")) items_.push_back(component(entry));
      });
    });
  }

  void read_object(const Element& element) {
    const std::int64_t id = integer(element, "id");
    if (objects_.contains(id)) {
      xml_.fail(element, "object " + std::to_string(id) + " is there twice");
    }
    Object object;
    Corners corners;  // vertices may come after them
    xml_.enter_children(element, [&](const Name& name, const Element& part) {
      check_shape(name, part);
      xml_.enter_children(part, [&](const Name& list_name, const Element& list) {
        if (name.is("components") && list_name.is("component")) {
          object.components.push_back(component(list));
        } else if (name.is("mesh")) {
          check_shape(list_name, list);
          read_list(list_name, list, object.mesh, corners);
        }
      });
    });
    for (const auto& triangle : corners) {
      add_polygon(object.mesh, triangle, object.mesh.vertices.size(), subject_);
    }
    for (const Component& part : object.components) {
      object.depth = std::max(object.depth, part.object->depth + 1);
    }
    if (object.depth > kMaxComponentDepth) xml_.fail(element, "components more than 64 deep");
    objects_.emplace(id, std::move(object));
  }

  using Corners = std::vector<std::array<std::int64_t, 3>>;

  // The vertices or the triangles of a mesh.
  void read_list(const Name& name, const Element& list, TriangleMesh& mesh, Corners& corners) {
    xml_.enter_children(list, [&](const Name& item, const Element& at) {
      if (name.is("vertices") && item.is("vertex")) {
        mesh.vertices.emplace_back(number(at, "x"), number(at, "y"), number(at, "z"));
      } else if (name.is("triangles") && item.is("triangle")) {
        corners.push_back({integer(at, "v1"), integer(at, "v2"), integer(at, "v3")});
      }
    });
  }

  // An object may have shapes that are no mesh, and a mesh more than triangles: to leave them out
  // would lose surface.
  void check_shape(const Name& name, const Element& shape) const {
    if (name.space == kTriangleSets) return;
    constexpr const char* kKnown[] = {"mesh", "components", "metadatagroup", "vertices",
                                      "triangles"};
    if (std::ranges::none_of(kKnown, [&](const char* known) { return name.is(known); })) {
      xml_.fail(shape, "a shape that is not supported: " + in_quotes(shape.Name()));
    }
  }

  // XML Schema lets a number have blanks around it, and a plus sign.
  std::string_view required(const Element& element, const char* name) const {
    const char* const value = element.Attribute(name);
    if (value == nullptr) xml_.fail(element, "there is no attribute " + in_quotes(name));
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::string_view text = value;
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    if (begin == text.size()) xml_.fail(element, "a number is missing");
    return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
  }

  std::int64_t integer(const Element& element, const char* name) const {
    std::string_view text = required(element, name);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    const std::optional<std::int64_t> value = whole_number(text);
    if (!value) xml_.fail(element, in_quotes(text) + " is not a whole number");
    return *value;
  }

  double number(const Element& element, const char* name) const {
    return number_in(element, required(element, name));
  }

  double number_in(const Element& element, std::string_view text) const {
    const std::optional<double> value = finite_number(text);
    if (!value) xml_.fail(element, in_quotes(text) + " is not a finite number");
    return *value;
  }

  Component component(const Element& element) {
    if (xml_.has_attribute(element, kProduction, "path")) {
      xml_.fail(element, "an object in another part is not supported");
    }
    const std::int64_t id = integer(element, "objectid");
    const auto object = objects_.find(id);
    if (object == objects_.end()) {
      xml_.fail(element, "it shows object " + std::to_string(id) + ", which is not there before");
    }
    const bool is_moved = element.Attribute("transform") != nullptr;
    return {&object->second, is_moved ? std::optional(transform(element)) : std::nullopt};
  }

  // Twelve numbers: the rows of a matrix that points, as rows, are multiplied by from the left.
  Affine transform(const Element& element) const {
    const std::vector<std::string_view> words = words_of(element.Attribute("transform"));
    if (words.size() < 12) xml_.fail(element, "a transform of fewer than twelve numbers");
    if (words.size() > 12) xml_.fail(element, "a transform of more than twelve numbers");
    Eigen::Matrix3d linear;
    Eigen::Vector3d offset;
    for (int i = 0; i < 12; ++i) {
      const double entry = number_in(element, words[static_cast<std::size_t>(i)]);
      if (std::abs(entry) > kMaxCoordinate) xml_.fail(element, "a transform beyond 1e15");
      (i < 9 ? linear(i % 3, i / 3) : offset[i % 3]) = entry;
    }
    return {linear, offset};
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

  const std::string& subject_;
  NamedXml xml_;
  std::map<std::int64_t, Object> objects_;
  std::vector<Component> items_;
  SceneBudget budget_;
};

}  // namespace

TriangleMesh read_3mf(std::string_view bytes, const std::string& subject) {
  const XmlPart model(bytes, model_name(bytes, subject), subject);
  return ModelReader(subject).run(model.root());
}

double unit_of_3mf(std::string_view bytes, const std::string& subject) {
  const XmlPart model(bytes, model_name(bytes, subject), subject);
  const char* const stated = model.root().Attribute("unit");
  const LengthUnit* const unit = unit_named(stated == nullptr ? "millimeter" : stated);
  if (unit == nullptr) {
    throw Error(subject, "states a unit that is not known: " + std::string(stated));
  }
  return unit->micrometres;
}

}  // namespace spherule::internal
