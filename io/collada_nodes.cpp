// SPDX-License-Identifier: BSD-3-Clause
#include "io/collada_nodes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

namespace spherule::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Element = ColladaDocument::Element;

Affine transform_of(const ColladaDocument& document, const Element& element) {
  const std::string_view name = element.Name();
  const std::vector<double> numbers = document.numbers(element);
  const std::size_t needed = name == "matrix" ? 16 : name == "rotate" ? 4 : 3;
  if (numbers.size() != needed) {
    document.fail(element, "has " + std::to_string(numbers.size()) + " numbers, not " +
                               std::to_string(needed));
  }
  if (name == "matrix") return collada_matrix(document, element, numbers);
  const Vector3d vector(numbers[0], numbers[1], numbers[2]);
  if (name == "translate") return {Matrix3d::Identity(), vector};
  if (name == "scale") return {Matrix3d(vector.asDiagonal()), Vector3d::Zero()};
  const double degrees = std::fmod(numbers[3], 360.0);  // exact
  if (degrees == 0.0) return {Matrix3d::Identity(), Vector3d::Zero()};
  const Vector3d axis = vector.stableNormalized();
  if (!(std::abs(axis.norm() - 1.0) < 1e-9)) document.fail(element, "has no axis");
  const Eigen::AngleAxisd turn(degrees * (std::numbers::pi / 180.0), axis);
  return {turn.toRotationMatrix(), Vector3d::Zero()};
}

}  // namespace

std::vector<Affine> collada_transforms(const ColladaDocument& document, const Element& node) {
  std::vector<Affine> result;
  for (const Element* at = node.FirstChildElement(); at != nullptr; at = at->NextSiblingElement()) {
    const std::string_view name = at->Name();
    if (name == "skew" || name == "lookat") document.fail(*at, "is not supported");
    if (name != "matrix" && name != "rotate" && name != "translate" && name != "scale") continue;
    const Affine made = transform_of(document, *at);
    if (made.linear != Matrix3d::Identity() || !made.offset.isZero(0.0)) result.push_back(made);
  }
  return result;
}

Affine collada_matrix(const ColladaDocument& document, const Element& element,
                      std::span<const double> entries) {
  if (entries.size() != 16) document.fail(element, "has not 16 numbers");
  const std::optional<Affine> result =
      affine_from(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(entries.data()));
  if (!result) document.fail(element, "is a transform that is not affine and finite");
  return *result;
}

}  // namespace spherule::internal
