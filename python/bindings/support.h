// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace spherule::python {

// Each adds what its source binds.
void bind_pose(pybind11::module_& module);
void bind_mesh(pybind11::module_& module);
void bind_tree(pybind11::module_& module);
void bind_sphere_files(pybind11::module_& module);
void bind_solids(pybind11::module_& module);
void bind_queries(pybind11::module_& module);
void bind_sweep(pybind11::module_& module);
void bind_zones(pybind11::module_& module);
void bind_external(pybind11::module_& module);
void bind_simplify(pybind11::module_& module);
void bind_certify(pybind11::module_& module);
void bind_robot_model(pybind11::module_& module);
void bind_robot_files(pybind11::module_& module);
void bind_robot_formats(pybind11::module_& module);
void bind_robot_cover(pybind11::module_& module);
void bind_pairs(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_checker(pybind11::module_& module);

}  // namespace spherule::python

// Limits of queries, and what they found.

namespace spherule::python {

// None is no limit.
inline std::uint64_t count_of(pybind11::handle value, const char* name) {
  if (value.is_none()) return std::numeric_limits<std::uint64_t>::max();
  try {
    return value.cast<std::uint64_t>();
  } catch (const pybind11::cast_error&) {
    throw pybind11::type_error(std::string(name) + ": it is neither a whole number nor None");
  }
}

// Seconds, of which too many are no limit.
inline std::chrono::nanoseconds time_of(double seconds) {
  if (!(seconds >= 0.0)) throw Error("max_seconds", "it is not 0 or more");
  if (seconds > 1e9) return std::chrono::nanoseconds::max();
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

// A member of the package's Verdict.
pybind11::object verdict_of(Verdict verdict);

}  // namespace spherule::python

// NumPy arrays in and out. Arrays of doubles whose rows lie one behind the other are taken as they
// are; others are converted. What is handed out is not copied: an array owns the vector that it
// shows, or keeps the object alive to which it belongs.

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

// What most functions take, and how their help and their results are made.

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

// Work beside the interpreter: without its lock, and so that Ctrl-C ends it.

namespace spherule::python {

namespace py = pybind11;

// Releases the interpreter's lock for a scope that touches nothing of Python. Cheaper than
// pybind11's, which serves threads that Python does not know, too.
class WithoutLock {
 public:
  WithoutLock() : state_(PyEval_SaveThread()) {}
  ~WithoutLock() { PyEval_RestoreThread(state_); }
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* state_;
};

// What long work is given: it reports to `progress`, and may look at `stop`.
struct LongRun {
  Progress progress;
  std::stop_token stop;
};

// Runs `work` on a thread of its own while this one waits without the lock. Twenty times a second
// it calls `progress` (None, or called with the share that is done or None, and a word) with what
// the work reported last, and looks for signals: where a handler raises, as that of Ctrl-C does, or
// `progress` does, the work is told to stop and left alone if it does not do so within half a
// second: its next report of progress ends it. So `work` must own all that it uses, and nothing of
// Python's.
void run_beside(const py::object& progress, std::function<void(const LongRun&)> work);

// The same with a result.
template <class Work>
auto run_long(const py::object& progress, Work work) {
  using Result = decltype(work(std::declval<const LongRun&>()));
  const auto result = std::make_shared<std::optional<Result>>();
  run_beside(progress, [work = std::move(work), result](const LongRun& run) mutable {
    result->emplace(work(run));
  });
  return std::move(**result);
}

// Throws what a signal's handler raised while the lock was not held: to be called now and then.
void require_no_signal();

}  // namespace spherule::python

// What queries are about: trees, meshes and primitives.

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
