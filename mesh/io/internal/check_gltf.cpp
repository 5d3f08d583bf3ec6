// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/scene_file.h"
#include "spheretree/error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <set>
#include <vector>

namespace spherule::internal {
namespace {

using Json = nlohmann::json;

// Values of the glTF 2.0 specification.
constexpr std::uint64_t kUint8 = 5121, kUint16 = 5123, kUint32 = 5125, kFloat = 5126;
constexpr std::uint64_t kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

// The JSON of a GLB file is its first chunk, after a header of three words and its own of two.
std::string_view json_part(std::string_view bytes, const std::string& subject) {
  constexpr std::size_t kChunkData = 20;
  if (!bytes.starts_with("glTF")) return bytes;
  std::uint32_t words[5] = {};
  if (bytes.size() < kChunkData) throw Error(subject, "the file is cut short");
  std::memcpy(words, bytes.data(), kChunkData);
  if (words[2] != bytes.size() || words[3] > bytes.size() - kChunkData) {
    throw Error(subject, "the file is cut short, or longer than it says");
  }
  return bytes.substr(kChunkData, words[3]);
}

class Checker {
 public:
  Checker(const Json& root, const std::string& subject) : root_(root), subject_(subject) {}

  // Number of triangles of the meshes that the scene shows, each counted once.
  std::size_t run() {
    check_extensions();
    const std::uint64_t scene = number(root_, "scene");
    if (scene == kAbsent) fail("it names no scene to show");
    const Json& shown = item("scenes", scene);
    std::vector<std::uint64_t> open = indices(shown, "nodes");
    std::set<std::uint64_t> seen(open.begin(), open.end());
    std::set<std::uint64_t> meshes;
    while (!open.empty()) {
      const Json& node = item("nodes", open.back());
      open.pop_back();
      if (const std::uint64_t mesh = number(node, "mesh"); mesh != kAbsent) meshes.insert(mesh);
      for (const std::uint64_t child : indices(node, "children")) {
        if (!seen.insert(child).second) fail("a node has two parents");
        open.push_back(child);
      }
    }
    std::size_t triangles = 0;
    for (const std::uint64_t mesh : meshes) triangles += count_triangles(item("meshes", mesh));
    return triangles;
  }

 private:
  static constexpr std::uint64_t kAbsent = ~std::uint64_t{0};

  [[noreturn]] void fail(const std::string& reason) const { throw Error(subject_, reason); }

  std::uint64_t number(const Json& object, const char* key) const {
    const auto it = object.find(key);
    if (it == object.end()) return kAbsent;
    if (!it->is_number_unsigned()) fail(std::string("'") + key + "' is not a whole number");
    return it->get<std::uint64_t>();
  }

  std::vector<std::uint64_t> indices(const Json& object, const char* key) const {
    std::vector<std::uint64_t> result;
    const auto it = object.find(key);
    if (it == object.end()) return result;
    for (const Json& entry : *it) {
      if (!entry.is_number_unsigned()) fail(std::string("'") + key + "' is not a list of indices");
      result.push_back(entry.get<std::uint64_t>());
    }
    return result;
  }

  const Json& item(const char* list, std::uint64_t index) const {
    const auto it = root_.find(list);
    if (it == root_.end() || !it->is_array() || index >= it->size() ||
        !(*it)[static_cast<std::size_t>(index)].is_object()) {
      fail(std::string("it refers to an entry of '") + list + "' that is not there");
    }
    return (*it)[static_cast<std::size_t>(index)];
  }

  // Extensions that change how things look are no matter; any other that a reader must know may
  // change where they are.
  void check_extensions() const {
    const auto asset = root_.find("asset");
    const std::string version = asset == root_.end() ? "" : asset->value("version", "");
    if (!version.starts_with("2.")) fail("not glTF of version 2");
    const auto required = root_.find("extensionsRequired");
    if (required == root_.end()) return;
    for (const Json& entry : *required) {
      const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
      const bool appearance_only =
          name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
          name.starts_with("KHR_lights_") || name.starts_with("EXT_texture_");
      if (!appearance_only) fail("it requires the extension " + name + ", which is not supported");
    }
  }

  // Number of elements of an accessor that must be of one of the types given.
  std::uint64_t count(std::uint64_t index, const char* shape,
                      const std::set<std::uint64_t>& types) {
    const Json& accessor = item("accessors", index);
    if (accessor.value("type", "") != shape || !types.contains(number(accessor, "componentType")) ||
        accessor.value("normalized", false)) {
      fail("positions must be vectors of 32-bit floats, and indices whole numbers");
    }
    if (accessor.contains("sparse")) fail("sparse accessors are not supported");
    item("bufferViews", number(accessor, "bufferView"));
    const std::uint64_t result = number(accessor, "count");
    if (result == kAbsent || result > (std::uint64_t{1} << 32)) fail("an accessor of no count");
    return result;
  }

  std::size_t count_triangles(const Json& mesh) {
    std::uint64_t triangles = 0;
    for (const Json& primitive : mesh.value("primitives", Json::array())) {
      const std::uint64_t given = number(primitive, "mode");
      const std::uint64_t mode = given == kAbsent ? kTriangles : given;
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kTriangleFan) fail("an unknown kind of primitive");
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end()) fail("a mesh without positions");
      const std::uint64_t vertices = count(number(*attributes, "POSITION"), "VEC3", {kFloat});
      const std::uint64_t list = number(primitive, "indices");
      const std::uint64_t corners =
          list == kAbsent ? vertices : count(list, "SCALAR", {kUint8, kUint16, kUint32});
      if (corners < 3 || (mode == kTriangles && corners % 3 != 0)) fail("an incomplete triangle");
      triangles += mode == kTriangles ? corners / 3 : corners - 2;
    }
    static_assert(kTriangleStrip == kTriangles + 1 && kTriangleFan == kTriangles + 2);
    return static_cast<std::size_t>(triangles);
  }

  const Json& root_;
  const std::string& subject_;
};

}  // namespace

std::size_t check_gltf(std::string_view bytes, const std::string& subject) {
  const Json root = Json::parse(json_part(bytes, subject), nullptr, false);
  if (!root.is_object()) throw Error(subject, "not a glTF file");
  try {
    return Checker(root, subject).run();
  } catch (const Json::exception&) {
    throw Error(subject, "not a glTF file");
  }
}

}  // namespace spherule::internal
