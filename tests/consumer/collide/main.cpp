// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <spherule/collide.h>
#include <vector>

// Two rows of ten spheres of radius 1, side by side: apart, then moved into each other.
int main() {
  std::vector<spherule::Sphere> row;
  for (int i = 0; i < 10; ++i) row.push_back({.center = {2.0 * i, 0.0, 0.0}, .radius = 1.0});
  const spherule::SphereTree a = spherule::build_tree(row);
  const spherule::SphereTree b = spherule::build_tree(row);

  const auto apart = spherule::Pose::from_translation({0.0, 3.0, 0.0});
  const auto touching = spherule::Pose::from_translation({0.0, 2.0, 0.0});
  const spherule::DistanceResult gap = spherule::distance(a, {}, b, apart);
  std::cout << "gap: " << gap.lower << " to " << gap.upper << "\n";
  const bool right = !spherule::collides(a, {}, b, apart) &&
                     spherule::collides(a, {}, b, touching) && gap.lower <= 1.0 && gap.upper >= 1.0;
  return right ? 0 : 1;
}
