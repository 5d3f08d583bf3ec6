// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "tests/support/random.h"

#include <Eigen/Core>

#include <string>
#include <string_view>

// Files of each format that read_mesh() reads, written without any code of the library.

namespace spherule::test {

std::string text_stl(const TriangleMesh& mesh, const std::string& name = "part");
std::string binary_stl(const TriangleMesh& mesh, std::string_view header = "header");
std::string obj_text(const TriangleMesh& mesh);
std::string off_text(const TriangleMesh& mesh);

enum class PlyForm { kText, kLittleEndian, kBigEndian };
// Coordinates as floats or as doubles; triangles are lists of 32-bit indices.
std::string ply_bytes(const TriangleMesh& mesh, PlyForm form, bool doubles);

// COLLADA with one node of this matrix, in the unit and with the up axis given ("X_UP", ...).
std::string dae_text(const TriangleMesh& mesh, const Eigen::Matrix4d& matrix,
                     const std::string& meter = "1", const std::string& up = "Z_UP");

// glTF with the buffer inside the text, and the same as GLB; one node under another, each with this
// translation.
std::string gltf_text(const TriangleMesh& mesh, const Eigen::Vector3d& translation);
std::string glb_bytes(const TriangleMesh& mesh, const Eigen::Vector3d& translation);
std::string base64(const std::string& bytes);

// How an archive holds its files: as they are, or deflated with the sizes in ZIP64 records.
enum class Zip { kStored, kDeflated64 };
// 3MF; `model` is the XML of the model part, to which the package refers by `target`.
std::string threemf_bytes(const std::string& model, Zip form = Zip::kStored,
                          const std::string& target = "/3D/3dmodel.model");
std::string threemf_model(const TriangleMesh& mesh, const std::string& item_transform = "");

// The mesh in COLLADA and glTF, in some nodes under each other, with random transforms of every
// kind; in COLLADA also in instances of nodes, as polygons or as strips of one triangle.
std::string random_dae(const TriangleMesh& mesh, Random& random);
std::string random_gltf(const TriangleMesh& mesh, Random& random);

}  // namespace spherule::test
