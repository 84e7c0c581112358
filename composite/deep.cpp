#include "composite/deep.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <mutex>

#include "image/srgb.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 14;  // pixels: some tens of microseconds

// `skip` pixels without fragments, then `covered` with some.
struct Run {
  std::uint32_t skip = 0, covered = 0;
};
struct Header {
  std::uint64_t runs = 0, covered = 0, fragments = 0;
};

template <class T>
std::byte* put(std::byte* to, std::span<const T> values) {
  if (!values.empty()) std::memcpy(to, values.data(), values.size_bytes());
  return to + values.size_bytes();
}

// What cut() wrote.
struct Encoded {
  std::span<const Run> runs;
  std::span<const std::uint32_t> sizes;  // of the covered pixels
  std::span<const Fragment> fragments;
};

Encoded decode(const comm::Buffer& buffer) {
  assert(buffer.size() >= sizeof(Header));
  Header header;
  std::memcpy(&header, buffer.data(), sizeof header);
  const std::byte* next = buffer.data() + sizeof header;
  Encoded result;
  result.runs = {reinterpret_cast<const Run*>(next), header.runs};
  next += result.runs.size_bytes();
  result.sizes = {reinterpret_cast<const std::uint32_t*>(next), header.covered};
  next += result.sizes.size_bytes();
  result.fragments = {reinterpret_cast<const Fragment*>(next), header.fragments};
  assert(next + result.fragments.size_bytes() == buffer.data() + buffer.size());
  return result;
}

// Calls f(pixel, fragments) for every covered pixel of what was cut from `range`.
template <class F>
void for_each_covered(PixelRange range, const Encoded& encoded, F&& f) {
  std::uint64_t pixel = range.begin;
  std::size_t covered = 0, first = 0;
  for (const Run& run : encoded.runs) {
    pixel += run.skip;
    for (std::uint32_t i = 0; i < run.covered; ++i, ++pixel, ++covered) {
      const std::uint32_t size = encoded.sizes[covered];
      f(pixel, encoded.fragments.subspan(first, size));
      first += size;
    }
  }
}

bool is_opaque(const Fragment& fragment) { return fragment.colour.a >= 1.0F; }

void store(const image::RgbaF& colour, image::RgbaF& pixel) { pixel = colour; }
void store(const image::RgbaF& colour, image::Rgba8& pixel) {
  constexpr float kLargest = 255.0F, kHalf = 0.5F;
  const float alpha = std::clamp(colour.a, 0.0F, 1.0F) * kLargest + kHalf;
  pixel = {image::encode_srgb(colour.r), image::encode_srgb(colour.g), image::encode_srgb(colour.b),
           static_cast<std::uint8_t>(alpha)};
}

image::RgbaF blend(std::span<const Fragment> fragments) {
  image::RgbaF sum;
  float through = 1;
  for (const Fragment& fragment : fragments) {
    sum.r += through * fragment.colour.r;
    sum.g += through * fragment.colour.g;
    sum.b += through * fragment.colour.b;
    sum.a += through * fragment.colour.a;
    through *= 1.0F - fragment.colour.a;
  }
  return sum;
}

}  // namespace

void DeepImage::set(std::size_t pixel, std::span<Fragment> unsorted) {
  std::sort(unsorted.begin(), unsorted.end(), in_front);
  const auto opaque = std::find_if(unsorted.begin(), unsorted.end(), is_opaque);
  const auto end = opaque == unsorted.end() ? opaque : opaque + 1;
  lists[pixel] = {fragments.size(), static_cast<std::uint32_t>(end - unsorted.begin())};
  fragments.insert(fragments.end(), unsorted.begin(), end);
}

template <class Colour>
image::BasicImage<Colour> flatten(const DeepImage& deep) {
  image::BasicImage<Colour> result(deep.width, deep.height);
  parallel::parallel_for(0, deep.lists.size(), kGrain, [&](std::size_t i) {
    const std::span<const Fragment> fragments = deep.at(i);
    result.colour[i] = {};
    result.depth[i] = fragments.empty() ? image::kEmptyDepth : fragments.front().depth;
    if (!fragments.empty()) store(blend(fragments), result.colour[i]);
  });
  return result;
}

template image::Image8 flatten(const DeepImage& deep);
template image::ImageF flatten(const DeepImage& deep);

comm::Buffer DeepLayer::cut(PixelRange range) {
  assert(range.begin <= range.end && range.end <= pixels());
  constexpr std::uint32_t kLongest = std::numeric_limits<std::uint32_t>::max();
  std::vector<Run> runs;
  std::vector<std::uint32_t> sizes;
  Header header;
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    const std::uint32_t size = image_.lists[i].size;
    const bool after_covered = !runs.empty() && runs.back().covered > 0;
    if (runs.empty() || (size == 0 && (after_covered || runs.back().skip == kLongest)) ||
        (size > 0 && runs.back().covered == kLongest)) {
      runs.emplace_back();
    }
    ++(size == 0 ? runs.back().skip : runs.back().covered);
    if (size > 0) sizes.push_back(size);
    header.fragments += size;
  }
  header.runs = runs.size();
  header.covered = sizes.size();
  comm::Buffer buffer(sizeof header + runs.size() * sizeof(Run) +
                      sizes.size() * sizeof(std::uint32_t) + header.fragments * sizeof(Fragment));
  std::byte* next = put(buffer.data(), std::span<const Header>(&header, 1));
  next = put(next, std::span<const Run>(runs));
  next = put(next, std::span<const std::uint32_t>(sizes));
  for (std::uint64_t i = range.begin; i < range.end; ++i) next = put(next, image_.at(i));
  return buffer;
}

std::uint64_t DeepLayer::merge(PixelRange range, const comm::Buffer& pixels, Side /*from*/) {
  std::uint64_t composited = 0;
  std::vector<Fragment> merged;
  for_each_covered(
      range, decode(pixels), [&](std::uint64_t pixel, std::span<const Fragment> arrived) {
        const std::span<const Fragment> own = image_.at(pixel);
        composited += own.size() + arrived.size();
        merged.resize(own.size() + arrived.size());
        std::merge(own.begin(), own.end(), arrived.begin(), arrived.end(), merged.begin(),
                   in_front);
        const auto opaque = std::find_if(merged.begin(), merged.end(), is_opaque);
        if (opaque != merged.end()) merged.erase(opaque + 1, merged.end());
        image_.lists[pixel] = {image_.fragments.size(), static_cast<std::uint32_t>(merged.size())};
        image_.fragments.insert(image_.fragments.end(), merged.begin(), merged.end());
      });
  return composited;
}

void DeepLayer::replace(PixelRange range, const comm::Buffer& pixels) {
  std::fill(image_.lists.begin() + static_cast<std::ptrdiff_t>(range.begin),
            image_.lists.begin() + static_cast<std::ptrdiff_t>(range.end), DeepImage::List{});
  for_each_covered(
      range, decode(pixels), [&](std::uint64_t pixel, std::span<const Fragment> arrived) {
        image_.lists[pixel] = {image_.fragments.size(), static_cast<std::uint32_t>(arrived.size())};
        image_.fragments.insert(image_.fragments.end(), arrived.begin(), arrived.end());
      });
}

bool DeepLayer::empty() const {
  return std::all_of(image_.lists.begin(), image_.lists.end(),
                     [](const DeepImage::List& list) { return list.size == 0; });
}

std::unique_ptr<Layer> make_deep(DeepImage&& image) {
  return std::make_unique<DeepLayer>(std::move(image));
}

}  // namespace delray::composite
