// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The simplifier: covers a mesh with few spheres and proves that nothing is left uncovered. This
// header is all that a program needs that reads a mesh, covers it, and keeps the spheres or the
// tree of them. Link spherule::simplifier.
//
// @code{.cpp}
// #include <spherule/simplifier.h>
// #include <cassert>
//
// const auto folder = std::filesystem::temp_directory_path();
// const spherule::TriangleMesh wedge{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
//                                    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// spherule::write_stl(wedge, folder / "spherule_wedge.stl");
//
// const spherule::TriangleMesh mesh = spherule::read_mesh(folder / "spherule_wedge.stl");
// const auto fit = spherule::simplify(mesh, {.max_error = 4.0, .effort = 0});
// assert(fit.certificate.covered && spherule::broken_promises(fit).empty());
// spherule::save_spheres(spherule::sphere_file(fit), folder / "spherule_wedge.json");
// spherule::save_tree(spherule::sphere_tree(fit), folder / "spherule_wedge.tree");
// @endcode
//
// What is where:
//   geometry/triangle_mesh.h           TriangleMesh, mesh_report(): what is unusual about a mesh
//   io/mesh_io.h                       read_mesh(), write_stl(), units of length
//   io/sphere_file.h                   save_spheres(), load_spheres()
//   simplifier/simplify.h              simplify(), each stage by itself, certify()
//   simplifier/repair.h                repair(): any spheres become a cover
//   simplifier/types/simplification.h  options, results, the certificate
//   simplifier/types/zones.h           parts of space with errors of their own
//   spheretree/sphere_tree.h           SphereTree, build_tree(), levels and cuts
//   spheretree/tree_file.h             save_tree(), load_tree()
// STEP and IGES: io/cad/cad_file.h of spherule::cad. What M, S, D and E are, and what is proved:
// docs/guarantee.md.

#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"
#include "simplifier/types/simplification.h"
#include "simplifier/types/zones.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"
