// Dynamic2 and Dynamic3, behind delray.Dynamic.
#include "delaunay/dynamic.h"

#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>

#include "python/arrays.h"
#include "python/module.h"
#include "python/work.h"

namespace py = pybind11;

namespace delray::python {
namespace {

using DynamicRows = py::array_t<std::int32_t>;

// Points that come and go.
template <int D>
class Dynamic {
 public:
  DynamicRows insert(const py::object& points) {
    const PointArray array = point_array(points, "points", D, D);
    const std::size_t count = array.view().count;
    const std::uint32_t first = run({1}, [&](parallel::Progress&) {
      const std::scoped_lock lock(mutex_);
      return points_.insert(array.view());
    });
    DynamicRows rows = new_array<std::int32_t>({static_cast<py::ssize_t>(count)});
    for (std::size_t i = 0; i < count; ++i)
      rows.mutable_data()[i] = static_cast<std::int32_t>(first + i);
    return rows;
  }
  // How many of the rows were live.
  std::size_t remove(const py::object& rows) {
    const auto numbers = whole_array<std::int64_t>(rows);
    const std::int64_t* const data = numbers.data();
    const std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    std::size_t removed = 0;
    const std::scoped_lock lock(mutex_);
    for (py::ssize_t i = 0; i < numbers.size(); ++i) {
      if (data[i] < 0 || data[i] >= most) continue;
      removed += points_.remove(static_cast<std::uint32_t>(data[i])) ? 1 : 0;
    }
    return removed;
  }
  std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return points_.size();
  }
  bool is_live(std::int64_t row) const {
    const std::scoped_lock lock(mutex_);
    return row >= 0 && row < std::numeric_limits<std::uint32_t>::max() &&
           points_.is_live(static_cast<std::uint32_t>(row));
  }
  DynamicRows simplices() const {
    delaunay::Triangulation t;
    {
      const std::scoped_lock lock(mutex_);
      t = points_.triangulation();
    }
    const auto count = static_cast<py::ssize_t>(t.size());
    return taken_as_signed(std::move(t.vertices), {count, D + 1});
  }

 private:
  // Threads of Python may call meanwhile: whoever has it needs no lock of the interpreter.
  mutable std::mutex mutex_;
  delaunay::DynamicTriangulation<D> points_;
};

template <int D>
void add_class(py::module_& module, const char* name) {
  py::class_<Dynamic<D>>(module, name)
      .def(py::init<>())
      .def("insert", &Dynamic<D>::insert)
      .def("remove", &Dynamic<D>::remove)
      .def("is_live", &Dynamic<D>::is_live)
      .def("simplices", &Dynamic<D>::simplices)
      .def("__len__", &Dynamic<D>::size);
}

}  // namespace

void add_dynamic(py::module_& module) {
  add_class<2>(module, "Dynamic2");
  add_class<3>(module, "Dynamic3");
}

}  // namespace delray::python
