// SPDX-License-Identifier: BSD-3-Clause
#include "io/gltf_accessors.h"

#include "base/error.h"
#include "base/files.h"
#include "io/uri.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Json = GltfDocument::Json;

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

std::size_t components_of(std::string_view type) {
  constexpr std::pair<std::string_view, std::size_t> kTypes[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  for (const auto& [name, count] : kTypes) {
    if (name == type) return count;
  }
  return 0;
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

bool is_allowed(const GltfElements& elements, std::uint64_t type, bool is_normalized) {
  if (type == kFloat) return elements.is_float_allowed && !is_normalized;
  if (is_normalized && (!elements.is_normalized_allowed || type == kUint32)) return false;
  if (!is_normalized && !elements.is_whole_allowed) return false;
  return type == kUint8 || type == kUint16 || type == kUint32 || elements.is_signed_allowed;
}

}  // namespace

GltfAccessors::GltfAccessors(const GltfDocument& document, const std::filesystem::path& file,
                             SceneBudget& budget)
    : document_(document), file_(file), budget_(budget) {}

GltfValues GltfAccessors::read(std::uint64_t index, const GltfElements& elements) {
  const Json& accessor = document_.item("accessors", index);
  const std::uint64_t type = document_.whole(accessor, "componentType", 0);
  const auto normalized = accessor.find("normalized");
  const bool is_normalized = normalized != accessor.end() && *normalized == true;
  const std::size_t size = size_of(type);
  if (document_.text(accessor, "type") != elements.type || size == 0 ||
      !is_allowed(elements, type, is_normalized)) {
    document_.fail("the accessor " + std::to_string(index) + " is not of the type that is needed");
  }
  const std::uint64_t stated = document_.whole(accessor, "count", 0);
  if (stated == 0 || stated > kMaxCount) document_.fail("an accessor of no usable count");
  const auto count = static_cast<std::size_t>(stated);
  GltfValues result{.numbers = {}, .components = components_of(elements.type)};
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
