// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/gltf_document.h"
#include "io/scene_budget.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// Values of an accessor, element by element.
struct GltfValues {
  std::vector<double> numbers;
  std::size_t components = 1;  // of an element
  bool is_exact = true;        // false for normalised whole numbers, of which each is rounded

  std::size_t count() const { return numbers.size() / components; }
};

// What elements an accessor may have: the type ("VEC3"), and which types of components.
struct GltfElements {
  const char* type;
  bool is_float_allowed = false;
  bool is_whole_allowed = false;  // without a sign
  bool is_normalized_allowed = false;
  bool is_signed_allowed = false;
};

// Reads buffers and the accessors on them. Every offset, stride and count is checked against the
// bytes that are there. Buffers come from the binary chunk of a GLB file, from data URIs, and from
// files in the folder of the glTF file or below it; others are refused.
class GltfAccessors {
 public:
  // All have to outlive the object.
  GltfAccessors(const GltfDocument& document, const std::filesystem::path& file,
                SceneBudget& budget);

  GltfValues read(std::uint64_t accessor, const GltfElements& elements);

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
