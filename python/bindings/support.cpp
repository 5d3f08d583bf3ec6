// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/support.h"

#include "base/error.h"
#include "io/mesh_io.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

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

namespace {

using namespace std::chrono_literals;

// Thrown through the library where it reports progress.
struct Interrupted {};

// What the two threads share.
class Run {
 public:
  // On the thread of the work.
  void work(const std::function<void(const LongRun&)>& work) {
    std::exception_ptr error;
    try {
      work({[this](double share, const char* what) { report(share, what); }, stop_.get_token()});
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    error_ = error;
    is_done_ = true;
    ended_.notify_all();
  }

  // On the thread that waits: whether the work ended within that time.
  bool wait(std::chrono::milliseconds time) {
    const WithoutLock unlocked;
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return is_done_; });
  }

  void interrupt() {
    is_interrupted_ = true;
    stop_.request_stop();
  }

  // Calls `progress` if there is something new.
  void tell(const py::object& progress) {
    if (progress.is_none()) return;
    double share = 0.0;
    std::string what;
    {
      const std::lock_guard lock(mutex_);
      if (!has_news_) return;
      has_news_ = false;
      share = share_;
      what = what_;
    }
    progress(share < 0.0 ? py::object(py::none()) : py::float_(share), what);
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void report(double share, const char* what) {
    if (is_interrupted_) throw Interrupted();
    const std::lock_guard lock(mutex_);
    share_ = share;
    what_ = what;
    has_news_ = true;
  }

  std::atomic<bool> is_interrupted_ = false;
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_done_ = false;
  std::exception_ptr error_;
  bool has_news_ = false;
  double share_ = -1.0;
  std::string what_;
};

}  // namespace

void run_beside(const py::object& progress, std::function<void(const LongRun&)> work) {
  const auto run = std::make_shared<Run>();
  std::thread worker([run, work = std::move(work)] { run->work(work); });
  try {
    while (!run->wait(50ms)) {
      run->tell(progress);
      require_no_signal();
    }
    run->tell(progress);
  } catch (...) {
    run->interrupt();
    if (run->wait(500ms)) {
      worker.join();
    } else {
      worker.detach();
    }
    throw;
  }
  worker.join();
  run->rethrow();
}

void require_no_signal() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace spherule::python
