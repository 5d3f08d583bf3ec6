// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "geometry/vertex_rounding.h"
#include "io/gltf_accessors.h"
#include "io/gltf_document.h"
#include "io/mesh_readers.h"
#include "io/placed_part.h"
#include "io/scene_budget.h"
#include "io/scene_file.h"

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
// What a primitive, or a joint of a skin, costs without its numbers.
constexpr std::size_t kPrimitive = 32;
// Of decimal numbers, and of the few products and the square root that make a matrix of them.
constexpr double kEntryError = 0x1p-50;

// A mesh as its accessors give it, with the weights of its morph targets applied.
struct Primitive {
  TriangleMesh mesh;
  const Json* attributes = nullptr;
};

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
      const std::optional<std::uint64_t> skin = document_.index(entry, "skin");
      const std::vector<Affine> chain = skin ? std::vector<Affine>() : chain_of(node);
      for (Primitive primitive : primitives_of(*mesh, entry)) {
        if (skin) {
          bend(primitive, document_.item("skins", *skin));
        } else {
          budget_.take(primitive.mesh);
          budget_.take_moves(primitive.mesh.vertices.size(), chain.size());
          place(primitive.mesh, chain, 0.0, kEntryError);
        }
        append(result_, primitive.mesh, subject_);
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
    if (!nodes_[node].is_shown) document_.fail("a joint of a skin is not in the scene");
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

  // Read once however often it is shown, but for nodes with weights of their own.
  const std::vector<Primitive>& primitives_of(std::uint64_t index, const Json& node) {
    const Json& mesh = document_.item("meshes", index);
    const std::vector<double> weights = document_.numbers(node, "weights");
    if (!weights.empty()) return morphed_ = read_primitives(mesh, weights);
    const auto [it, is_new] = meshes_.try_emplace(index);
    if (is_new) it->second = read_primitives(mesh, document_.numbers(mesh, "weights"));
    return it->second;
  }

  std::vector<Primitive> read_primitives(const Json& mesh, std::span<const double> weights) {
    std::vector<Primitive> result;
    for (const Json& primitive : document_.list(mesh, "primitives")) {
      budget_.take_steps(kPrimitive);
      const std::uint64_t mode = document_.whole(primitive, "mode", kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kTriangleFan) document_.fail("an unknown kind of primitive");
      Primitive& made = result.emplace_back();
      made.attributes = document_.member(primitive, "attributes");
      if (made.attributes == nullptr) document_.fail("a mesh without positions");
      add_vertices(primitive, weights, made);
      add_triangles(primitive, mode, made.mesh);
      // Parts often share one long list of vertices; joints are given for all of them.
      if (!made.attributes->contains("JOINTS_0")) remove_unused_vertices(made.mesh);
    }
    return result;
  }

  GltfValues positions(const Json& attributes, bool is_signed) {
    const std::optional<std::uint64_t> accessor = document_.index(attributes, "POSITION");
    if (!accessor) document_.fail("a mesh without positions");
    const bool is_quantized = document_.is_quantized();
    return accessors_.read(*accessor, {.type = "VEC3",
                                       .is_float_allowed = true,
                                       .is_whole_allowed = is_quantized,
                                       .is_normalized_allowed = is_quantized,
                                       .is_signed_allowed = is_quantized && is_signed});
  }

  void add_vertices(const Json& primitive, std::span<const double> weights, Primitive& made) {
    const GltfValues base = positions(*made.attributes, true);
    const Json& targets = document_.list(primitive, "targets");
    if (!weights.empty() && weights.size() != targets.size()) {
      document_.fail("a mesh has not as many weights as morph targets");
    }
    std::vector<double> sum = base.numbers;
    std::vector<double> size(sum.size());  // of all that was added
    std::transform(sum.begin(), sum.end(), size.begin(), [](double x) { return std::abs(x); });
    std::size_t added = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] == 0.0 || !targets[i].contains("POSITION")) continue;
      const GltfValues change = positions(targets[i], true);
      if (change.numbers.size() != sum.size()) document_.fail("a morph target of another size");
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] += weights[i] * change.numbers[k];
        size[k] += std::abs(weights[i] * change.numbers[k]);
      }
      ++added;
    }
    // Each term errs by three roundings (normalised number, decimal weight, product), and each
    // addition by one of all that was added; twice that is charged.
    const double terms = (base.is_exact ? 0.0 : 3.0) + 4.0 * static_cast<double>(added);
    made.mesh.vertex_error =
        rounding_distance(*std::max_element(size.begin(), size.end()), 2.0 * terms * kUnitRoundoff);
    made.mesh.vertices.reserve(sum.size() / 3);
    for (std::size_t k = 0; k + 2 < sum.size(); k += 3) {
      made.mesh.vertices.emplace_back(sum[k], sum[k + 1], sum[k + 2]);
    }
  }

  void add_triangles(const Json& primitive, std::uint64_t mode, TriangleMesh& mesh) {
    std::vector<std::int64_t> corners;
    if (const auto accessor = document_.index(primitive, "indices")) {
      const GltfValues list =
          accessors_.read(*accessor, {.type = "SCALAR", .is_whole_allowed = true});
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

  // Moves the vertices with the joints of the skin, in place of the node's own transform (section
  // 3.7.3): v = sum over joints of weight * joint * inverse bind matrix * v.
  void bend(Primitive& primitive, const Json& skin) {
    const std::vector<std::uint64_t> joints = document_.indices(skin, "joints");
    budget_.take(primitive.mesh);
    budget_.take_steps(kPrimitive * joints.size());
    std::vector<Affine> inverse_bind(joints.size());
    if (const auto accessor = document_.index(skin, "inverseBindMatrices")) {
      const GltfValues matrices =
          accessors_.read(*accessor, {.type = "MAT4", .is_float_allowed = true});
      if (matrices.count() < joints.size()) document_.fail("a skin of too few matrices");
      for (std::size_t j = 0; j < joints.size(); ++j) {
        inverse_bind[j] = affine_of(std::span(matrices.numbers).subspan(16 * j, 16));
      }
    }
    SkinnedPart part(primitive.mesh, kEntryError);
    const std::vector<std::vector<JointWeight>> weights = joint_weights(primitive, joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      document_.item("nodes", joints[j]);
      if (weights[j].empty()) continue;
      std::vector<Affine> chain = chain_of(static_cast<std::size_t>(joints[j]));
      chain.push_back(inverse_bind[j]);
      budget_.take_moves(weights[j].size(), chain.size());
      part.add(chain, weights[j]);
    }
    primitive.mesh = part.take();
  }

  // Of each joint the vertices that it moves.
  std::vector<std::vector<JointWeight>> joint_weights(const Primitive& primitive,
                                                      std::size_t joints) {
    const std::size_t vertices = primitive.mesh.vertices.size();
    std::vector<std::vector<JointWeight>> result(joints);
    std::vector<double> sums(vertices, 0.0);
    for (int set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const auto of = document_.index(*primitive.attributes, ("JOINTS_" + number).c_str());
      const auto by = document_.index(*primitive.attributes, ("WEIGHTS_" + number).c_str());
      if (!of || !by) {
        if (set == 0 || of || by) document_.fail("a skinned mesh without joints or weights");
        break;
      }
      const GltfValues joint = accessors_.read(*of, {.type = "VEC4", .is_whole_allowed = true});
      const GltfValues weight = accessors_.read(
          *by, {.type = "VEC4", .is_float_allowed = true, .is_normalized_allowed = true});
      if (joint.count() != vertices || weight.count() != vertices) {
        document_.fail("a skinned mesh without joints or weights of every vertex");
      }
      for (std::size_t k = 0; k < 4 * vertices; ++k) {
        if (weight.numbers[k] == 0.0) continue;
        if (!(weight.numbers[k] > 0.0) || joint.numbers[k] >= static_cast<double>(joints)) {
          document_.fail("a weight or joint of a skinned mesh is out of range");
        }
        result[static_cast<std::size_t>(joint.numbers[k])].push_back({k / 4, weight.numbers[k]});
        sums[k / 4] += weight.numbers[k];
      }
    }
    for (const double sum : sums) {
      if (!(std::abs(sum - 1.0) <= kWeightTolerance)) {
        document_.fail("the weights of a skinned vertex do not add up to 1");
      }
    }
    return result;
  }

  const std::string& subject_;
  GltfDocument document_;
  SceneBudget budget_;
  GltfAccessors accessors_;
  std::vector<std::size_t> shown_;
  std::vector<Node> nodes_;
  std::map<std::uint64_t, std::vector<Primitive>> meshes_;
  std::vector<Primitive> morphed_;  // of the node shown last that has weights
  TriangleMesh result_;
};

}  // namespace

TriangleMesh read_gltf(std::string_view bytes, const std::filesystem::path& path) {
  const std::string subject = path.string();
  return GltfReader(bytes, path, subject).run();
}

}  // namespace spherule::internal
