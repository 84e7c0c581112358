// Conversion of whole pictures between linear light and sRGB codes, in parallel, and the proof at
// compile time that each bucket of the encoding table holds the start of at most one code.
#include "image/srgb.h"

#include "parallel/parallel_for.h"

namespace delray::image {
namespace {

constexpr std::size_t kEncodeGrain = std::size_t{1} << 14;  // pixels; about 50 microseconds

template <class From, class To, class Convert>
void convert(const BasicImage<From>& from, BasicImage<To>& to, Convert&& colour) {
  parallel::parallel_for(0, from.pixels(), kEncodeGrain, [&](std::size_t i) {
    to.colour[i] = colour(from.colour[i]);
    to.depth[i] = from.depth[i];
  });
}

// Lets encode_srgb decide between two neighbouring codes by one comparison.
constexpr bool every_bucket_starts_at_most_one_code() {
  for (std::size_t i = 0; i < internal::kBuckets; ++i) {
    const std::size_t last = i + 1 < internal::kBuckets ? internal::kCodeOfBucket[i + 1] : 255;
    if (last > internal::kCodeOfBucket[i] + 1U) return false;
  }
  return true;
}
static_assert(every_bucket_starts_at_most_one_code());

}  // namespace

Image8 to_8bit(const ImageF& image) {
  Image8 result(image.width, image.height);
  convert(image, result, [](const RgbaF& c) { return to_8bit(c); });
  return result;
}

ImageF to_float(const Image8& image) {
  ImageF result(image.width, image.height);
  convert(image, result, [](const Rgba8& c) { return to_float(c); });
  return result;
}

}  // namespace delray::image
