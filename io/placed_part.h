// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Meshes that a file shows under transforms.

namespace spherule::internal {

// Not to be changed once it is made, or `gain` is wrong.
struct Affine {
  Affine() = default;
  Affine(const Eigen::Matrix3d& of_linear, const Eigen::Vector3d& of_offset);

  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  // An upper bound of the spectral norm of `linear`, found once, as every instance needs it.
  double gain = 1.0;
};

// The transform of a matrix for column vectors; nothing if it is not affine or not finite.
std::optional<Affine> affine_from(const Eigen::Matrix4d& matrix);

// Moves the mesh by the last transform of the chain, then by the one before, up to the first, and
// adds to its `vertex_error`. The coordinates are off by at most that and `coordinate_error` of the
// largest, and the entries of a transform by at most `entry_error` of its norms. Where the chain
// mirrors, the triangles are turned over (glTF 2.0, 3.7.4), so that what is closed keeps its
// inside.
void place(TriangleMesh& part, std::span<const Affine> chain, double coordinate_error,
           double entry_error);

// What a vertex weighs in a joint that moves it.
struct JointWeight {
  std::size_t vertex = 0;
  double weight = 0.0;
};

// The weights of a vertex have to add up to 1 within this.
inline constexpr double kWeightTolerance = 1e-3;

// A mesh whose vertices are moved by joints: each goes to the weighted sum of where its joints take
// it.
class SkinnedPart {
 public:
  // The mesh at rest, with its `vertex_error`.
  SkinnedPart(const TriangleMesh& rest, double entry_error);

  // A joint moves the vertices that weigh in it by the chain of transforms, as place() does.
  void add(std::span<const Affine> chain, std::span<const JointWeight> weights);

  TriangleMesh take();

 private:
  const TriangleMesh& rest_;
  double entry_error_;
  struct Sum {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double size = 0.0;   // of all terms, added up
    double error = 0.0;  // of where joints take it, weighted
    int terms = 0;
  };
  std::vector<Sum> sums_;  // of each vertex
};

// Adds the triangles of the part to the mesh.
void append(TriangleMesh& mesh, const TriangleMesh& part, const std::string& subject);

}  // namespace spherule::internal
