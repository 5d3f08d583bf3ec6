// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/internal/node_spheres.h"

#include "spheretree/enclosing_sphere.h"
#include "spheretree/error.h"

#include <array>
#include <bit>
#include <cstdint>
#include <string>

namespace spherule::internal {

void require_usable(std::span<const Sphere> spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!is_usable(spheres[i])) {
      throw Error("sphere tree", "sphere " + std::to_string(i) +
                                     " is not usable: not finite, too large or of negative radius");
    }
  }
}

bool same_bits(const Sphere& a, const Sphere& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return bits(a.center.x()) == bits(b.center.x()) && bits(a.center.y()) == bits(b.center.y()) &&
         bits(a.center.z()) == bits(b.center.z()) && bits(a.radius) == bits(b.radius);
}

Sphere sphere_of(const SphereTreeData& data, std::size_t node) {
  return {{data.x[node], data.y[node], data.z[node]}, data.radius[node]};
}

void set_sphere(SphereTreeData& data, std::size_t node, const Sphere& sphere) {
  data.x[node] = sphere.center.x();
  data.y[node] = sphere.center.y();
  data.z[node] = sphere.center.z();
  data.radius[node] = sphere.radius;
}

Sphere sphere_around_children(const SphereTreeData& data, std::size_t node) {
  const auto first = static_cast<std::size_t>(data.first_child[node]);
  const auto count = static_cast<std::size_t>(data.child_count[node]);
  std::array<Sphere, SphereTree::kMaxBranching> children;
  for (std::size_t i = 0; i < count; ++i) children[i] = sphere_of(data, first + i);
  return enclosing_sphere(std::span<const Sphere>(children).first(count));
}

void check_root(const SphereTreeData& data) {
  if (!(data.radius[0] <= kMaxCoordinate)) {
    throw Error("sphere tree", "the sphere around all spheres is too large");
  }
}

}  // namespace spherule::internal
