// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What most functions take, and how their help and their results are made.

#include "mesh/triangle_mesh.h"
#include "spheretree/pose.h"

#include <Eigen/Geometry>

#include <array>
#include <initializer_list>
#include <memory>
#include <pybind11/pybind11.h>
#include <string>
#include <string_view>
#include <utility>

namespace spherule::python {

namespace py = pybind11;

// The help of a function: its signature, which inspect.signature() reads, and the text.
class Help {
 public:
  Help(std::string_view signature, std::string_view text)
      : text_(std::string(signature) + "\n--\n\n" + std::string(text)) {}
  const char* c_str() const { return text_.c_str(); }

 private:
  std::string text_;
};

// A TriangleMesh, the file of one (str or os.PathLike), or anything with `vertices` and `faces`.
// `others` names what else the caller takes, for the TypeError, each with a comma after it.
std::shared_ptr<const TriangleMesh> mesh_of(py::handle value, const char* name,
                                            const char* others = "");
// A Pose, a matrix of shape (4, 4), or None: the identity.
Pose pose_of(py::handle value, const char* name);
// A str or os.PathLike, in the encoding of file names, which need not be UTF-8; and back.
std::string path_of(py::handle value, const char* name);
py::str path_object(const std::string& path);

// A number that an object has under that name. TypeError naming it for what is none.
double number_of(py::handle object, const char* attribute);

// A class of the package's _types.py, and one made with named fields.
const py::object& result_class(const char* name);
template <class... Fields>
py::object make_result(const char* name, Fields&&... fields) {
  return result_class(name)(std::forward<Fields>(fields)...);
}

// One of some words, by its place. Error with all of them for another word.
std::size_t choice(py::handle value, std::initializer_list<std::string_view> words,
                   const char* name);

// Low and high corner, an array of shape (2, 3).
py::object array_of(const Eigen::AlignedBox3d& box);

}  // namespace spherule::python
