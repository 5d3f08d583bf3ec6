// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/json.h"
#include "io/placement.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The JSON and the numbers of a glTF or GLB file (Khronos, "glTF 2.0 Specification"), with checked
// access.

namespace spherule::internal {

class GltfDocument {
 public:
  using Json = nlohmann::json;

  // `subject` names the file in an Error; it and `bytes` have to outlive the document. Throws Error
  // if the file is not glTF 2, names a member of an object twice, is nested deeper than
  // kDeepestJson or requires an extension that may change where its meshes are.
  GltfDocument(std::string_view bytes, const std::string& subject);

  const Json& root() const { return root_; }
  // The binary chunk of a GLB file.
  std::optional<std::string_view> binary_chunk() const { return binary_chunk_; }
  // Whether the file requires KHR_mesh_quantization: positions may be whole numbers.
  bool is_quantized() const { return is_quantized_; }

  // Of an object: a whole number that is not negative, `absent` if there is none.
  std::uint64_t whole(const Json& object, const char* key, std::uint64_t absent) const;
  std::optional<std::uint64_t> index(const Json& object, const char* key) const;
  // Indices or finite numbers; empty if there is no such list.
  std::vector<std::uint64_t> indices(const Json& object, const char* key) const;
  std::vector<double> numbers(const Json& object, const char* key) const;
  // A string, empty if there is none.
  std::string text(const Json& object, const char* key) const;
  // The list of objects, empty if there is none.
  const Json& list(const Json& object, const char* key) const;
  // The object that a reference names.
  const Json& item(const char* list, std::uint64_t index) const;
  // The member that is an object, or null.
  const Json* member(const Json& object, const char* key) const;

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void split_container(std::string_view bytes);
  void check_extensions();

  const std::string& subject_;
  std::string_view json_;
  std::optional<std::string_view> binary_chunk_;
  Json root_;
  bool is_quantized_ = false;
};

// Values of an accessor, element by element.
struct GltfValues {
  std::vector<double> numbers;
  std::size_t components = 1;  // of an element
  bool is_exact = true;        // false for normalised whole numbers, of which each is rounded

  std::size_t count() const { return numbers.size() / components; }
};

// What an accessor is read for, which decides on the type of its elements and of their components.
enum class GltfUse {
  kPositions,           // VEC3 of floats
  kQuantizedPositions,  // VEC3, of whole numbers too
  kIndices,             // SCALAR of whole numbers without a sign
};

// Reads buffers and the accessors on them. Every offset, stride and count is checked against the
// bytes that are there. Buffers come from the binary chunk of a GLB file, from data URIs, and from
// files in the folder of the glTF file or below it; others are refused.
class GltfAccessors {
 public:
  // All have to outlive the object.
  GltfAccessors(const GltfDocument& document, const std::filesystem::path& file,
                SceneBudget& budget);

  GltfValues read(std::uint64_t accessor, GltfUse use);

 private:
  // Where consecutive elements are.
  struct Layout {
    std::string_view bytes;
    std::size_t stride = 0;
  };

  std::string_view buffer(std::uint64_t index);
  // The bytes of a URI, which stay with the object; a file is read once.
  std::string_view load(const std::string& uri);
  Layout layout(const GltfDocument::Json& place, std::size_t size, std::size_t count,
                bool may_stride);
  void add_sparse(const GltfDocument::Json& sparse, std::uint64_t type, std::size_t count,
                  bool is_normalized, GltfValues& values);

  const GltfDocument& document_;
  const std::filesystem::path& file_;
  SceneBudget& budget_;
  std::map<std::uint64_t, std::string_view> buffers_;  // by number
  std::map<std::string, std::string> files_;           // by URI
  std::list<std::string> decoded_;                     // of data URIs
};

}  // namespace spherule::internal
