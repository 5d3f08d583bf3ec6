// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "geometry/vertex_rounding.h"
#include "io/gltf_data.h"
#include "io/mesh_readers.h"
#include "io/placement.h"
#include "io/polygon_triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Json = GltfDocument::Json;

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
