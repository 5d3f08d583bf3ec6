// SPDX-License-Identifier: BSD-3-Clause
#include "io/gltf_data.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

namespace spherule::internal {
namespace {

using Json = GltfDocument::Json;

constexpr std::size_t kHeader = 12;      // of a GLB file: magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length and type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

// Component types of the specification.
constexpr std::uint64_t kInt8 = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kUint32 = 5125,
                        kFloat = 5126;

// Elements of one accessor: more than any mesh that is read has corners.
constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 27;
// Numbers of a sparse accessor that are zero because no buffer holds them.
constexpr std::size_t kMaxZeros = std::size_t{1} << 24;
// What it costs to find an accessor, in numbers read.
constexpr std::size_t kLookup = 32;

std::size_t size_of(std::uint64_t type) {
  switch (type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kUint32:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

// A little-endian number.
template <class T>
T value_at(const char* bytes) {
  std::array<char, sizeof(T)> image;
  std::memcpy(image.data(), bytes, image.size());
  if (std::endian::native == std::endian::big) std::reverse(image.begin(), image.end());
  return std::bit_cast<T>(image);
}

// Normalised numbers stand for [0, 1] or [-1, 1].
template <class T>
double whole_at(const char* bytes, bool is_normalized) {
  const auto value = static_cast<double>(value_at<T>(bytes));
  return is_normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

double number_at(const char* bytes, std::uint64_t type, bool is_normalized) {
  switch (type) {
    case kInt8:
      return whole_at<std::int8_t>(bytes, is_normalized);
    case kUint8:
      return whole_at<std::uint8_t>(bytes, is_normalized);
    case kInt16:
      return whole_at<std::int16_t>(bytes, is_normalized);
    case kUint16:
      return whole_at<std::uint16_t>(bytes, is_normalized);
    case kUint32:
      return whole_at<std::uint32_t>(bytes, is_normalized);
    default:
      return static_cast<double>(value_at<float>(bytes));
  }
}

bool is_allowed(GltfUse use, std::uint64_t type, bool is_normalized) {
  if (use == GltfUse::kIndices) {
    return !is_normalized && (type == kUint8 || type == kUint16 || type == kUint32);
  }
  if (type == kFloat) return !is_normalized;
  return use == GltfUse::kQuantizedPositions && !(is_normalized && type == kUint32);
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

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, const std::string& subject) : subject_(subject) {
  split_container(bytes);
  root_ = parse_json<Json>(json_, [&](const std::string& reason) {
    fail((json_.size() < bytes.size() ? "in its JSON: " : "") + reason);
  });
  if (!root_.is_object()) fail("not a glTF file");
  const Json* const asset = member(root_, "asset");
  if (asset == nullptr || !text(*asset, "version").starts_with("2.")) fail("not glTF of version 2");
  // Later versions 2.x can be read as 2.0 unless the file says otherwise.
  if (asset->contains("minVersion") && text(*asset, "minVersion") != "2.0") {
    fail("it requires version " + in_quotes(text(*asset, "minVersion")) +
         " of glTF, and 2.0 is supported");
  }
  check_extensions();
}

void GltfDocument::split_container(std::string_view bytes) {
  json_ = bytes;
  if (!bytes.starts_with("glTF")) return;
  if (bytes.size() < kHeader + kChunkHeader) fail("the file is cut short");
  if (value_at<std::uint32_t>(bytes.data() + 4) != 2) fail("not glTF of version 2");
  if (value_at<std::uint32_t>(bytes.data() + 8) != bytes.size())
    fail("the file is cut short, or longer than it says");
  bool has_json = false;
  for (std::size_t at = kHeader; at < bytes.size();) {
    if (bytes.size() - at < kChunkHeader) fail("the file is cut short");
    const std::size_t size = value_at<std::uint32_t>(bytes.data() + at);
    const std::uint32_t type = value_at<std::uint32_t>(bytes.data() + at + 4);
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

// Extensions that change the appearance are no matter; any other that a reader must know may change
// where things are.
void GltfDocument::check_extensions() {
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

std::uint64_t GltfDocument::whole(const Json& object, const char* key, std::uint64_t absent) const {
  const auto it = object.find(key);
  if (it == object.end()) return absent;
  if (!it->is_number_unsigned()) fail(std::string("'") + key + "' is not a whole number");
  return it->get<std::uint64_t>();
}

std::optional<std::uint64_t> GltfDocument::index(const Json& object, const char* key) const {
  if (!object.contains(key)) return std::nullopt;
  return whole(object, key, 0);
}

std::vector<std::uint64_t> GltfDocument::indices(const Json& object, const char* key) const {
  std::vector<std::uint64_t> result;
  const auto it = object.find(key);
  if (it == object.end()) return result;
  const auto refuse = [&] { fail(std::string("'") + key + "' is not a list of indices"); };
  if (!it->is_array()) refuse();
  for (const Json& entry : *it) {
    if (!entry.is_number_unsigned()) refuse();
    result.push_back(entry.get<std::uint64_t>());
  }
  return result;
}

std::vector<double> GltfDocument::numbers(const Json& object, const char* key) const {
  std::vector<double> result;
  const auto it = object.find(key);
  if (it == object.end()) return result;
  const auto refuse = [&] { fail(std::string("'") + key + "' is not a list of finite numbers"); };
  if (!it->is_array()) refuse();
  for (const Json& entry : *it) {
    if (!entry.is_number()) refuse();
    result.push_back(entry.get<double>());
    if (!std::isfinite(result.back())) refuse();
  }
  return result;
}

std::string GltfDocument::text(const Json& object, const char* key) const {
  const auto it = object.find(key);
  if (it == object.end()) return {};
  if (!it->is_string()) fail(std::string("'") + key + "' is not a text");
  return it->get<std::string>();
}

const Json& GltfDocument::list(const Json& object, const char* key) const {
  static const Json kNone = Json::array();
  const auto it = object.find(key);
  if (it == object.end()) return kNone;
  if (!it->is_array()) fail(std::string("'") + key + "' is not a list");
  for (const Json& entry : *it) {
    if (!entry.is_object()) fail(std::string("'") + key + "' is not a list of objects");
  }
  return *it;
}

const Json& GltfDocument::item(const char* list, std::uint64_t index) const {
  const auto it = root().find(list);
  if (it == root().end() || !it->is_array() || index >= it->size() ||
      !(*it)[static_cast<std::size_t>(index)].is_object()) {
    fail(std::string("it refers to an entry of '") + list + "' that is not there");
  }
  return (*it)[static_cast<std::size_t>(index)];
}

const Json* GltfDocument::member(const Json& object, const char* key) const {
  const auto it = object.find(key);
  if (it == object.end()) return nullptr;
  if (!it->is_object()) fail(std::string("'") + key + "' is not an object");
  return &*it;
}

void GltfDocument::fail(const std::string& reason) const {
  throw Error(subject_, reason);
}

GltfAccessors::GltfAccessors(const GltfDocument& document, const std::filesystem::path& file,
                             SceneBudget& budget)
    : document_(document), file_(file), budget_(budget) {}

GltfValues GltfAccessors::read(std::uint64_t index, GltfUse use) {
  const Json& accessor = document_.item("accessors", index);
  const std::uint64_t type = document_.whole(accessor, "componentType", 0);
  const auto normalized = accessor.find("normalized");
  const bool is_normalized = normalized != accessor.end() && *normalized == true;
  const std::size_t size = size_of(type);
  const bool is_scalar = use == GltfUse::kIndices;
  if (document_.text(accessor, "type") != (is_scalar ? "SCALAR" : "VEC3") || size == 0 ||
      !is_allowed(use, type, is_normalized)) {
    document_.fail("the accessor " + std::to_string(index) + " is not of the type that is needed");
  }
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
        result.numbers.push_back(number_at(element + k * size, type, is_normalized));
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
    add_sparse(*sparse, type, count, is_normalized, result);
  }
  return result;
}

// Replaces some of the elements.
void GltfAccessors::add_sparse(const Json& sparse, std::uint64_t type, std::size_t count,
                               bool is_normalized, GltfValues& values) {
  const std::uint64_t stated = document_.whole(sparse, "count", 0);
  const Json* const indices = document_.member(sparse, "indices");
  const Json* const replaced = document_.member(sparse, "values");
  if (stated == 0 || stated > count || indices == nullptr || replaced == nullptr) {
    document_.fail("a sparse accessor that is incomplete");
  }
  const auto changes = static_cast<std::size_t>(stated);
  const std::uint64_t index_type = document_.whole(*indices, "componentType", 0);
  if (index_type != kUint8 && index_type != kUint16 && index_type != kUint32) {
    document_.fail("the indices of a sparse accessor are not whole numbers");
  }
  const std::size_t size = size_of(type);
  const Layout at = layout(*indices, size_of(index_type), changes, false);
  const Layout with = layout(*replaced, size * values.components, changes, false);
  for (std::size_t i = 0; i < changes; ++i) {
    const auto element =
        static_cast<std::size_t>(number_at(at.bytes.data() + i * at.stride, index_type, false));
    if (element >= count) document_.fail("an index of a sparse accessor is out of range");
    for (std::size_t k = 0; k < values.components; ++k) {
      values.numbers[element * values.components + k] =
          number_at(with.bytes.data() + i * with.stride + k * size, type, is_normalized);
    }
  }
}

GltfAccessors::Layout GltfAccessors::layout(const Json& place, std::size_t size, std::size_t count,
                                            bool may_stride) {
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
  return {
      bytes.substr(static_cast<std::size_t>(view_begin + begin), static_cast<std::size_t>(needed)),
      static_cast<std::size_t>(stride)};
}

std::string_view GltfAccessors::buffer(std::uint64_t index) {
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

std::string_view GltfAccessors::load(const std::string& uri) {
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

}  // namespace spherule::internal
