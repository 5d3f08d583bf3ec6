// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/json.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The JSON of a glTF or GLB file (Khronos, "glTF 2.0 Specification"), with checked access.

namespace spherule::internal {

class GltfDocument {
 public:
  using Json = nlohmann::json;

  // `subject` names the file in an Error; it and `bytes` have to outlive the document. Throws Error
  // if the file is not glTF 2, names a member of an object twice, is nested deeper than
  // kDeepestJson or requires an extension that may change where its meshes are.
  GltfDocument(std::string_view bytes, const std::string& subject);

  const Json& root() const { return document_->root(); }
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
  std::optional<JsonDocument<Json>> document_;
  bool is_quantized_ = false;
};

}  // namespace spherule::internal
