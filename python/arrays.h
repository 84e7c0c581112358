// Arrays of NumPy as the libraries see them, and their results as arrays: without copies where the
// layout fits.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "delaunay/points.h"

namespace delray::python {

// Rows of doubles, and the array that holds them.
struct PointArray {
  pybind11::array array;  // (n, columns) float64; keeps the memory alive
  std::size_t columns = 0;

  delaunay::PointView<double> view() const;
};

// `points` as an (n, columns) array of float64. It is borrowed where it is one already, aligned,
// with the coordinates of a row beside each other and any distance between rows that do not
// overlap, and copied where it is not: other types, float32 among them, are widened.
//
// Throws std::invalid_argument, naming `what`, unless it has two axes and from `least` to `most`
// columns, and for numbers that are not real.
PointArray point_array(const pybind11::object& points, const char* what, std::size_t least,
                       std::size_t most);

// As an array of one type with rows beside each other, copied where it is not one. Throws as above;
// `columns` 0: any number of them.
template <class Scalar>
pybind11::array_t<Scalar, pybind11::array::c_style | pybind11::array::forcecast> whole_array(
    const pybind11::object& object) {
  return pybind11::array_t<Scalar, pybind11::array::c_style | pybind11::array::forcecast>(object);
}

// Uninitialised.
template <class Scalar>
pybind11::array_t<Scalar> new_array(std::vector<pybind11::ssize_t> shape) {
  return pybind11::array_t<Scalar>(std::move(shape));
}

// A read-only array over memory that `owner` keeps.
template <class Scalar>
pybind11::array_t<Scalar> borrowed(const Scalar* data, std::vector<pybind11::ssize_t> shape,
                                   pybind11::handle owner) {
  pybind11::array_t<Scalar> array(std::move(shape), data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

// An array that takes over a vector's memory.
template <class Scalar>
pybind11::array_t<Scalar> taken(std::vector<Scalar>&& values,
                                std::vector<pybind11::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<Scalar>>(std::move(values));
  const Scalar* const data = kept->data();
  const pybind11::capsule owner(kept.get(),
                                [](void* p) { delete static_cast<std::vector<Scalar>*>(p); });
  kept.release();  // NOLINT(bugprone-unused-return-value): the capsule's now
  return pybind11::array_t<Scalar>(std::move(shape), data, owner);
}

// Row and simplex numbers as NumPy programs want them: those below 2^31 are equal bits, and none,
// which is 2^32 - 1, is -1.
inline const std::int32_t* as_signed(const std::vector<std::uint32_t>& numbers) {
  return reinterpret_cast<const std::int32_t*>(numbers.data());
}
pybind11::array_t<std::int32_t> taken_as_signed(std::vector<std::uint32_t>&& numbers,
                                                std::vector<pybind11::ssize_t> shape);

}  // namespace delray::python
