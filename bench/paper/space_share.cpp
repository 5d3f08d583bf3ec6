// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/space_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace spherule {
namespace {

// Cells whose centres lie within `reach` of `center`: the first and the one behind the last.
struct Cells {
  int begin;
  int end;

  Cells(double center, double reach, int count)
      : begin(static_cast<int>(std::clamp(std::ceil(center - reach - 0.5), 0.0, double(count)))),
        end(static_cast<int>(
            std::clamp(std::floor(center + reach - 0.5) + 1.0, double(begin), double(count)))) {}
};

}  // namespace

double uncovered_share(const ExternalSpheres& external, int along) {
  const Eigen::Vector3d size = external.box.sizes();
  const double cell = size.maxCoeff() / along;
  std::array<int, 3> count{};
  for (int i = 0; i < 3; ++i) count[static_cast<std::size_t>(i)] = std::max(1, int(size[i] / cell));
  const auto [nx, ny, nz] = count;
  const Eigen::Vector3d scale(nx / size.x(), ny / size.y(), nz / size.z());
  const auto width = static_cast<std::size_t>(nx) + 1;
  // Of each row of cells: how many more spheres cover a cell than the one before it.
  std::vector<int> change(width * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  for (const Sphere& sphere : external.spheres) {
    const Eigen::Vector3d center = (sphere.center - external.box.min()).cwiseProduct(scale);
    const Cells z(center.z(), sphere.radius * scale.z(), nz);
    for (int k = z.begin; k < z.end; ++k) {
      const double dz = (k + 0.5 - center.z()) / scale.z();
      const double in_layer = std::sqrt(std::max(0.0, sphere.radius * sphere.radius - dz * dz));
      const Cells y(center.y(), in_layer * scale.y(), ny);
      for (int j = y.begin; j < y.end; ++j) {
        const double dy = (j + 0.5 - center.y()) / scale.y();
        const double in_row = std::sqrt(std::max(0.0, in_layer * in_layer - dy * dy));
        const Cells x(center.x(), in_row * scale.x(), nx);
        int* const row = change.data() + width * static_cast<std::size_t>(k * ny + j);
        ++row[x.begin];
        --row[x.end];
      }
    }
  }
  std::size_t uncovered = 0;
  for (std::size_t row = 0; row < change.size(); row += width) {
    int covering = 0;
    for (std::size_t i = 0; i + 1 < width; ++i) {
      covering += change[row + i];
      if (covering == 0) ++uncovered;
    }
  }
  return static_cast<double>(uncovered) /
         (static_cast<double>(nx) * static_cast<double>(ny) * static_cast<double>(nz));
}

}  // namespace spherule
