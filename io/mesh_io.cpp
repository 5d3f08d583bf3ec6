// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh_io.h"

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vertex_rounding.h"
#include "geometry/weld.h"
#include "io/mesh_readers.h"
#include "io/placement.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string>

namespace spherule {
namespace {

TriangleMesh read_by_extension(const std::filesystem::path& path) {
  const std::string subject = path.string();
  const std::string extension = internal::lower_extension(path);
  const std::string bytes = internal::read_regular_file(path);
  if (extension == "stl") return internal::read_stl(bytes, subject);
  if (extension == "obj") return internal::read_obj(bytes, subject);
  if (extension == "ply") return internal::read_ply(bytes, subject);
  if (extension == "off") return internal::read_off(bytes, subject);
  if (extension == "3mf") return internal::read_3mf(bytes, subject);
  if (extension == "dae") return internal::read_collada(bytes, subject);
  if (extension == "gltf" || extension == "glb") return internal::read_gltf(bytes, path);
  if (is_cad_file(path)) throw Error(subject, "is a CAD file, not a mesh (read_cad() reads it)");
  throw Error(subject, "not a mesh format that can be read (STL, OBJ, PLY, OFF, DAE, 3MF, glTF)");
}

void check_weld(double tolerance) {
  if (!(tolerance >= 0.0 && tolerance <= kMaxCoordinate)) {
    throw Error("weld", "must be a coordinate and not negative, not " + std::to_string(tolerance));
  }
}

void append(std::string& bytes, const Eigen::Vector3f& v) {
  for (int k = 0; k < 3; ++k) internal::append_number(bytes, v[k]);
}

}  // namespace

bool is_cad_file(const std::filesystem::path& path) {
  const std::string extension = internal::lower_extension(path);
  return extension == "step" || extension == "stp" || extension == "iges" || extension == "igs";
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
  internal::check_scale(options.scale);
  check_weld(options.weld);
  TriangleMesh mesh = read_by_extension(path);
  if (mesh.triangles.empty()) throw Error(path.string(), "the file holds no triangles");
  internal::apply_scale(mesh, options.scale);
  mesh = internal::weld(mesh);
  validate(mesh, path.string());
  return options.weld > 0.0 ? internal::weld_within(mesh, options.weld) : mesh;
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path) {
  validate(mesh, path.string());
  std::string bytes = "binary STL";  // must not begin with "solid", which marks text
  bytes.resize(80, ' ');
  bytes.reserve(84 + 50 * mesh.triangles.size());
  internal::append_number(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    append(bytes, Eigen::Vector3f((b - a).cross(c - a).stableNormalized().cast<float>()));
    for (const Eigen::Vector3d* corner : {&a, &b, &c}) {
      append(bytes, Eigen::Vector3f(corner->cast<float>()));
    }
    internal::append_number(bytes, std::uint16_t{0});
  }
  write_file_atomically(path, bytes);
}

}  // namespace spherule
