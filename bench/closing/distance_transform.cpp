// SPDX-License-Identifier: BSD-3-Clause
#include "bench/closing/distance_transform.h"

#include <cstddef>
#include <limits>

namespace spherule::closing {
namespace {

// The lower envelope of parabolas along one line.
class Envelope {
 public:
  explicit Envelope(std::size_t count) : apex_(count), from_(count + 1), height_(count) {}

  void operator()(float* line, std::size_t count, std::size_t stride) {
    std::size_t used = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const double height = line[q * stride];
      if (height >= kFar) continue;
      const auto at = static_cast<double>(q);
      double from = -std::numeric_limits<double>::infinity();
      while (used > 0) {
        const double other = apex_[used - 1];
        from = (height + at * at - height_[used - 1] - other * other) / (2.0 * (at - other));
        if (from > from_[used - 1]) break;
        --used;
      }
      if (used == 0) from = -std::numeric_limits<double>::infinity();
      apex_[used] = at;
      height_[used] = height;
      from_[used++] = from;
    }
    if (used == 0) return;
    std::size_t k = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const auto at = static_cast<double>(q);
      while (k + 1 < used && from_[k + 1] < at) ++k;
      const double away = at - apex_[k];
      line[q * stride] = static_cast<float>(away * away + height_[k]);
    }
  }

 private:
  std::vector<double> apex_;
  std::vector<double> from_;
  std::vector<double> height_;
};

}  // namespace

void transform_distances(const Grid& grid, std::vector<float>& heights) {
  const auto nx = static_cast<std::size_t>(grid.count[0]);
  const auto ny = static_cast<std::size_t>(grid.count[1]);
  const auto nz = static_cast<std::size_t>(grid.count[2]);
  in_parallel(nz, [&](std::size_t z) {
    Envelope along_x(nx);
    Envelope along_y(ny);
    float* const layer = heights.data() + z * nx * ny;
    for (std::size_t y = 0; y < ny; ++y) along_x(layer + y * nx, nx, 1);
    for (std::size_t x = 0; x < nx; ++x) along_y(layer + x, ny, nx);
  });
  in_parallel(ny, [&](std::size_t y) {
    Envelope along_z(nz);
    for (std::size_t x = 0; x < nx; ++x) along_z(heights.data() + y * nx + x, nz, nx * ny);
  });
}

}  // namespace spherule::closing
