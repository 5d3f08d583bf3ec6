// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/simplified_probe.h"

namespace spherule::internal {

using Eigen::Vector3d;

double SimplifiedProbe::clearance(const Vector3d& point) const {
  const ClearanceAt at = clearance_(point);
  if (at.upper >= 0.0) return at.lower;
  // Out of a single sphere a point of S is as far as its surface; of several, the mesh is in S.
  const double way = -1.01 * at.lower;
  if (clearance_(point + way * at.away, way).lower >= 0.0) return -way;
  return -distance_(point).upper;
}

Vector3d SimplifiedProbe::nearest_boundary(const Vector3d& point) const {
  const ClearanceAt at = clearance_(point);
  return point - at.upper * at.away;
}

}  // namespace spherule::internal
