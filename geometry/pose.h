// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Rigid motions, exact in what they store.
//
// @code{.cpp}
// #include <spherule/geometry/pose.h>
// #include <cassert>
//
// const spherule::Pose world_from_base = spherule::Pose::from_translation({0, 0, 2});
// const spherule::Pose base_from_tool({0, 0, 0, 1}, {1, 0, 0});  // w, x, y, z: half a turn about z
// const spherule::Pose world_from_tool = world_from_base * base_from_tool;
// const Eigen::Vector3d point = world_from_tool * Eigen::Vector3d(3, 0, 0);
// assert((point - Eigen::Vector3d(-2, 0, 2)).norm() < 1e-14);
// @endcode

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spherule {

// Bound on the difference between an entry of Pose::matrix() and the same entry of the exact
// rotation of q / norm(q), u = 2^-53. With n = q.q (relative error 4 u, four squares and three sums
// of positive terms) and s = 2 / n (5 u): a diagonal entry is 1 - s (a^2 + b^2), whose product
// carries 8 u of a value of at most 2, and the subtraction 1 u more; an off-diagonal entry
// s (a b +- c d) carries 7 u of a value of at most 1 and 1 u from the two products, because
// |a b| + |c d| <= n / 2. So 17 u to first order. The remaining 3 u cover the terms of second order
// and components so small beside the largest that they or their squares underflow (below 2^-1000).
inline constexpr double kRotationEntryError = 20.0 * 0x1p-53;

// A rigid motion, named target_from_source: it maps a point given in the source frame to the target
// frame, p_target = R(q / norm(q)) p_source + t. The pose *is* the stored quaternion and
// translation, exactly; every guarantee is about that motion, and the matrix is a rounded image of
// it. Checked when made: a Pose is always finite and a rotation, so queries need no check.
class Pose {
 public:
  // The identity.
  Pose() = default;

  // Any finite quaternion that is not zero; it is stored as given, not normalised.
  // Throws Error if a number is not finite, the quaternion is zero, or a translation exceeds
  // kMaxCoordinate.
  Pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

  // Throws Error also if the linear part is not a rotation: R^T R must be the identity to within
  // 1e-6 an entry and the determinant positive. The rotation nearest to the matrix is taken, up to
  // rounding.
  static Pose from_isometry(const Eigen::Isometry3d& target_from_source);

  // A shift without a turn.
  static Pose from_translation(const Eigen::Vector3d& translation) {
    return Pose(Eigen::Quaterniond::Identity(), translation);
  }

  // What is stored, exactly.
  Eigen::Quaterniond rotation() const { return Eigen::Quaterniond(rotation_); }
  const Eigen::Vector3d& translation() const { return translation_; }

  // The rotation matrix, each entry within kRotationEntryError of the exact one.
  const Eigen::Matrix3d& matrix() const { return matrix_; }

  // This motion as Eigen has it, with the rounded matrix().
  Eigen::Isometry3d isometry() const;

  // The error of a mapped point is at most 40 u (|p| + |t|). Proof: of the matrix's error, what
  // comes from s is a multiple of R - I, of norm at most 2 * 5 u; the rest is at most 3 u d + u on
  // the diagonal, where the d are at most 2 and sum up to at most 4, and 3 u elsewhere: 12.4 u in
  // the Frobenius norm. The product adds 3 u |p| a row, 5.2 u |p| in all, the sum 1 u (|p| + |t|).
  // Together below 29 u.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return matrix_ * p + translation_; }

  // Composition a_from_c = a_from_b * b_from_c and inverse, rounded: the result is a pose in its
  // own right, exact in the sense above, and maps a point to within 80 u (|p| + |t_a| + |t_b|) of
  // where the two motions take it. Rotations are renormalised, so chains stay unit. Throws Error if
  // the translation of the result exceeds kMaxCoordinate.
  Pose operator*(const Pose& other) const;
  Pose inverse() const;

 private:
  // Not aligned, so that the layout does not depend on the instruction set a user compiles for.
  Eigen::Quaternion<double, Eigen::DontAlign> rotation_{1.0, 0.0, 0.0, 0.0};
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
};

// The rotation of `q`, rounded to nearest, as a quaternion of unit length, so that chains can be
// composed without renormalising. Returned as it is where it is unit already, to within 8 u of the
// squared length. `q` must be finite and not zero.
Eigen::Quaterniond unit_rotation(const Eigen::Quaterniond& q);

}  // namespace spherule
