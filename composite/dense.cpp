#include "composite/dense.h"

#include <cassert>
#include <cstring>

#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 16;  // pixels; about 30 microseconds of copying

// The planes of an encoded range.
template <class Colour>
struct Encoded {
  const Colour* colour;
  const float* depth;
};

template <class Colour>
Encoded<Colour> decode(PixelRange range, const comm::Buffer& pixels) {
  assert(pixels.size() == range.size() * (sizeof(Colour) + sizeof(float)));
  return {reinterpret_cast<const Colour*>(pixels.data()),
          reinterpret_cast<const float*>(pixels.data() + range.size() * sizeof(Colour))};
}

template <class T>
void copy(T* to, const T* from, std::size_t first, std::size_t last) {
  std::memcpy(to + first, from + first, (last - first) * sizeof(T));
}

}  // namespace

template <class Colour>
comm::Buffer DenseLayer<Colour>::cut(PixelRange range) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const image::BasicImage<Colour>& image = this->image();
  comm::Buffer buffer(range.size() * (sizeof(Colour) + sizeof(float)));
  auto* colour = reinterpret_cast<Colour*>(buffer.data());
  auto* depth = reinterpret_cast<float*>(buffer.data() + range.size() * sizeof(Colour));
  parallel::parallel_blocks(0, range.size(), kGrain, [&](std::size_t first, std::size_t last) {
    copy(colour, image.colour.data() + range.begin, first, last);
    copy(depth, image.depth.data() + range.begin, first, last);
  });
  return buffer;
}

template <class Colour>
std::uint64_t DenseLayer<Colour>::merge(PixelRange range, const comm::Buffer& pixels, Side from) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  image::BasicImage<Colour>& image = this->image();
  const Encoded<Colour> other = decode<Colour>(range, pixels);
  const image::Tie tie = this->tie_of(from);
  parallel::parallel_blocks(0, range.size(), kGrain, [&](std::size_t first, std::size_t last) {
    const std::size_t size = last - first;
    image::z_merge(image.colour.span().subspan(range.begin + first, size),
                   image.depth.span().subspan(range.begin + first, size),
                   std::span<const Colour>(other.colour + first, size),
                   std::span<const float>(other.depth + first, size), tie);
  });
  return range.size();
}

template <class Colour>
void DenseLayer<Colour>::replace(PixelRange range, const comm::Buffer& pixels) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  image::BasicImage<Colour>& image = this->image();
  const Encoded<Colour> other = decode<Colour>(range, pixels);
  parallel::parallel_blocks(0, range.size(), kGrain, [&](std::size_t first, std::size_t last) {
    copy(image.colour.data() + range.begin, other.colour, first, last);
    copy(image.depth.data() + range.begin, other.depth, first, last);
  });
}

template class DenseLayer<image::Rgba8>;
template class DenseLayer<image::RgbaF>;

std::unique_ptr<Layer> make_dense(image::Image8&& image) {
  return std::make_unique<DenseLayer<image::Rgba8>>(std::move(image));
}

std::unique_ptr<Layer> make_dense(image::ImageF&& image) {
  return std::make_unique<DenseLayer<image::RgbaF>>(std::move(image));
}

}  // namespace delray::composite
