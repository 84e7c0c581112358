// Averages the samples of pixels in linear light, and brings the samples of a pixel together or
// apart. Sums of 8-bit colours are whole numbers, so that their order makes no difference.
#include "raster/pipeline/samples.h"

#include <array>

#include "composite/dense.h"
#include "image/srgb.h"
#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

// Linear light as a whole number: 16 of them add up to what a float holds exactly.
constexpr float kUnit = 1 << 20;

constexpr std::array<std::uint32_t, 256> make_light_of_code() {
  std::array<std::uint32_t, 256> table{};
  for (std::size_t c = 0; c < table.size(); ++c)
    table[c] = static_cast<std::uint32_t>(image::internal::kLinearOfCode[c] * kUnit + 0.5F);
  return table;
}
constexpr std::array<std::uint32_t, 256> kLightOfCode = make_light_of_code();

// Sums in the order in which samples are added.
struct Sum8 {
  std::uint32_t r = 0, g = 0, b = 0, a = 0;
  void add(const image::Rgba8& c) {
    r += kLightOfCode[c.r];
    g += kLightOfCode[c.g];
    b += kLightOfCode[c.b];
    a += c.a;
  }
  image::Rgba8 mean(int samples) const {
    const float scale = 1.0F / (kUnit * static_cast<float>(samples));  // a power of two
    const auto code = [&](std::uint32_t light) {
      return image::encode_srgb(static_cast<float>(light) * scale);
    };
    const auto n = static_cast<std::uint32_t>(samples);
    return {code(r), code(g), code(b), static_cast<std::uint8_t>((a + n / 2) / n)};
  }
};
struct SumF {
  float r = 0, g = 0, b = 0, a = 0;
  void add(const image::RgbaF& c) {
    r += c.r;
    g += c.g;
    b += c.b;
    a += c.a;
  }
  image::RgbaF mean(int samples) const {
    const float scale = 1.0F / static_cast<float>(samples);
    return {r * scale, g * scale, b * scale, a * scale};
  }
};
Sum8 sum_of(const image::Rgba8*) { return {}; }
SumF sum_of(const image::RgbaF*) { return {}; }

// The mean colour of the n x n samples whose rows are `stride` apart, and the least depth.
template <class Colour>
void resolve_pixel(const Colour* colours, const float* depths, std::size_t stride, int n,
                   Colour& colour, float& depth) {
  auto sum = sum_of(colours);
  float nearest = image::kEmptyDepth;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
      sum.add(colours[at]);
      nearest = std::min(nearest, depths[at]);
    }
  }
  colour = sum.mean(n * n);
  depth = nearest;
}

}  // namespace

template <class Colour>
void resolve(const Window<Colour>& samples, int n, const geometry::Rect& pixels,
             const Window<Colour>& window) {
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      const std::size_t from = samples.at(x * n, y * n), to = window.at(x, y);
      resolve_pixel(samples.colour + from, samples.depth + from,
                    static_cast<std::size_t>(samples.stride), n, window.colour[to],
                    window.depth[to]);
    }
  }
}

template <class Colour>
void gather_samples(const Window<Colour>& samples, int n, const geometry::Rect& pixels,
                    image::BasicImage<Colour>& image) {
  const auto count = static_cast<std::size_t>(n);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      std::size_t to = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x) * count * count;
      for (int j = 0; j < n; ++j, to += count) {
        const std::size_t from = samples.at(x * n, y * n + j);
        std::copy_n(samples.colour + from, count, image.colour.data() + to);
        std::copy_n(samples.depth + from, count, image.depth.data() + to);
      }
    }
  }
}

template <class Colour>
composite::OwnedPixels resolve(composite::OwnedPixels&& part, int n, int width, int height) {
  if (n == 1) return std::move(part);
  constexpr std::size_t kGrain = 1 << 12;  // pixels
  const auto count = static_cast<std::uint64_t>(n) * static_cast<std::uint64_t>(n);
  composite::OwnedPixels result;
  result.ranges = part.ranges;
  const image::BasicImage<Colour> samples = composite::take_image<Colour>(std::move(part));
  image::BasicImage<Colour> image(width, height);
  for (composite::PixelRange& range : result.ranges) {
    range.begin /= count;
    range.end /= count;
    parallel::parallel_for(range.begin, range.end, kGrain, [&](std::size_t pixel) {
      resolve_pixel(samples.colour.data() + pixel * count, samples.depth.data() + pixel * count,
                    static_cast<std::size_t>(n), n, image.colour[pixel], image.depth[pixel]);
    });
  }
  result.layer = composite::make_dense(std::move(image));
  return result;
}

template void resolve(const Window<image::Rgba8>&, int, const geometry::Rect&,
                      const Window<image::Rgba8>&);
template void resolve(const Window<image::RgbaF>&, int, const geometry::Rect&,
                      const Window<image::RgbaF>&);
template void gather_samples(const Window<image::Rgba8>&, int, const geometry::Rect&,
                             image::Image8&);
template void gather_samples(const Window<image::RgbaF>&, int, const geometry::Rect&,
                             image::ImageF&);
template composite::OwnedPixels resolve<image::Rgba8>(composite::OwnedPixels&&, int, int, int);
template composite::OwnedPixels resolve<image::RgbaF>(composite::OwnedPixels&&, int, int, int);

}  // namespace delray::raster
