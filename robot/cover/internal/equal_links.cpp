// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/equal_links.h"

#include "collide/primitive.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <variant>

namespace spherule::internal {
namespace {

// The bytes of all that says what a shape is: equal shapes have equal ones, and none is the
// beginning of another's.
class ShapeBytes {
 public:
  explicit ShapeBytes(const LinkShape& shape) {
    add(shape.geometry.index());
    if (const auto* const file = std::get_if<MeshFile>(&shape.geometry)) {
      const std::string& path = file->path.native();
      add(path.size());
      bytes_ += path;
      add(file->scale);
    } else {
      const auto& primitive = std::get<Primitive>(shape.geometry);
      add(primitive.index());
      std::visit([this](const auto& solid) { add_sizes(solid); }, primitive);
    }
    add(shape.link_from_shape.rotation().coeffs());
    add(shape.link_from_shape.translation());
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void add_sizes(const Box& box) { add(box.size); }
  void add_sizes(const SolidSphere& sphere) { add(sphere.radius); }
  void add_sizes(const Cylinder& cylinder) { add_all(cylinder.radius, cylinder.length); }
  void add_sizes(const Capsule& capsule) { add_all(capsule.radius, capsule.length); }
  void add_sizes(const HalfSpace&) {}

  void add_all(double first, double second) {
    add(first);
    add(second);
  }

  template <typename Derived>
  void add(const Eigen::MatrixBase<Derived>& vector) {
    for (const double x : vector.eval()) add(x);
  }

  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    bytes_.append(bytes, sizeof number);
  }

  std::string bytes_;
};

}  // namespace

std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry) {
  std::vector<std::size_t> first(robot.links.size());
  std::unordered_map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::string key;
    for (const LinkShape& shape : link_shapes(robot.links[i], geometry)) {
      key += ShapeBytes(shape).bytes();
    }
    first[i] = key.empty() ? i : known.try_emplace(std::move(key), i).first->second;
  }
  return first;
}

}  // namespace spherule::internal
