// Copies a range's colours and depths into a message and merges them from it, in parallel over
// blocks of pixels.
#include "composite/dense.h"

#include <cassert>
#include <cstring>

#include "comm/bad_message.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

constexpr std::size_t kPixelsGrain = std::size_t{1}
                                     << 16;  // pixels; about 30 microseconds of copying

template <class T>
void copy(T* to, const T* from, std::size_t first, std::size_t last) {
  std::memcpy(to + first, from + first, (last - first) * sizeof(T));
}

}  // namespace

template <class Colour>
comm::Buffer DenseLayer<Colour>::encode(PixelRange range) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const image::BasicImage<Colour>& image = this->image();
  comm::Buffer buffer(range.size() * this->bytes_per_pixel());
  auto* colour = reinterpret_cast<Colour*>(buffer.data());
  auto* depth = reinterpret_cast<float*>(buffer.data() + range.size() * sizeof(Colour));
  parallel::parallel_blocks(0, range.size(), kPixelsGrain,
                            [&](std::size_t first, std::size_t last) {
                              copy(colour, image.colour.data() + range.begin, first, last);
                              if (this->has_depth())
                                copy(depth, image.depth.data() + range.begin, first, last);
                            });
  return buffer;
}

template <class Colour>
std::uint64_t DenseLayer<Colour>::apply(PixelRange range, const comm::Buffer& pixels,
                                        Action action) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  comm::check_message(pixels.size() == range.size() * this->bytes_per_pixel());
  const auto* colour = reinterpret_cast<const Colour*>(pixels.data());
  const auto* depth = reinterpret_cast<const float*>(pixels.data() + range.size() * sizeof(Colour));
  parallel::parallel_blocks(
      0, range.size(), kPixelsGrain, [&](std::size_t first, std::size_t last) {
        const std::size_t size = last - first;
        this->apply_to_all(action, range.begin + first, size,
                           {colour + first, this->has_depth() ? depth + first : nullptr, size});
      });
  return range.size();
}

template class DenseLayer<image::Rgba8>;
template class DenseLayer<image::RgbaF>;

std::unique_ptr<Layer> make_dense(image::Image8&& image, Operator how) {
  return std::make_unique<DenseLayer<image::Rgba8>>(std::move(image), how);
}

std::unique_ptr<Layer> make_dense(image::ImageF&& image, Operator how) {
  return std::make_unique<DenseLayer<image::RgbaF>>(std::move(image), how);
}

}  // namespace delray::composite
