// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/random_scene.h"

#include "collide/meshes/mesh_tree.h"
#include "spheretree/sphere_tree.h"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// Integers give exact ties: equal distances, equal coordinates, coplanar and cospherical centres.
Vector3d lattice_point(Random& random) {
  const auto coordinate = [&random] { return static_cast<double>(random.index(5)) - 2.0; };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

// The sphere of a number in a family.
using Make = Sphere (*)(Random&, std::size_t);

constexpr std::pair<const char*, Make> kFamilies[] = {
    {"solid",
     [](Random& random, std::size_t) {
       return Sphere{random.point(1.0), random.between(0.0, 0.1)};
     }},
    {"shell",
     [](Random& random, std::size_t) {
       return Sphere{random.direction(), 0.05};
     }},
    {"points",
     [](Random& random, std::size_t) {
       return Sphere{random.point(1.0), 0.0};
     }},
    {"large radii",
     [](Random& random, std::size_t) {
       return Sphere{random.point(0.1), random.between(0.5, 1.0)};
     }},
    {"far from the origin",
     [](Random& random, std::size_t) {
       return Sphere{Vector3d(1e6, -2e6, 3e6) + random.point(1.0), random.between(0.0, 0.1)};
     }},
    {"coincident",
     [](Random&, std::size_t) {
       return Sphere{{0.1, 0.2, 0.3}, 0.7};
     }},
    {"concentric",
     [](Random& random, std::size_t) {
       return Sphere{{0.1, 0.2, 0.3}, random.unit()};
     }},
    {"nested, touching inside",
     [](Random&, std::size_t i) {
       const double r = 1.0 / static_cast<double>(i + 1);
       return Sphere{{1.0 - r, 0.0, 0.0}, r};
     }},
    {"line",
     [](Random&, std::size_t i) {
       return Sphere{static_cast<double>(i) * Vector3d(0.1, 0.2, -0.3), 0.05};
     }},
    {"line, halving steps",
     [](Random&, std::size_t i) {
       return Sphere{{std::ldexp(1.0, -static_cast<int>(i % 900)), 0.0, 0.0}, 1e-3};
     }},
    {"plane",
     [](Random& random, std::size_t) {
       const double x = random.between(-1.0, 1.0);
       const double y = random.between(-1.0, 1.0);
       return Sphere{{x, y, x + y}, random.between(0.0, 0.1)};
     }},
    {"lattice",
     [](Random& random, std::size_t) {
       return Sphere{lattice_point(random), static_cast<double>(random.index(3))};
     }},
    {"inside touching the unit sphere",
     [](Random& random, std::size_t) {
       const double r = random.unit();
       return Sphere{(1.0 - r) * random.direction(), r};
     }},
    {"a few units in the last place apart",
     [](Random& random, std::size_t) {
       return Sphere{{1.0 + 0x1p-52 * static_cast<double>(random.index(4)), 2.0, 3.0},
                     0.5 + 0x1p-53 * static_cast<double>(random.index(4))};
     }},
    {"tiny",
     [](Random& random, std::size_t) {
       return Sphere{random.point(1e-9), random.between(0.0, 1e-10)};
     }},
    {"huge",
     [](Random& random, std::size_t) {
       return Sphere{random.point(1e9), random.between(0.0, 1e8)};
     }},
    {"scales from 1e-9 to 1e9",
     [](Random& random, std::size_t) {
       const double scale = std::pow(10.0, random.between(-9.0, 9.0));
       return Sphere{random.point(scale), scale * random.unit()};
     }},
    {"squares underflow",
     [](Random& random, std::size_t) {
       return Sphere{random.point(1e-200), random.between(0.0, 1e-200)};
     }},
};

}  // namespace

std::vector<Family> sphere_families(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Family> families;
  for (const auto& [name, make] : kFamilies) {
    Family& family = families.emplace_back();
    family.name = name;
    for (std::size_t i = 0; i < count; ++i) family.spheres.push_back(make(random, i));
  }
  return families;
}

std::vector<Sphere> unusable_spheres() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {{{kNan, 0, 0}, 1.0}, {{0, kInfinity, 0}, 1.0}, {{0, 0, 0}, kNan},
          {{0, 0, 0}, -1.0},   {{0, 0, 2e15}, 1.0},      {{0, 0, 0}, kInfinity}};
}

std::vector<Sphere> random_spheres(Random& random, int count, double size, double largest_radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center = random.point(size);
    spheres.push_back({center, random.between(0.0, largest_radius)});
  }
  return spheres;
}

SphereTree caterpillar(int depth, int branching, bool inner_first) {
  SphereTreeData data;
  const auto add = [&](double radius, int first_child, int child_count) {
    data.x.push_back(0.0);
    data.y.push_back(0.0);
    data.z.push_back(0.0);
    data.radius.push_back(radius);
    data.first_child.push_back(first_child);
    data.child_count.push_back(child_count);
  };
  const auto add_leaf = [&] {
    const double radius = 1.0 + static_cast<double>(data.spheres.size()) * 1e-6;
    add(radius, static_cast<int>(data.spheres.size()), 0);
    data.spheres.push_back({Eigen::Vector3d::Zero(), radius});
  };
  add(4.0 + depth, 1, branching);
  for (int level = 1; level <= depth; ++level) {
    const bool last = level == depth;
    const int first = static_cast<int>(data.radius.size());
    for (int i = 0; i < branching; ++i) {
      const bool inner = !last && i == (inner_first ? 0 : branching - 1);
      if (inner) {
        add(4.0 + depth - level, first + branching, branching);
      } else {
        add_leaf();
      }
    }
  }
  return SphereTree(std::move(data));
}

std::shared_ptr<const SphereTree> one_sphere_tree(const Eigen::Vector3d& center, double radius) {
  return std::make_shared<const SphereTree>(build_tree(std::vector<Sphere>{{center, radius}}));
}

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::kPortable};
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

SphereTree tree_of(const Sphere& sphere) {
  return build_tree(std::span(&sphere, 1));
}

TriangleMesh random_triangles(Random& random, int count, double size, double width) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3d a = random.point(size);
    const Vector3d edge = random.point(size);
    const Vector3d along = random.between(0.0, 1.0) * edge;
    mesh.vertices.insert(mesh.vertices.end(), {a, a + edge, a + along + random.point(width)});
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

std::array<Vector3d, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return {corner(0), corner(1), corner(2)};
}

std::shared_ptr<const CoveredMesh> covered_tetrahedron(Random& random, double size) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  for (Eigen::Vector3d& v : mesh.vertices) v = size * (v - Eigen::Vector3d(0.25, 0.25, 0.25));
  std::vector<Sphere> spheres = {{Eigen::Vector3d::Zero(), 0.9 * size}};
  for (int i = 0; i < 20; ++i) {
    spheres.push_back({random.point(0.5 * size), random.between(0.0, 0.3 * size)});
  }
  return std::make_shared<const CoveredMesh>(
      mesh, std::make_shared<const SphereTree>(build_tree(spheres)));
}

std::shared_ptr<const CoveredMesh> covered_surface(const TriangleMesh& mesh) {
  return std::make_shared<const CoveredMesh>(
      mesh, std::make_shared<const SphereTree>(MeshTree(mesh).tree()));
}

std::shared_ptr<const SphereTree> cover_of(const std::shared_ptr<const CoveredMesh>& mesh) {
  return {mesh, &mesh->cover()};
}

}  // namespace spherule::test
