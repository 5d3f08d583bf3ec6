// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What queries are about: trees, meshes and primitives.

#include "collide/mesh_contact.h"
#include "collide/primitive.h"
#include "collide/solid_mesh.h"
#include "spheretree/sphere_tree.h"

#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <variant>

namespace spherule::python {

namespace py = pybind11;

// A body of an argument, which the argument keeps.
using Body = std::variant<const SphereTree*, const SolidMesh*, const CoveredMesh*, Primitive>;

// TypeError naming the argument for what is no body.
Body body_of(py::handle value, const char* name);

// TypeError naming the argument for what is no CoveredMesh.
std::shared_ptr<const CoveredMesh> covered_of(py::handle value, const char* name);

// A Box, SolidSphere, Cylinder, Capsule or HalfSpace of the package; nothing for what is none. And
// back.
std::optional<Primitive> primitive_of(py::handle value);
py::object object_of(const Primitive& primitive);

// A mesh of its triangles, corners that are equal bit for bit being one.
TriangleMesh mesh_of(const SolidMesh& solid);

}  // namespace spherule::python
