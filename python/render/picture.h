// Planes of pixels as arrays that take over their memory.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>

#include "image/image.h"

namespace delray::python {

namespace internal {
template <class T, class Scalar>
pybind11::array take(image::Plane<T>&& plane, std::vector<pybind11::ssize_t> shape) {
  auto kept = std::make_unique<image::Plane<T>>(std::move(plane));
  const auto* const data = reinterpret_cast<const Scalar*>(kept->data());
  const pybind11::capsule owner(kept.get(),
                                [](void* p) { delete static_cast<image::Plane<T>*>(p); });
  kept.release();  // NOLINT(bugprone-unused-return-value): the capsule's now
  return pybind11::array_t<Scalar>(std::move(shape), data, owner);
}
}  // namespace internal

// (height, width, 4)
inline pybind11::array array_of(image::Plane<image::Rgba8>&& plane, int width, int height) {
  return internal::take<image::Rgba8, std::uint8_t>(std::move(plane), {height, width, 4});
}
inline pybind11::array array_of(image::Plane<image::RgbaF>&& plane, int width, int height) {
  return internal::take<image::RgbaF, float>(std::move(plane), {height, width, 4});
}
// (height, width)
inline pybind11::array array_of(image::Plane<float>&& plane, int width, int height) {
  return internal::take<float, float>(std::move(plane), {height, width});
}

}  // namespace delray::python
