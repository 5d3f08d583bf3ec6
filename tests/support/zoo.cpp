// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/zoo.h"

#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace spherule::test {
namespace {

// Splits the four corners, counter-clockwise seen from outside, into two triangles.
void add_quad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.emplace_back(a, b, c);
  mesh.triangles.emplace_back(a, c, d);
}

}  // namespace

TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                               (i & 4 ? high : low).z());
  }
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  return mesh;
}

TriangleMesh icosphere(int levels) {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  TriangleMesh mesh;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      mesh.vertices.emplace_back(a, b, 0);
      mesh.vertices.emplace_back(0, a, b);
      mesh.vertices.emplace_back(b, 0, a);
    }
  }
  for (Eigen::Vector3d& v : mesh.vertices) v.normalize();
  // The faces are the triples at the edge length from each other.
  const double edge = 4.0 / (g * g + 1.0) + 1e-9;
  const auto near = [&](int i, int j) {
    return (mesh.vertices[static_cast<std::size_t>(i)] - mesh.vertices[static_cast<std::size_t>(j)])
               .squaredNorm() <= edge;
  };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!near(i, j) || !near(j, k) || !near(i, k)) continue;
        const auto& v = mesh.vertices;
        const auto at = [&v](int n) { return v[static_cast<std::size_t>(n)]; };
        const bool outwards = at(i).dot(at(j).cross(at(k))) > 0.0;
        mesh.triangles.emplace_back(i, outwards ? j : k, outwards ? k : j);
      }
    }
  }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int i, int j) {
      const auto key = std::minmax(i, j);
      const auto [it, is_new] = middles.try_emplace(key, static_cast<int>(mesh.vertices.size()));
      if (is_new) {
        const Eigen::Vector3d sum = mesh.vertices[static_cast<std::size_t>(key.first)] +
                                    mesh.vertices[static_cast<std::size_t>(key.second)];
        mesh.vertices.push_back(sum.normalized());
      }
      return it->second;
    };
    std::vector<Eigen::Vector3i> split;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      split.insert(split.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(split);
  }
  return mesh;
}

TriangleMesh torus(double radius, double tube_radius, int around, int across) {
  return make_torus(radius, tube_radius, around, across);
}

TriangleMesh pipe(double outer_radius, double inner_radius, double length, int sides) {
  return shifted(make_pipe(2.0 * outer_radius, 2.0 * inner_radius, length, sides),
                 {0.0, 0.0, 0.5 * length});
}

TriangleMesh l_bracket() {
  return shifted(make_l_bracket(1.0, 0.5, 0.2), {0.0, 0.25, 0.0});
}

TriangleMesh thin_sheet(double thickness) {
  return box_mesh({0, 0, 0}, {1, 1, thickness});
}

TriangleMesh open_box() {
  TriangleMesh mesh = cube_mesh();
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  return mesh;
}

TriangleMesh soup(int triangles, unsigned seed) {
  Random random(seed);
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random.in_box(cube));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

TriangleMesh nested_shells(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(0.4 * i / count);
    const TriangleMesh shell = box_mesh(low, Eigen::Vector3d::Ones() - low);
    mesh = joined(mesh, i % 2 == 0 ? shell : inverted(shell));
  }
  return mesh;
}

TriangleMesh projective_plane() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 1.1},       {1.2, 0, 0.1},     {0.3, 1, 0.1},
                   {-0.8, 0.6, -0.1}, {-0.8, -0.6, 0.2}, {0.3, -1, -0.2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                    {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  return mesh;
}

TriangleMesh three_fins() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  return mesh;
}

TriangleMesh needles(int sides) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, -1}, {0, 0, 1}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    mesh.vertices.emplace_back(0.01 * std::cos(angle), 0.01 * std::sin(angle), 0.0);
  }
  for (int i = 0; i < sides; ++i) {
    const int a = 2 + i, b = 2 + (i + 1) % sides;
    mesh.triangles.emplace_back(0, b, a);
    mesh.triangles.emplace_back(1, a, b);
  }
  return mesh;
}

TriangleMesh inverted(TriangleMesh mesh) {
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh with_duplicates(TriangleMesh mesh) {
  const std::vector<Eigen::Vector3i> once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  return mesh;
}

TriangleMesh with_degenerates(TriangleMesh mesh) {
  const Eigen::Vector3i t = mesh.triangles.front();
  mesh.triangles.emplace_back(t[0], t[1], t[1]);
  mesh.triangles.emplace_back(t[2], t[2], t[2]);
  const Eigen::Vector3d middle = 0.5 * (mesh.vertices[static_cast<std::size_t>(t[0])] +
                                        mesh.vertices[static_cast<std::size_t>(t[1])]);
  mesh.vertices.push_back(middle);
  mesh.triangles.emplace_back(t[0], static_cast<int>(mesh.vertices.size()) - 1, t[1]);
  return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  append(mesh, b);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3d& v : mesh.vertices) v = motion * v;
  return mesh;
}

std::vector<NamedMesh> mesh_zoo() {
  return {{"l-bracket", l_bracket()},
          {"thin-sheet", thin_sheet(1e-4)},
          {"three-fins", three_fins()},
          {"needles", needles(8)},
          {"soup", soup(60, 3)},
          {"degenerates", with_degenerates(cube_mesh())},
          {"cube", cube_mesh()},
          {"icosphere", icosphere(2)},
          {"torus", torus(1.0, 0.3, 24, 12)},
          {"pipe", pipe(0.5, 0.4, 2.0, 24)},
          {"open-box", open_box()},
          {"inverted", inverted(cube_mesh())},
          {"nested-shells", nested_shells(3)},
          {"projective-plane", projective_plane()},
          {"duplicates", with_duplicates(cube_mesh())}};
}

std::vector<NamedMesh> zoo_to_fit() {
  return effort(mesh_zoo(), 3);
}

TriangleMesh mesh_named(const std::string& name) {
  for (const NamedMesh& named : mesh_zoo()) {
    if (named.name == name) return named.mesh;
  }
  throw std::out_of_range(name + " is not in the zoo");
}

}  // namespace spherule::test
