// SPDX-License-Identifier: BSD-3-Clause
#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "base/rounding.h"
#include "base/text.h"
#include "geometry/vertex_rounding.h"
#include "io/binary_number.h"
#include "io/mesh_readers.h"
#include "io/placement.h"
#include "io/polygon_triangles.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

// glTF and GLB files (Khronos, "glTF 2.0 Specification").

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

constexpr std::size_t kHeader = 12;      // of a GLB file: magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length and type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

// Elements of one accessor: more than any mesh that is read has corners.
constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 27;
// Numbers of a sparse accessor that are zero because no buffer holds them.
constexpr std::size_t kMaxZeros = std::size_t{1} << 24;
// What it costs to find an accessor, in numbers read.
constexpr std::size_t kLookup = 32;

// What an accessor is read for, which decides on the type of its elements and of their components.
enum class GltfUse {
  kPositions,           // VEC3 of floats
  kQuantizedPositions,  // VEC3, of whole numbers too
  kIndices,             // SCALAR of whole numbers without a sign
};

// A component of an accessor; normalised numbers stand for [0, 1] or [-1, 1].
double component_at(const char* bytes, NumberType type, bool is_normalized) {
  constexpr std::array<double, 6> kLargest = {0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF};
  const double value = number_at(bytes, type, std::endian::little);
  if (!is_normalized) return value;
  return std::max(value / kLargest[static_cast<std::size_t>(type)], -1.0);
}

bool is_index(NumberType type) {
  return type == NumberType::kUint8 || type == NumberType::kUint16 || type == NumberType::kUint32;
}

bool is_allowed(GltfUse use, NumberType type, bool is_normalized) {
  if (use == GltfUse::kIndices) return !is_normalized && is_index(type);
  if (type == NumberType::kFloat) return !is_normalized;
  return use == GltfUse::kQuantizedPositions && !(is_normalized && type == NumberType::kUint32);
}

// References of one file to others (RFC 3986, RFC 2397).

int digit_of_base64(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::optional<std::string> from_base64(std::string_view text) {
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) {
    text.remove_suffix(1);
    ++padding;
  }
  if (text.size() % 4 == 1 || (padding > 0 && (text.size() + padding) % 4 != 0)) {
    return std::nullopt;
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = digit_of_base64(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xFF));
    }
  }
  return bytes;
}

// The bytes of a data URI with base64 (RFC 4648); nothing if it is none.
std::optional<std::string> bytes_of_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!uri.starts_with("data:") || comma == std::string_view::npos) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  return from_base64(uri.substr(comma + 1));
}

// The file that a relative reference names, with percent-encoding undone; nothing if it has a
// scheme, is absolute, is not a regular file, or lies, links followed, outside of `folder`.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                std::string_view reference) {
  // A colon before any slash ends a scheme.
  const std::size_t colon = reference.find(':');
  if (colon != std::string_view::npos && colon < reference.find('/')) return std::nullopt;
  const PercentDecoded name = percent_decoded(reference);
  if (name.has_other_percents || name.text.empty() || name.text.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  const std::filesystem::path relative(name.text);
  if (relative.is_absolute()) return std::nullopt;
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error) return std::nullopt;
  const std::filesystem::path file = std::filesystem::weakly_canonical(root / relative, error);
  if (error || !std::filesystem::is_regular_file(file, error) || error) return std::nullopt;
  const std::filesystem::path inside = file.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..") return std::nullopt;
  return file;
}

// The JSON of a glTF or GLB file, with checked access.
class GltfDocument {
 public:
  // `subject` names the file in an Error; it and `bytes` have to outlive the document. Throws Error
  // if the file is not glTF 2, names a member of an object twice, is nested deeper than
  // kDeepestJson or requires an extension that may change where its meshes are.
  GltfDocument(std::string_view bytes, const std::string& subject) : subject_(subject) {
    split_container(bytes);
    root_ = parse_json<Json>(json_, [&](const std::string& reason) {
      fail((json_.size() < bytes.size() ? "in its JSON: " : "") + reason);
    });
    if (!root().is_object()) fail("not a glTF file");
    const Json* const asset = member(root(), "asset");
    if (asset == nullptr || !text(*asset, "version").starts_with("2."))
      fail("not glTF of version 2");
    // Later versions 2.x can be read as 2.0 unless the file says otherwise.
    if (asset->contains("minVersion") && text(*asset, "minVersion") != "2.0") {
      fail("it requires version " + in_quotes(text(*asset, "minVersion")) +
           " of glTF, and 2.0 is supported");
    }
    check_extensions();
  }

  const Json& root() const { return root_; }
  // The binary chunk of a GLB file.
  std::optional<std::string_view> binary_chunk() const { return binary_chunk_; }
  // Whether the file requires KHR_mesh_quantization: positions may be whole numbers.
  bool is_quantized() const { return is_quantized_; }

  // Of an object: a whole number that is not negative, `absent` if there is none.
  std::uint64_t whole(const Json& object, const char* key, std::uint64_t absent) const {
    return index(object, key).value_or(absent);
  }
  std::optional<std::uint64_t> index(const Json& object, const char* key) const {
    const Json* const found = value(object, key, &Json::is_number_unsigned, "a whole number");
    return found == nullptr ? std::nullopt : std::optional(found->get<std::uint64_t>());
  }
  // Indices or finite numbers; empty if there is no such list.
  std::vector<std::uint64_t> indices(const Json& object, const char* key) const {
    return values<std::uint64_t>(object, key, &Json::is_number_unsigned, "a list of indices");
  }
  std::vector<double> numbers(const Json& object, const char* key) const {
    constexpr const char* kWhat = "a list of finite numbers";
    std::vector<double> result = values<double>(object, key, &Json::is_number, kWhat);
    for (const double number : result) {
      if (!std::isfinite(number)) refuse(key, kWhat);
    }
    return result;
  }
  // A string, empty if there is none.
  std::string text(const Json& object, const char* key) const {
    const Json* const found = value(object, key, &Json::is_string, "a text");
    return found == nullptr ? std::string() : found->get<std::string>();
  }
  // The list of objects, empty if there is none.
  const Json& list(const Json& object, const char* key) const {
    static const Json kNone = Json::array();
    const Json* const found = value(object, key, &Json::is_array, "a list");
    if (found == nullptr) return kNone;
    for (const Json& entry : *found) {
      if (!entry.is_object()) refuse(key, "a list of objects");
    }
    return *found;
  }
  // The object that a reference names.
  const Json& item(const char* list, std::uint64_t index) const {
    const auto it = root().find(list);
    if (it == root().end() || !it->is_array() || index >= it->size() ||
        !(*it)[static_cast<std::size_t>(index)].is_object()) {
      fail(std::string("it refers to an entry of '") + list + "' that is not there");
    }
    return (*it)[static_cast<std::size_t>(index)];
  }
  // The member that is an object, or null.
  const Json* member(const Json& object, const char* key) const {
    return value(object, key, &Json::is_object, "an object");
  }

  [[noreturn]] void fail(const std::string& reason) const { throw Error(subject_, reason); }

 private:
  using IsType = bool (Json::*)() const noexcept;

  [[noreturn]] void refuse(const char* key, const char* what) const {
    fail(std::string("'") + key + "' is not " + what);
  }

  // The value of a key, of that type; null if there is none.
  const Json* value(const Json& object, const char* key, IsType is, const char* what) const {
    const auto it = object.find(key);
    if (it == object.end()) return nullptr;
    if (!((*it).*is)()) refuse(key, what);
    return &*it;
  }

  template <class Value>
  std::vector<Value> values(const Json& object, const char* key, IsType is,
                            const char* what) const {
    std::vector<Value> result;
    const Json* const found = value(object, key, &Json::is_array, what);
    if (found == nullptr) return result;
    for (const Json& entry : *found) {
      if (!(entry.*is)()) refuse(key, what);
      result.push_back(entry.get<Value>());
    }
    return result;
  }

  void split_container(std::string_view bytes) {
    json_ = bytes;
    if (!bytes.starts_with("glTF")) return;
    if (bytes.size() < kHeader + kChunkHeader) fail("the file is cut short");
    if (number_at<std::uint32_t>(bytes.data() + 4) != 2) fail("not glTF of version 2");
    if (number_at<std::uint32_t>(bytes.data() + 8) != bytes.size())
      fail("the file is cut short, or longer than it says");
    bool has_json = false;
    for (std::size_t at = kHeader; at < bytes.size();) {
      if (bytes.size() - at < kChunkHeader) fail("the file is cut short");
      const std::size_t size = number_at<std::uint32_t>(bytes.data() + at);
      const std::uint32_t type = number_at<std::uint32_t>(bytes.data() + at + 4);
      at += kChunkHeader;
      if (size > bytes.size() - at) fail("the file is cut short");
      if (!has_json && type != kJsonChunk) fail("its first chunk is not JSON");
      if (!has_json) {
        json_ = bytes.substr(at, size);
        has_json = true;
      } else if (type == kBinaryChunk && !binary_chunk_) {
        binary_chunk_ = bytes.substr(at, size);
      }
      at += size;
    }
  }

  // Extensions that change the appearance are no matter; any other that a reader must know may
  // change where things are.
  void check_extensions() {
    const auto required = root().find("extensionsRequired");
    if (required == root().end()) return;
    if (!required->is_array()) fail("'extensionsRequired' is not a list");
    for (const Json& entry : *required) {
      const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
      const bool appearance_only =
          name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
          name.starts_with("KHR_lights_") || name.starts_with("EXT_texture_");
      if (name == "KHR_mesh_quantization") {
        is_quantized_ = true;
      } else if (!appearance_only) {
        fail("it requires the extension " + name + ", which is not supported");
      }
    }
  }

  const std::string& subject_;
  std::string_view json_;
  std::optional<std::string_view> binary_chunk_;
  JsonDocument<Json> root_{Json()};
  bool is_quantized_ = false;
};

// Values of an accessor, element by element.
struct GltfValues {
  std::vector<double> numbers;
  std::size_t components = 1;  // of an element
  bool is_exact = true;        // false for normalised whole numbers, of which each is rounded

  std::size_t count() const { return numbers.size() / components; }
};

// Reads buffers and the accessors on them. Every offset, stride and count is checked against the
// bytes that are there. Buffers come from the binary chunk of a GLB file, from data URIs, and from
// files in the folder of the glTF file or below it; others are refused.
class GltfAccessors {
 public:
  // All have to outlive the object.
  GltfAccessors(const GltfDocument& document, const std::filesystem::path& file,
                SceneBudget& budget)
      : document_(document), file_(file), budget_(budget) {}

  GltfValues read(std::uint64_t index, GltfUse use) {
    const Json& accessor = document_.item("accessors", index);
    const std::optional<NumberType> type = component_type_of(accessor);
    const auto normalized = accessor.find("normalized");
    const bool is_normalized = normalized != accessor.end() && *normalized == true;
    const bool is_scalar = use == GltfUse::kIndices;
    if (document_.text(accessor, "type") != (is_scalar ? "SCALAR" : "VEC3") || !type ||
        !is_allowed(use, *type, is_normalized)) {
      document_.fail("the accessor " + std::to_string(index) +
                     " is not of the type that is needed");
    }
    const std::size_t size = size_of(*type);
    const std::uint64_t stated = document_.whole(accessor, "count", 0);
    if (stated == 0 || stated > kMaxCount) document_.fail("an accessor of no usable count");
    const auto count = static_cast<std::size_t>(stated);
    GltfValues result{.numbers = {}, .components = is_scalar ? std::size_t{1} : 3};
    result.is_exact = !is_normalized;
    if (accessor.contains("bufferView")) {
      const Layout layout = this->layout(accessor, size * result.components, count, true);
      budget_.take_steps(kLookup + count * result.components);
      result.numbers.reserve(count * result.components);
      for (std::size_t i = 0; i < count; ++i) {
        const char* element = layout.bytes.data() + i * layout.stride;
        for (std::size_t k = 0; k < result.components; ++k) {
          result.numbers.push_back(component_at(element + k * size, *type, is_normalized));
        }
      }
    } else {
      if (!accessor.contains("sparse")) document_.fail("an accessor without data");
      if (count * result.components > kMaxZeros) {
        document_.fail("a sparse accessor of more than 2^24 numbers without a buffer view");
      }
      budget_.take_steps(kLookup + count * result.components);
      result.numbers.assign(count * result.components, 0.0);
    }
    if (const Json* sparse = document_.member(accessor, "sparse")) {
      add_sparse(*sparse, *type, count, is_normalized, result);
    }
    return result;
  }

 private:
  // Where consecutive elements are.
  struct Layout {
    std::string_view bytes;
    std::size_t stride = 0;
  };

  // By its number in the specification.
  std::optional<NumberType> component_type_of(const Json& accessor) const {
    constexpr std::uint64_t kFirst = 5120;
    const std::uint64_t number = document_.whole(accessor, "componentType", 0) - kFirst;
    if (number > 6 || number == 4) return std::nullopt;
    return static_cast<NumberType>(number);
  }

  // Replaces some of the elements.
  void add_sparse(const Json& sparse, NumberType type, std::size_t count, bool is_normalized,
                  GltfValues& values) {
    const std::uint64_t stated = document_.whole(sparse, "count", 0);
    const Json* const indices = document_.member(sparse, "indices");
    const Json* const replaced = document_.member(sparse, "values");
    if (stated == 0 || stated > count || indices == nullptr || replaced == nullptr) {
      document_.fail("a sparse accessor that is incomplete");
    }
    const auto changes = static_cast<std::size_t>(stated);
    const std::optional<NumberType> index_type = component_type_of(*indices);
    if (!index_type || !is_index(*index_type)) {
      document_.fail("the indices of a sparse accessor are not whole numbers");
    }
    const std::size_t size = size_of(type);
    const Layout at = layout(*indices, size_of(*index_type), changes, false);
    const Layout with = layout(*replaced, size * values.components, changes, false);
    for (std::size_t i = 0; i < changes; ++i) {
      const auto element = static_cast<std::size_t>(
          component_at(at.bytes.data() + i * at.stride, *index_type, false));
      if (element >= count) document_.fail("an index of a sparse accessor is out of range");
      for (std::size_t k = 0; k < values.components; ++k) {
        values.numbers[element * values.components + k] =
            component_at(with.bytes.data() + i * with.stride + k * size, type, is_normalized);
      }
    }
  }

  Layout layout(const Json& place, std::size_t size, std::size_t count, bool may_stride) {
    const std::optional<std::uint64_t> index = document_.index(place, "bufferView");
    if (!index) document_.fail("an accessor without a buffer view");
    const Json& view = document_.item("bufferViews", *index);
    const std::string_view bytes = buffer(document_.whole(view, "buffer", ~std::uint64_t{0}));
    const std::uint64_t view_begin = document_.whole(view, "byteOffset", 0);
    const std::uint64_t view_size = document_.whole(view, "byteLength", 0);
    if (view_begin > bytes.size() || view_size > bytes.size() - view_begin) {
      document_.fail("a buffer view reaches beyond its buffer");
    }
    const std::uint64_t stride = may_stride ? document_.whole(view, "byteStride", size) : size;
    if (stride < size || stride > 252) {
      document_.fail("a stride that is shorter than an element or beyond 252 bytes");
    }
    // `count` and `stride` are small enough that nothing overflows.
    const std::uint64_t begin = document_.whole(place, "byteOffset", 0);
    const std::uint64_t needed = (count - 1) * stride + size;
    if (begin > view_size || needed > view_size - begin) {
      document_.fail("an accessor reaches beyond its buffer view");
    }
    return {bytes.substr(static_cast<std::size_t>(view_begin + begin),
                         static_cast<std::size_t>(needed)),
            static_cast<std::size_t>(stride)};
  }

  std::string_view buffer(std::uint64_t index) {
    const Json& entry = document_.item("buffers", index);
    const std::uint64_t size = document_.whole(entry, "byteLength", 0);
    std::string_view bytes;
    if (entry.contains("uri")) {
      const auto [it, is_new] = buffers_.try_emplace(index);
      if (is_new) it->second = load(document_.text(entry, "uri"));
      bytes = it->second;
    } else if (index == 0 && document_.binary_chunk()) {
      bytes = *document_.binary_chunk();
    } else {
      document_.fail("a buffer without bytes");
    }
    if (size > bytes.size()) document_.fail("a buffer is shorter than it says");
    return bytes.substr(0, static_cast<std::size_t>(size));
  }

  // The bytes of a URI, which stay with the object; a file is read once.
  std::string_view load(const std::string& uri) {
    if (uri.starts_with("data:")) {
      std::optional<std::string> bytes = bytes_of_data_uri(uri);
      if (!bytes) document_.fail("a data URI that is not base64");
      return decoded_.emplace_back(*std::move(bytes));
    }
    const auto [it, is_new] = files_.try_emplace(uri);
    if (is_new) {
      const std::optional<std::filesystem::path> file = file_below(file_.parent_path(), uri);
      if (!file) {
        document_.fail("the buffer " + uri.substr(0, 60) + " is not a file in its folder or below");
      }
      it->second = read_regular_file(*file);
    }
    return it->second;
  }

  const GltfDocument& document_;
  const std::filesystem::path& file_;
  SceneBudget& budget_;
  std::map<std::uint64_t, std::string_view> buffers_;  // by number
  std::map<std::string, std::string> files_;           // by URI
  std::list<std::string> decoded_;                     // of data URIs
};

constexpr std::uint64_t kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;
constexpr std::size_t kNone = ~std::size_t{0};
// Numbers read from accessors, each reading counted: positions and indices of the largest mesh that
// can be shown are 3 * 2^25.
constexpr std::size_t kMaxNumbers = std::size_t{1} << 27;
// What a primitive costs without its numbers.
constexpr std::size_t kPrimitive = 32;
// Of decimal numbers, and of the few products and the square root that make a matrix of them.
constexpr double kEntryError = 0x1p-50;

struct Node {
  bool is_shown = false;
  std::size_t parent = kNone;
  std::size_t moved_by = kNone;  // the nearest of it and those above it that has a transform
  std::optional<Affine> transform{};
};

void remove_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> place(mesh.vertices.size(), -1);
  std::vector<Vector3d> used;
  for (Eigen::Vector3i& triangle : mesh.triangles) {
    for (int& corner : triangle) {
      int& to = place[static_cast<std::size_t>(corner)];
      if (to < 0) {
        to = static_cast<int>(used.size());
        used.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
      }
      corner = to;
    }
  }
  used.shrink_to_fit();  // many primitives may be kept
  mesh.vertices = std::move(used);
}

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::filesystem::path& path, const std::string& subject)
      : subject_(subject),
        document_(bytes, subject),
        budget_(subject, kMaxNumbers),
        accessors_(document_, path, budget_) {}

  TriangleMesh run() {
    find_nodes();
    for (const std::size_t node : shown_) {
      const Json& entry = document_.item("nodes", node);
      const std::optional<std::uint64_t> mesh = document_.index(entry, "mesh");
      if (!mesh) continue;
      if (entry.contains("skin")) document_.fail("a mesh with a skin, which is not supported");
      const Json* const extensions = document_.member(entry, "extensions");
      if (extensions != nullptr && extensions->contains("EXT_mesh_gpu_instancing")) {
        document_.fail(
            "a mesh that the extension EXT_mesh_gpu_instancing shows in many places, which is not "
            "supported");
      }
      const std::vector<Affine> chain = chain_of(node);
      for (TriangleMesh part : primitives_of(*mesh)) {
        budget_.take(part);
        budget_.take_moves(part.vertices.size(), chain.size());
        place(part, chain, 0.0, kEntryError);
        append(result_, part, subject_);
      }
    }
    return std::move(result_);
  }

 private:
  // The nodes of the scene in the order of the file's tree, with their parents.
  void find_nodes() {
    const Json& scenes = document_.list(document_.root(), "scenes");
    std::optional<std::uint64_t> scene = document_.index(document_.root(), "scene");
    if (!scene && scenes.size() == 1) scene = 0;
    if (!scene) document_.fail("it names no scene to show");
    nodes_.resize(document_.list(document_.root(), "nodes").size());
    std::vector<std::size_t> open;
    push_children(document_.item("scenes", *scene), "nodes", kNone, open);
    while (!open.empty()) {
      const std::size_t node = open.back();
      open.pop_back();
      shown_.push_back(node);
      push_children(document_.item("nodes", node), "children", node, open);
    }
  }

  void push_children(const Json& entry, const char* key, std::size_t parent,
                     std::vector<std::size_t>& open) {
    const std::vector<std::uint64_t> children = document_.indices(entry, key);
    for (std::size_t i = children.size(); i-- > 0;) {
      const Json& child_entry = document_.item("nodes", children[i]);
      const auto child = static_cast<std::size_t>(children[i]);
      Node& node = nodes_[child];
      if (node.is_shown) document_.fail("a node has two parents");
      node.is_shown = true;
      node.transform = transform_of(child_entry);
      node.moved_by = node.transform || parent == kNone ? child : nodes_[parent].moved_by;
      node.parent = parent;
      open.push_back(child);
    }
  }

  // The transforms of a node and of those above it, from the root down.
  std::vector<Affine> chain_of(std::size_t node) const {
    std::vector<Affine> chain;
    for (; node != kNone; node = nodes_[node].parent) {
      node = nodes_[node].moved_by;
      if (nodes_[node].transform) chain.push_back(*nodes_[node].transform);
      budget_.check_depth(chain.size());
    }
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  std::optional<Affine> transform_of(const Json& node) const {
    if (node.contains("matrix")) {
      if (node.contains("translation") || node.contains("rotation") || node.contains("scale")) {
        document_.fail("a node with a matrix beside its other transforms");
      }
      return affine_of(document_.numbers(node, "matrix"));
    }
    const std::vector<double> translation = vector_of(node, "translation", {0.0, 0.0, 0.0});
    const std::vector<double> rotation = vector_of(node, "rotation", {0.0, 0.0, 0.0, 1.0});
    const std::vector<double> scale = vector_of(node, "scale", {1.0, 1.0, 1.0});
    const Eigen::Quaterniond q(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (!(std::abs(q.norm() - 1.0) < 1e-3)) document_.fail("a rotation that is no unit quaternion");
    const Affine result{q.normalized().toRotationMatrix() *
                            Eigen::DiagonalMatrix<double, 3>(scale[0], scale[1], scale[2]),
                        {translation[0], translation[1], translation[2]}};
    if (result.linear == Eigen::Matrix3d::Identity() && result.offset.isZero(0.0)) {
      return std::nullopt;
    }
    return result;
  }

  std::vector<double> vector_of(const Json& node, const char* key,
                                const std::vector<double>& absent) const {
    if (!node.contains(key)) return absent;
    std::vector<double> result = document_.numbers(node, key);
    if (result.size() != absent.size()) document_.fail(std::string("a ") + key + " of bad length");
    return result;
  }

  // Column by column.
  Affine affine_of(std::span<const double> entries) const {
    if (entries.size() != 16) document_.fail("a matrix that has not 16 numbers");
    const std::optional<Affine> result =
        affine_from(Eigen::Map<const Eigen::Matrix4d>(entries.data()));
    if (!result) document_.fail("a node transform that is not affine and finite");
    return *result;
  }

  // Read once however often it is shown.
  const std::vector<TriangleMesh>& primitives_of(std::uint64_t index) {
    const auto [it, is_new] = meshes_.try_emplace(index);
    if (!is_new) return it->second;
    for (const Json& primitive : document_.list(document_.item("meshes", index), "primitives")) {
      budget_.take_steps(kPrimitive);
      const std::uint64_t mode = document_.whole(primitive, "mode", kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kTriangleFan) document_.fail("an unknown kind of primitive");
      if (!document_.list(primitive, "targets").empty()) {
        document_.fail("a mesh with morph targets, which are not supported");
      }
      TriangleMesh& made = it->second.emplace_back();
      add_vertices(primitive, made);
      add_triangles(primitive, mode, made);
      remove_unused_vertices(made);  // parts often share one long list of vertices
    }
    return it->second;
  }

  void add_vertices(const Json& primitive, TriangleMesh& mesh) {
    const Json* const attributes = document_.member(primitive, "attributes");
    const auto accessor =
        attributes == nullptr ? std::nullopt : document_.index(*attributes, "POSITION");
    if (!accessor) document_.fail("a mesh without positions");
    const GltfValues values = accessors_.read(
        *accessor, document_.is_quantized() ? GltfUse::kQuantizedPositions : GltfUse::kPositions);
    mesh.vertices.reserve(values.count());
    for (std::size_t k = 0; k < values.numbers.size(); k += 3) {
      mesh.vertices.emplace_back(values.numbers[k], values.numbers[k + 1], values.numbers[k + 2]);
    }
    // A normalised number errs by less than three roundings; twice that is charged.
    if (!values.is_exact) {
      mesh.vertex_error = rounding_distance(largest_coordinate(mesh), 6.0 * kUnitRoundoff);
    }
  }

  void add_triangles(const Json& primitive, std::uint64_t mode, TriangleMesh& mesh) {
    std::vector<std::int64_t> corners;
    if (const auto accessor = document_.index(primitive, "indices")) {
      const GltfValues list = accessors_.read(*accessor, GltfUse::kIndices);
      corners.assign(list.numbers.begin(), list.numbers.end());
    } else {
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        corners.push_back(static_cast<std::int64_t>(i));
      }
    }
    if (corners.size() < 3 || (mode == kTriangles && corners.size() % 3 != 0)) {
      document_.fail("an incomplete triangle");
    }
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 2; i < corners.size(); i += step) {
      const std::array<std::int64_t, 3> triangle =
          mode == kTriangleStrip
              ? strip_triangle(corners, i)
              : std::array{corners[mode == kTriangles ? i - 2 : 0], corners[i - 1], corners[i]};
      add_polygon(mesh, triangle, mesh.vertices.size(), subject_);
    }
  }

  const std::string& subject_;
  GltfDocument document_;
  SceneBudget budget_;
  GltfAccessors accessors_;
  std::vector<std::size_t> shown_;
  std::vector<Node> nodes_;
  std::map<std::uint64_t, std::vector<TriangleMesh>> meshes_;
  TriangleMesh result_;
};

}  // namespace

TriangleMesh read_gltf(std::string_view bytes, const std::filesystem::path& path) {
  const std::string subject = path.string();
  return GltfReader(bytes, path, subject).run();
}

}  // namespace spherule::internal
