// Strides of NumPy may be anything; what the libraries cannot walk over is copied once.
#include "python/arrays.h"

#include <stdexcept>
#include <string>

namespace py = pybind11;

namespace delray::python {
namespace {

// A row must be as a PointView reads it.
bool fits(const py::array& array) {
  const bool aligned =
      (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0 && array.itemsize() == 8;
  if (!aligned || !array.dtype().is(py::dtype::of<double>())) return false;
  if (array.shape(0) <= 1) return array.strides(1) == array.itemsize();
  return array.strides(1) == array.itemsize() &&
         array.strides(0) >= array.shape(1) * array.itemsize();
}

}  // namespace

delaunay::PointView<double> PointArray::view() const {
  if (array.shape(0) <= 1) {  // whose distance NumPy leaves open
    return {static_cast<const std::byte*>(array.data()), static_cast<std::size_t>(array.shape(0)),
            columns * sizeof(double)};
  }
  return {static_cast<const std::byte*>(array.data()), static_cast<std::size_t>(array.shape(0)),
          static_cast<std::size_t>(array.strides(0))};
}

PointArray point_array(const py::object& points, const char* what, std::size_t least,
                       std::size_t most) {
  py::array array = py::array::ensure(points);
  if (!array) {
    PyErr_Clear();
    throw std::invalid_argument(std::string(what) + ": no array of numbers");
  }
  const std::string shape = py::str(array.attr("shape"));
  const auto columns = array.ndim() == 2 ? static_cast<std::size_t>(array.shape(1)) : 0;
  if (columns < least || columns > most) {
    const std::string wanted = least == most
                                   ? std::to_string(least)
                                   : std::to_string(least) + " or " + std::to_string(most);
    throw std::invalid_argument(std::string(what) + ": the shape is " + shape + ", not (n, " +
                                wanted + ")");
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    throw std::invalid_argument(std::string(what) + ": an array of " +
                                std::string(py::str(array.dtype())) + ", not of real numbers");
  }
  if (!fits(array)) array = whole_array<double>(array);
  array = array.attr("view")();  // whose flag is not the caller's
  array.attr("flags").attr("writeable") = false;
  return {std::move(array), columns};
}

py::array_t<std::int32_t> taken_as_signed(std::vector<std::uint32_t>&& numbers,
                                          std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<std::uint32_t>>(std::move(numbers));
  const std::int32_t* const data = as_signed(*kept);
  const py::capsule owner(kept.get(),
                          [](void* p) { delete static_cast<std::vector<std::uint32_t>*>(p); });
  kept.release();  // NOLINT(bugprone-unused-return-value): the capsule's now
  return py::array_t<std::int32_t>(std::move(shape), data, owner);
}

}  // namespace delray::python
