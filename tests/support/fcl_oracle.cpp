// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/fcl_oracle.h"

#include <fcl/fcl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace spherule::test {
namespace {

constexpr std::size_t kVerticesKept = 8;  // of a component

// Whether every edge is used as often in one direction as in the other. Corners must be joined.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> balance;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& e) {
    return e.second == 0 || e.first.first == e.first.second;
  });
}

std::vector<std::vector<Eigen::Vector3d>> components_of(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int vertex) {
    auto v = static_cast<std::size_t>(vertex);
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Eigen::Vector3i& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::map<std::size_t, std::vector<Eigen::Vector3d>> vertices;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    vertices[root(t[0])].push_back(mesh.vertices[static_cast<std::size_t>(t[0])]);
  }
  std::vector<std::vector<Eigen::Vector3d>> result;
  for (const auto& [key, all] : vertices) {
    std::vector<Eigen::Vector3d>& kept = result.emplace_back();
    const std::size_t step = (all.size() + kVerticesKept - 1) / kVerticesKept;
    for (std::size_t i = 0; i < all.size(); i += step) kept.push_back(all[i]);
  }
  return result;
}

}  // namespace

struct FclMesh::Model {
  fcl::BVHModel<fcl::OBBRSSd> tree;
};

FclMesh::FclMesh(const TriangleMesh& mesh)
    : mesh_(mesh),
      closed_(is_closed(mesh)),
      components_(components_of(mesh)),
      model_(std::make_unique<Model>()) {
  std::vector<fcl::Triangle> triangles;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
    for (int k = 0; k < 3; ++k) box_.extend(mesh.vertices[static_cast<std::size_t>(t[k])]);
  }
  model_->tree.beginModel();
  model_->tree.addSubModel(mesh.vertices, triangles);
  model_->tree.endModel();
}

FclMesh::FclMesh(FclMesh&&) noexcept = default;
FclMesh& FclMesh::operator=(FclMesh&&) noexcept = default;
FclMesh::~FclMesh() = default;

// Solid angles by Van Oosterom and Strackee (1983).
bool FclMesh::contains(const Eigen::Vector3d& point) const {
  if (!closed_ || !box_.contains(point)) return false;
  double angle = 0.0;
  for (const Eigen::Vector3i& t : mesh_.triangles) {
    const Eigen::Vector3d a = mesh_.vertices[static_cast<std::size_t>(t[0])] - point;
    const Eigen::Vector3d b = mesh_.vertices[static_cast<std::size_t>(t[1])] - point;
    const Eigen::Vector3d c = mesh_.vertices[static_cast<std::size_t>(t[2])] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi;  // half of a full turn
}

bool FclMesh::contains_a_component_of(const FclMesh& other,
                                      const Eigen::Isometry3d& this_from_other) const {
  if (!closed_) return false;
  return std::any_of(other.components_.begin(), other.components_.end(), [&](const auto& vertices) {
    const bool in_box =
        std::all_of(vertices.begin(), vertices.end(),
                    [&](const Eigen::Vector3d& v) { return box_.contains(this_from_other * v); });
    return in_box && contains(this_from_other * vertices.front());
  });
}

bool touch(const FclMesh& a, const Pose& world_from_a, const FclMesh& b, const Pose& world_from_b) {
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1;
  request.enable_contact = false;
  fcl::CollisionResultd result;
  const Eigen::Isometry3d world_a = world_from_a.isometry(), world_b = world_from_b.isometry();
  fcl::collide(&a.model_->tree, world_a, &b.model_->tree, world_b, request, result);
  if (result.isCollision()) return true;
  const Eigen::Isometry3d a_from_b = world_a.inverse() * world_b;
  return a.contains_a_component_of(b, a_from_b) || b.contains_a_component_of(a, a_from_b.inverse());
}

double surface_distance(const FclMesh& a, const Pose& world_from_a, const FclMesh& b,
                        const Pose& world_from_b) {
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(&a.model_->tree, world_from_a.isometry(), &b.model_->tree,
                       world_from_b.isometry(), request, result);
}

}  // namespace spherule::test
