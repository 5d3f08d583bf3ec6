// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/pose.h"

#include "base/error.h"
#include "base/rounding.h"

#include <cmath>

namespace spherule {
namespace {

// See kRotationEntryError for the error analysis.
Eigen::Matrix3d rotation_matrix(double w, double x, double y, double z, double squared_norm) {
  const double s = 2.0 / squared_norm;
  Eigen::Matrix3d m;
  m << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return m;
}

double squared_norm(double w, double x, double y, double z) {
  return w * w + x * x + y * y + z * z;
}

// Components that are far from 1 are first scaled by a power of two, so that their squares neither
// overflow nor vanish. That changes no bit of the result but where a product is below 2^-1022, and
// there the entries by less than 2^-1000, for s is below 2^62.
Eigen::Matrix3d rotation_matrix(const Eigen::Quaterniond& q) {
  const double n = squared_norm(q.w(), q.x(), q.y(), q.z());
  if (n >= 0x1p-60 && n <= 0x1p60) return rotation_matrix(q.w(), q.x(), q.y(), q.z(), n);
  int exponent = 0;
  std::frexp(q.coeffs().cwiseAbs().maxCoeff(), &exponent);
  const double w = std::ldexp(q.w(), -exponent);
  const double x = std::ldexp(q.x(), -exponent);
  const double y = std::ldexp(q.y(), -exponent);
  const double z = std::ldexp(q.z(), -exponent);
  return rotation_matrix(w, x, y, z, squared_norm(w, x, y, z));
}

// The rotation nearest to a matrix that is within 1e-6 of one: two steps of Newton's iteration for
// the polar factor, X (3 - X^T X) / 2, which squares the deviation each time.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d x = m;
  for (int i = 0; i < 2; ++i) {
    x = (0.5 * x * (3.0 * Eigen::Matrix3d::Identity() - x.transpose() * x)).eval();
  }
  return x;
}

}  // namespace

Eigen::Quaterniond unit_rotation(const Eigen::Quaterniond& q) {
  if (std::abs(q.coeffs().squaredNorm() - 1.0) <= 8.0 * kUnitRoundoff) return q;
  const double scale = q.coeffs().cwiseAbs().maxCoeff();
  return Eigen::Quaterniond(Eigen::Vector4d((q.coeffs() / scale).normalized()));
}

Pose::Pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
    : rotation_(rotation), translation_(translation) {
  if (!rotation.coeffs().allFinite()) throw Error("pose", "the rotation is not finite");
  if (!(rotation.coeffs().cwiseAbs().maxCoeff() > 0.0)) {
    throw Error("pose", "the quaternion is zero, which is no rotation");
  }
  if (!is_usable_point(translation)) {
    throw Error("pose", "the translation is not finite or exceeds 1e15");
  }
  matrix_ = rotation_matrix(rotation);
}

Pose Pose::from_isometry(const Eigen::Isometry3d& target_from_source) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Matrix3d m = target_from_source.linear();
  if (!m.allFinite()) throw Error("pose", "the rotation is not finite");
  const double deviation = (m.transpose() * m - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance) || m.determinant() < 0.0) {
    throw Error("pose", "the matrix is not a rotation");
  }
  return Pose(Eigen::Quaterniond(nearest_rotation(m)), target_from_source.translation());
}

Eigen::Isometry3d Pose::isometry() const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = matrix_;
  result.translation() = translation_;
  return result;
}

Pose Pose::operator*(const Pose& other) const {
  return Pose(unit_rotation(unit_rotation(rotation()) * unit_rotation(other.rotation())),
              *this * other.translation_);
}

Pose Pose::inverse() const {
  return Pose(rotation().conjugate(), -(matrix_.transpose() * translation_));
}

}  // namespace spherule
