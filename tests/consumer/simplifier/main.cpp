// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <spherule/simplifier.h>

// Covers a cube of side 100 and requires the proof.
int main() {
  spherule::TriangleMesh cube;
  for (int corner = 0; corner < 8; ++corner) {
    cube.vertices.emplace_back(corner & 1 ? 100.0 : 0.0, corner & 2 ? 100.0 : 0.0,
                               corner & 4 ? 100.0 : 0.0);
  }
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const spherule::Simplification result =
      spherule::simplify(cube, {.max_error = 10.0, .effort = 0});
  std::cout << result.cover.spheres.size() << " spheres, "
            << (result.certificate.covered ? "covered" : "not covered") << "\n";
  return result.certificate.covered ? 0 : 1;
}
