// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// NumPy arrays in and out. Arrays of doubles whose rows lie one behind the other are taken as they
// are; others are converted. What is handed out is not copied: an array owns the vector that it
// shows, or keeps the object alive to which it belongs.

#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule::python {

namespace py = pybind11;

static_assert(sizeof(Sphere) == 4 * sizeof(double) && sizeof(Eigen::Vector3d) == 24 &&
              sizeof(Eigen::Vector3i) == 12);

// Numbers of an argument, kept alive.
struct Numbers {
  py::array array;
  const double* data = nullptr;
  std::size_t size = 0;
};

// Any array of numbers, or what NumPy makes one of. TypeError naming the argument for what is none.
Numbers numbers(py::handle value, const char* name);
// Of shape (n, columns). Error naming the argument and its shape for another one.
Numbers table(py::handle value, std::size_t columns, const char* name);
// Of shape (count,).
Numbers row(py::handle value, std::size_t count, const char* name);
// How many rows a table() has, of no columns, too.
std::size_t row_count(const Numbers& table);
// "(3, 4)".
std::string shape_text(const py::array& array);

// Spheres of an argument of shape (n, 4), kept alive.
struct Spheres {
  Numbers numbers;
  std::span<const Sphere> span() const {
    return {reinterpret_cast<const Sphere*>(numbers.data), numbers.size / 4};
  }
  std::vector<Sphere> copy() const { return {span().begin(), span().end()}; }
};
// Centres and radii, as rows x, y, z, radius.
Spheres spheres(py::handle value, const char* name);
// Points of an argument of shape (n, 3).
std::vector<Eigen::Vector3d> points(py::handle value, const char* name);
// Whole numbers of shape (n, 3), each within 32 bits.
std::vector<Eigen::Vector3i> triples(py::handle value, const char* name);
// Whole numbers of shape (n,), each within 32 bits.
std::vector<std::int32_t> indices(py::handle value, const char* name);
// Three numbers.
Eigen::Vector3d vector3(py::handle value, const char* name);
// A sphere of four numbers.
Sphere sphere(py::handle value, const char* name);

// An array over memory that `owner` keeps; read-only.
py::array view(const double* data, std::vector<py::ssize_t> shape, py::handle owner);
py::array view(const std::int32_t* data, std::vector<py::ssize_t> shape, py::handle owner);
py::array view(std::span<const Sphere> spheres, py::handle owner);
// A copy of few numbers.
py::array array_of(const Eigen::Vector3d& vector);
py::array array_of(const Sphere& sphere);

// An array that owns what it shows: `columns` of Number for each element, or one dimension for 0.
template <class Number, class Element>
py::array owned(std::vector<Element> values, std::size_t columns) {
  auto kept = std::make_unique<std::vector<Element>>(std::move(values));
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(kept->size())};
  if (columns > 0) shape.push_back(static_cast<py::ssize_t>(columns));
  const auto* const data = reinterpret_cast<const Number*>(kept->data());
  const py::capsule owner(kept.release(),
                          [](void* all) { delete static_cast<std::vector<Element>*>(all); });
  return py::array(py::dtype::of<Number>(), std::move(shape), data, owner);
}
py::array array_of(std::vector<Sphere> values);           // (n, 4)
py::array array_of(std::vector<Eigen::Vector3d> values);  // (n, 3)
py::array array_of(std::vector<Eigen::Vector3i> values);  // (n, 3)
py::array array_of(std::vector<double> values);           // (n,)
py::array array_of(std::vector<std::int32_t> values);     // (n,)

}  // namespace spherule::python
