// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Certificates, files of spheres, levels and zones as the package has them, and back.

#include "io/sphere_file.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"
#include "simplifier/types/zones.h"

#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <vector>

namespace spherule::python {

namespace py = pybind11;

py::object certificate_object(const Certificate& certificate);
py::object bounds_object(const Bounds& bounds);
py::object record_object(const std::optional<CertificateRecord>& record);
std::optional<CertificateRecord> record_of(const py::object& record);

py::object copy_of(const std::optional<BodyCopy>& copy);
py::object file_object(SphereFile file);
SphereFile file_of(const py::object& file);

py::tuple levels_object(std::vector<CoverLevel> levels);

std::vector<Zone> zones_of(const py::object& zones);
py::tuple zones_object(std::span<const Zone> zones);

py::object repair_object(Repair repair);
py::object simplification_object(Simplification simplification);

// None or an ExternalSpheres.
std::shared_ptr<const ExternalSpheres> external_of(py::handle value, const char* name);

}  // namespace spherule::python
