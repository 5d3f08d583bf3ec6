// SPDX-License-Identifier: BSD-3-Clause
#include "io/gltf_document.h"

#include "base/error.h"
#include "base/text.h"

#include <array>
#include <cmath>
#include <cstring>

namespace spherule::internal {
namespace {

using Json = GltfDocument::Json;

constexpr std::size_t kHeader = 12;      // of a GLB file: magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length and type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::array<unsigned char, 4> image{};
  std::memcpy(image.data(), bytes.data() + at, image.size());
  return image[0] | std::uint32_t{image[1]} << 8 | std::uint32_t{image[2]} << 16 |
         std::uint32_t{image[3]} << 24;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, const std::string& subject) : subject_(subject) {
  split_container(bytes);
  document_.emplace(parse_json<Json>(json_, [&](const std::string& reason) {
    fail((json_.size() < bytes.size() ? "in its JSON: " : "") + reason);
  }));
  if (!root().is_object()) fail("not a glTF file");
  const Json* const asset = member(root(), "asset");
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
  if (word_at(bytes, 4) != 2) fail("not glTF of version 2");
  if (word_at(bytes, 8) != bytes.size()) fail("the file is cut short, or longer than it says");
  bool has_json = false;
  for (std::size_t at = kHeader; at < bytes.size();) {
    if (bytes.size() - at < kChunkHeader) fail("the file is cut short");
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
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

}  // namespace spherule::internal
