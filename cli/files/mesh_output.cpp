// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/mesh_output.h"

#include "base/error.h"
#include "base/files.h"
#include "io/mesh_io.h"
#include "simplifier/baseline/convex_decomposition.h"

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <limits>
#include <sstream>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// With all digits of a double.
std::ostringstream exact_text() {
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  return out;
}

void put(std::ostream& out, const Eigen::Vector3d& v) {
  out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
}

std::string obj_text(std::span<const TriangleMesh> meshes) {
  std::ostringstream out = exact_text();
  int first = 1;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    out << "o part-" << i + 1 << '\n';
    for (const Eigen::Vector3d& v : meshes[i].vertices) put(out << "v ", v);
    for (const Eigen::Vector3i& t : meshes[i].triangles) {
      out << "f " << t[0] + first << ' ' << t[1] + first << ' ' << t[2] + first << '\n';
    }
    first += static_cast<int>(meshes[i].vertices.size());
  }
  return out.str();
}

std::string ply_text(const TriangleMesh& mesh) {
  std::ostringstream out = exact_text();
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& v : mesh.vertices) put(out, v);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
  return out.str();
}

}  // namespace

void check_mesh_output(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (fs::is_directory(path)) return;
  if (extension != ".stl" && extension != ".obj" && extension != ".ply") {
    throw Error(path.string(), "not a mesh format that can be written (STL, OBJ, PLY)");
  }
}

bool rounds_coordinates(const fs::path& path) {
  return !fs::is_directory(path) && lower_extension(path) == ".stl";
}

void write_meshes(std::span<const TriangleMesh> meshes, const fs::path& path) {
  check_mesh_output(path);
  const std::string extension = lower_extension(path);
  if (fs::is_directory(path)) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      std::ostringstream name;
      name << "part-" << std::setw(4) << std::setfill('0') << i + 1 << ".obj";
      write_file_atomically(path / name.str(), obj_text(meshes.subspan(i, 1)));
    }
  } else if (extension == ".obj") {
    write_file_atomically(path, obj_text(meshes));
  } else {
    const TriangleMesh all = join_parts({meshes.begin(), meshes.end()});
    if (extension == ".ply") write_file_atomically(path, ply_text(all));
    if (extension == ".stl") write_stl(all, path);
  }
}

}  // namespace spherule
