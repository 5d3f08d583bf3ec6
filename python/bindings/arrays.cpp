// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arrays.h"

#include "spheretree/error.h"

#include <limits>
#include <string_view>

namespace spherule::python {
namespace {

bool is_plain(const py::array& array) {
  return array.dtype().is(py::dtype::of<double>()) && (array.flags() & py::array::c_style) != 0 &&
         (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

// What numpy.ma hides would be read like the rest.
void refuse_hidden(const py::array& array, const char* name) {
  const bool may_hide = Py_TYPE(array.ptr()) != py::detail::npy_api::get().PyArray_Type_;
  if (may_hide && py::module_::import("numpy.ma").attr("is_masked")(array).cast<bool>()) {
    throw Error(name, "numbers of it are masked; .filled() and .compressed() say what to take");
  }
}

py::array as_array(py::handle value, const char* name) {
  if (py::isinstance<py::array>(value)) {
    auto array = py::reinterpret_borrow<py::array>(value);
    refuse_hidden(array, name);
    return array;
  }
  py::array array = py::array::ensure(value);
  if (!array) throw py::type_error(std::string(name) + ": it is not an array of numbers");
  return array;
}

// Of the `kinds` of NumPy's types, which `wanted` describes.
void require_kind(const py::array& array, std::string_view kinds, const char* wanted,
                  const char* name) {
  const py::dtype type = array.dtype();
  const bool is_empty = array.size() == 0;
  if (kinds.find(type.kind()) == kinds.npos || (type.kind() == 'f' && type.itemsize() > 8)) {
    if (is_empty) return;
    throw py::type_error(std::string(name) + ": the type of its numbers is " +
                         std::string(py::str(py::object(type))) + ", not " + wanted);
  }
}

[[noreturn]] void refuse_shape(const py::array& array, const std::string& wanted,
                               const char* name) {
  throw Error(name, "its shape is " + shape_text(array) + ", not " + wanted);
}

using WholeNumbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

WholeNumbers whole_numbers(const py::array& array, const char* name) {
  require_kind(array, "iu", "that of whole numbers", name);
  auto all = WholeNumbers::ensure(array);
  if (!all) throw py::error_already_set();
  return all;
}

// Number `i` of all, as one of 32 bits that is not below `least`; it stands in that row.
std::int32_t index_in(const WholeNumbers& all, std::size_t i, std::size_t row, std::int32_t least,
                      const char* name) {
  const std::int64_t index = all.data()[i];
  if (index < least || index > std::numeric_limits<std::int32_t>::max()) {
    throw Error(name, "row " + std::to_string(row) + " has the index " + std::to_string(index));
  }
  return static_cast<std::int32_t>(index);
}

std::vector<py::ssize_t> strides_of(const std::vector<py::ssize_t>& shape, std::size_t item) {
  std::vector<py::ssize_t> strides(shape.size(), static_cast<py::ssize_t>(item));
  for (std::size_t i = shape.size(); i-- > 1;) strides[i - 1] = strides[i] * shape[i];
  return strides;
}

template <class Number>
py::array read_only(const Number* data, std::vector<py::ssize_t> shape, py::handle owner) {
  const auto strides = strides_of(shape, sizeof(Number));
  py::array array(py::dtype::of<Number>(), std::move(shape), strides, data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

}  // namespace

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

Numbers numbers(py::handle value, const char* name) {
  py::array array = as_array(value, name);
  if (!is_plain(array)) {
    require_kind(array, "fiu", "float64 or one that it holds", name);
    array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!array) throw py::error_already_set();
  }
  const auto* const data = static_cast<const double*>(array.data());
  const auto size = static_cast<std::size_t>(array.size());
  return {std::move(array), data, size};
}

Numbers table(py::handle value, std::size_t columns, const char* name) {
  Numbers all = numbers(value, name);
  const bool is_empty = all.array.ndim() == 1 && all.size == 0;
  if (!is_empty &&
      (all.array.ndim() != 2 || all.array.shape(1) != static_cast<py::ssize_t>(columns))) {
    refuse_shape(all.array, "(n, " + std::to_string(columns) + ")", name);
  }
  return all;
}

std::size_t row_count(const Numbers& table) {
  return table.array.ndim() == 2 ? static_cast<std::size_t>(table.array.shape(0)) : 0;
}

Numbers row(py::handle value, std::size_t count, const char* name) {
  Numbers all = numbers(value, name);
  if (all.array.ndim() != 1 || all.size != count) {
    refuse_shape(all.array, "(" + std::to_string(count) + ",)", name);
  }
  return all;
}

Spheres spheres(py::handle value, const char* name) {
  return {table(value, 4, name)};
}

std::vector<Eigen::Vector3d> points(py::handle value, const char* name) {
  const Numbers all = table(value, 3, name);
  const auto* const first = reinterpret_cast<const Eigen::Vector3d*>(all.data);
  return {first, first + all.size / 3};
}

std::vector<Eigen::Vector3i> triples(py::handle value, const char* name) {
  const py::array array = as_array(value, name);
  const WholeNumbers all = whole_numbers(array, name);
  if (array.size() > 0 && (array.ndim() != 2 || array.shape(1) != 3)) {
    refuse_shape(array, "(n, 3)", name);
  }
  const auto count = static_cast<std::size_t>(all.size()) / 3;
  std::vector<Eigen::Vector3i> result(count);
  for (std::size_t i = 0; i < 3 * count; ++i) {
    result[i / 3][static_cast<Eigen::Index>(i % 3)] = index_in(all, i, i / 3, 0, name);
  }
  return result;
}

std::vector<std::int32_t> indices(py::handle value, const char* name) {
  const py::array array = as_array(value, name);
  const WholeNumbers all = whole_numbers(array, name);
  if (array.ndim() != 1) refuse_shape(array, "(n,)", name);
  std::vector<std::int32_t> result(static_cast<std::size_t>(all.size()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = index_in(all, i, i, std::numeric_limits<std::int32_t>::min(), name);
  }
  return result;
}

Eigen::Vector3d vector3(py::handle value, const char* name) {
  const Numbers all = row(value, 3, name);
  return {all.data[0], all.data[1], all.data[2]};
}

Sphere sphere(py::handle value, const char* name) {
  const Numbers all = row(value, 4, name);
  return {{all.data[0], all.data[1], all.data[2]}, all.data[3]};
}

py::array view(const double* data, std::vector<py::ssize_t> shape, py::handle owner) {
  return read_only(data, std::move(shape), owner);
}

py::array view(const std::int32_t* data, std::vector<py::ssize_t> shape, py::handle owner) {
  return read_only(data, std::move(shape), owner);
}

py::array view(std::span<const Sphere> spheres, py::handle owner) {
  return read_only(reinterpret_cast<const double*>(spheres.data()),
                   {static_cast<py::ssize_t>(spheres.size()), 4}, owner);
}

py::array array_of(const Eigen::Vector3d& vector) {
  return py::array_t<double>(3, vector.data());
}

py::array array_of(const Sphere& sphere) {
  return py::array_t<double>(4, reinterpret_cast<const double*>(&sphere));
}

py::array array_of(std::vector<Sphere> values) {
  return owned<double>(std::move(values), 4);
}
py::array array_of(std::vector<Eigen::Vector3d> values) {
  return owned<double>(std::move(values), 3);
}
py::array array_of(std::vector<Eigen::Vector3i> values) {
  return owned<std::int32_t>(std::move(values), 3);
}
py::array array_of(std::vector<double> values) {
  return owned<double>(std::move(values), 0);
}
py::array array_of(std::vector<std::int32_t> values) {
  return owned<std::int32_t>(std::move(values), 0);
}

}  // namespace spherule::python
