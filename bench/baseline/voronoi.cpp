// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/medial_spheres.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <libqhull_r/qhull_ra.h>
#include <limits>
#include <memory>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Tetrahedron = std::array<std::uint32_t, 4>;

// A tetrahedron with pivots (its heights, about) this much apart has no digits of a centre; four
// sites on a circle would have one in their plane, which is no vertex.
constexpr double kFlat = 1e-10;

// One run of qhull with what it allocates.
class Delaunay {
 public:
  // `points` have to stay while this lives.
  explicit Delaunay(std::vector<Vector3d>& points) : messages_(std::tmpfile(), &std::fclose) {
    if (!messages_) throw Error("Voronoi diagram", "no temporary file for messages");
    qh_zero(&qhull_, messages_.get());
    // Qbb and Qz scale the lifted coordinate and add a point at infinity, against sites on one
    // sphere; Qt turns what is not a simplex into simplices; Pp leaves warnings out.
    char command[] = "qhull d Qbb Qz Qt Pp";
    status_ = qh_new_qhull(&qhull_, 3, static_cast<int>(points.size()), points.front().data(),
                           False, command, nullptr, messages_.get());
  }
  ~Delaunay() {
    qh_freeqhull(&qhull_, !qh_ALL);
    int used = 0;
    int total = 0;
    qh_memfreeshort(&qhull_, &used, &total);
  }
  Delaunay(const Delaunay&) = delete;
  Delaunay& operator=(const Delaunay&) = delete;

  // The input has no tetrahedra.
  bool is_flat() const { return status_ == qh_ERRsingular; }
  bool has_failed() const { return status_ != 0 && !is_flat(); }

  std::vector<Tetrahedron> tetrahedra(std::size_t sites) {
    std::vector<Tetrahedron> result;
    for (const facetT* f = qhull_.facet_list; f != nullptr && f->next != nullptr; f = f->next) {
      if (f->upperdelaunay || !f->simplicial || f->vertices == nullptr) continue;
      Tetrahedron corners{};
      std::size_t count = 0;
      for (const setelemT* e = f->vertices->e; e->p != nullptr && count < 4; ++e) {
        const int id = qh_pointid(&qhull_, static_cast<const vertexT*>(e->p)->point);
        if (id < 0 || static_cast<std::size_t>(id) >= sites) break;
        corners[count++] = static_cast<std::uint32_t>(id);
      }
      if (count == 4) result.push_back(corners);
    }
    return result;
  }

 private:
  qhT qhull_{};
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages_;
  int status_ = 0;
};

// Centre of the sphere through the four corners; not a number where they lie in a plane.
Vector3d circumcenter(const std::array<Vector3d, 4>& corners) {
  Eigen::Matrix3d rows;
  Vector3d right;
  for (int k = 0; k < 3; ++k) {
    const Vector3d edge = corners[static_cast<std::size_t>(k) + 1] - corners[0];
    rows.row(k) = 2.0 * edge.transpose();
    right[k] = edge.squaredNorm();
  }
  Eigen::FullPivLU<Eigen::Matrix3d> lu(rows);
  lu.setThreshold(kFlat);
  if (!lu.isInvertible()) return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return corners[0] + lu.solve(right);
}

}  // namespace

std::vector<VoronoiVertex> voronoi_vertices(std::span<const Vector3d> sites) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : sites) box.extend(p);
  if (sites.size() < 5) return {};
  // About the middle and in units near 1, which costs no digits that the sites have.
  const double scale = box.sizes().maxCoeff();
  if (!(scale > 0.0)) return {};
  const Vector3d middle = box.center();
  std::vector<Vector3d> local;
  double rounding = 0.0;
  for (const Vector3d& p : sites) {
    local.push_back((p - middle) / scale);
    rounding = std::max(rounding, p.lpNorm<Eigen::Infinity>());
  }
  rounding = 0x1p-48 * (1.0 + rounding / scale);
  const Eigen::AlignedBox3d local_box((box.min() - middle) / scale, (box.max() - middle) / scale);

  Delaunay delaunay(local);
  if (delaunay.is_flat()) return {};
  if (delaunay.has_failed()) throw Error("Voronoi diagram", "qhull failed");
  std::vector<VoronoiVertex> vertices;
  for (Tetrahedron& t : delaunay.tetrahedra(sites.size())) {
    std::sort(t.begin(), t.end());
    const Vector3d center = circumcenter({local[t[0]], local[t[1]], local[t[2]], local[t[3]]});
    if (!center.allFinite() || !local_box.contains(center)) continue;
    std::array<double, 4> distances;
    for (std::size_t k = 0; k < 4; ++k) distances[k] = (local[t[k]] - center).norm();
    const auto [least, most] = std::minmax_element(distances.begin(), distances.end());
    if (*most - *least > kVoronoiTolerance * *most + rounding) continue;
    vertices.push_back({middle + scale * center, scale * *least, t});
  }
  std::sort(vertices.begin(), vertices.end(),
            [](const VoronoiVertex& a, const VoronoiVertex& b) { return a.sites < b.sites; });
  return vertices;
}

}  // namespace spherule::internal
