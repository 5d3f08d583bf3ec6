// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_mesh.h"

#include "mesh/io/length_unit.h"
#include "mesh/io/mesh_io.h"
#include "mesh/parsing/input_file.h"
#include "robot/cover/internal/link_subject.h"
#include "robot/cover/internal/primitive_mesh.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>

namespace spherule {
namespace {

// The largest distance of a vertex from the origin.
double size_of(const TriangleMesh& mesh) {
  double size = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) size = std::max(size, norm_upper(v));
  return size;
}

// Of the numbers of a 3MF file, which read_mesh() leaves as they are; of the others that state a
// unit it makes metres.
double metres_per_unit(const std::filesystem::path& path) {
  constexpr double kMicrometres = 1e6;
  if (internal::lower_extension(path) != "3mf") return 1.0;
  return stated_unit(path)->micrometres / kMicrometres;
}

// A factor is off by 2^-53 of itself as it was read from text, and the product by as much.
void scale(TriangleMesh& mesh, const Eigen::Vector3d& factors) {
  if (factors == Eigen::Vector3d::Ones()) return;
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(factors);
  mesh.vertex_error = add_up(mul_up(mesh.vertex_error, factors.cwiseAbs().maxCoeff()),
                             3.0 * kUnitRoundoff * size_of(mesh) + kUnderflow);
  if (factors.prod() > 0.0) return;
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
}

void place(TriangleMesh& mesh, const Pose& link_from_shape) {
  // Pose::operator*.
  const double moved = size_of(mesh) + norm_upper(link_from_shape.translation());
  mesh.vertex_error = add_up(mesh.vertex_error, 41.0 * kUnitRoundoff * moved);
  for (Eigen::Vector3d& v : mesh.vertices) v = link_from_shape * v;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
  if (part.vertices.size() > kMost - mesh.vertices.size()) {
    throw Error(subject, "has too many vertices");
  }
  const auto first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Eigen::Vector3i& t : part.triangles) {
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
  mesh.vertex_error = std::max(mesh.vertex_error, part.vertex_error);
}

struct MeshOf {
  double chord_error;
  double weld;
  const std::string& subject;

  TriangleMesh operator()(const MeshFile& file) const {
    if (!file.scale.allFinite() || file.scale.cwiseAbs().minCoeff() == 0.0) {
      throw Error(subject, "the scale of " + file.path.string() + " must be finite and not 0");
    }
    const double unit = metres_per_unit(file.path);
    TriangleMesh mesh =
        read_mesh(file.path, {.scale = unit, .weld = weld / file.scale.cwiseAbs().maxCoeff()});
    // The unit is off by 2^-53 of itself.
    if (unit != 1.0) {
      mesh.vertex_error = add_up(mesh.vertex_error, 2.0 * kUnitRoundoff * size_of(mesh));
    }
    scale(mesh, file.scale);
    validate(mesh, file.path.string() + " as scaled");
    return mesh;
  }
  TriangleMesh operator()(const Primitive& primitive) const {
    return internal::mesh_around(primitive, chord_error, subject);
  }
};

}  // namespace

std::span<const LinkShape> link_shapes(const LinkDescription& link, LinkGeometry geometry) {
  return geometry == LinkGeometry::kCollision ? link.collision : link.visual;
}

std::optional<TriangleMesh> link_mesh(const LinkDescription& link, const LinkMeshOptions& options) {
  const std::span<const LinkShape> shapes = link_shapes(link, options.geometry);
  if (shapes.empty()) return std::nullopt;
  const std::string subject = internal::subject_of(link.name);
  TriangleMesh mesh;
  for (const LinkShape& shape : shapes) {
    TriangleMesh part =
        std::visit(MeshOf{options.chord_error, options.weld, subject}, shape.geometry);
    place(part, shape.link_from_shape);
    append(mesh, part, subject);
  }
  validate(mesh, subject);
  return mesh;
}

}  // namespace spherule
