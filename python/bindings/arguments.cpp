// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/arguments.h"

#include "mesh/io/mesh_io.h"
#include "python/bindings/arrays.h"
#include "python/bindings/long_run.h"
#include "spheretree/error.h"

#include <map>
#include <vector>

namespace spherule::python {

std::string path_of(py::handle value, const char* name) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(value.ptr(), &bytes) != 0) {
    return std::string(py::reinterpret_steal<py::bytes>(bytes));
  }
  if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw py::error_already_set();
  PyErr_Clear();
  throw py::type_error(std::string(name) + ": it is not a path (str or os.PathLike)");
}

py::str path_object(const std::string& path) {
  auto text = py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
  if (!text) throw py::error_already_set();
  return text;
}

std::shared_ptr<const TriangleMesh> mesh_of(py::handle value, const char* name,
                                            const char* others) {
  if (py::isinstance<TriangleMesh>(value)) {
    return value.cast<std::shared_ptr<TriangleMesh>>();
  }
  if (py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__")) {
    const std::string path = path_of(value, name);
    return run_long(py::none(), [path](const LongRun&) {
      return std::make_shared<const TriangleMesh>(read_mesh(path));
    });
  }
  if (!py::hasattr(value, "vertices") || !py::hasattr(value, "faces")) {
    throw py::type_error(std::string(name) + ": it is no " + others +
                         "TriangleMesh, path, or object with .vertices and .faces");
  }
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = points(value.attr("vertices"), "vertices");
  mesh->triangles = triples(value.attr("faces"), "faces");
  validate(*mesh, name);
  return mesh;
}

Pose pose_of(py::handle value, const char* name) {
  if (py::isinstance<Pose>(value)) return value.cast<const Pose&>();
  if (value.is_none()) return {};
  const Numbers all = numbers(value, name);
  if (all.array.ndim() != 2 || all.array.shape(0) != 4 || all.array.shape(1) != 4) {
    throw Error(name, "it is no Pose, and its shape is " + shape_text(all.array) + ", not (4, 4)");
  }
  using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const Eigen::Matrix4d matrix = Eigen::Map<const Rows>(all.data);
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw Error(name, "the last row of the matrix is not 0, 0, 0, 1");
  }
  return Pose::from_isometry(Eigen::Isometry3d(matrix));
}

double number_of(py::handle object, const char* attribute) {
  const py::object value = object.attr(attribute);
  try {
    return value.cast<double>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(attribute) + ": it is no number");
  }
}

const py::object& result_class(const char* name) {
  // Kept for ever: classes are gone before statics are.
  static auto* const classes = new std::map<std::string, py::object, std::less<>>();
  const auto found = classes->find(std::string_view(name));
  if (found != classes->end()) return found->second;
  return classes->emplace(name, py::module_::import("spherule._types").attr(name)).first->second;
}

std::size_t choice(py::handle value, std::initializer_list<std::string_view> words,
                   const char* name) {
  if (!py::isinstance<py::str>(value)) throw py::type_error(std::string(name) + ": it is no str");
  const std::string word = py::str(value);
  std::string known;
  std::size_t place = 0;
  for (const std::string_view candidate : words) {
    if (word == candidate) return place;
    known += (place++ > 0 ? ", " : "") + std::string(candidate);
  }
  throw Error(name, "\"" + word + "\" is none of " + known);
}

py::object array_of(const Eigen::AlignedBox3d& box) {
  py::array_t<double> array({2, 3});
  for (int i = 0; i < 3; ++i) {
    array.mutable_at(0, i) = box.min()[i];
    array.mutable_at(1, i) = box.max()[i];
  }
  return array;
}

}  // namespace spherule::python
