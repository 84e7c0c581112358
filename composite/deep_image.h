// An image that keeps all surfaces seen at a pixel (Carpenter 1984).
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "composite/fragment.h"
#include "image/image.h"
#include "parallel/parallel_for.h"

namespace delray::composite {

// Fragments that one thread drew of some pixels. Those of pixels[0] come first, then those of
// pixels[1], and so on; those of one pixel are in order, none behind an opaque one.
template <class Payload>
struct DeepTile {
  struct Pixel {
    std::uint64_t index = 0;  // in the image, row-major
    std::uint32_t size = 0;   // number of its fragments
  };
  std::vector<Pixel> pixels;
  std::vector<DeepFragment<Payload>> fragments;  // fewer than 2^32
};

// Pixel i, in row-major order, has the fragments of lists[i], in order, none behind an opaque one.
template <class Payload>
struct DeepImage {
  // The fragments [first, first + size) of a chunk.
  struct List {
    std::uint32_t chunk = 0, first = 0, size = 0;
  };

  int width = 0, height = 0;
  image::Plane<List> lists;
  std::vector<std::vector<DeepFragment<Payload>>> chunks;  // in any order of pixels, gaps allowed

  DeepImage() = default;
  // No fragments. REQUIRES: w, h >= 0.
  DeepImage(int w, int h)
      : width(w), height(h), lists(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {
    clear(0, lists.size());
  }
  // An image of what the tiles hold; other pixels are empty. No fragment is copied. O(pixels),
  // parallel.
  //
  // REQUIRES: no pixel is in two tiles, or twice in one.
  DeepImage(int w, int h, std::vector<DeepTile<Payload>>&& tiles) : DeepImage(w, h) {
    chunks.resize(tiles.size());
    parallel::parallel_for(0, tiles.size(), 1, [&](std::size_t i) {
      DeepTile<Payload>& tile = tiles[i];
      std::uint32_t first = 0;
      for (const auto& pixel : tile.pixels) {
        lists[pixel.index] = {static_cast<std::uint32_t>(i), first, pixel.size};
        first += pixel.size;
      }
      assert(first == tile.fragments.size());
      chunks[i] = std::move(tile.fragments);
    });
  }

  std::span<const DeepFragment<Payload>> at(std::size_t pixel) const {
    const List& list = lists[pixel];
    if (list.size == 0) return {};
    return std::span(chunks[list.chunk]).subspan(list.first, list.size);
  }
  // Forgets the fragments of pixels first <= i < last. Parallel.
  void clear(std::size_t first, std::size_t last) {
    constexpr std::size_t kGrain = std::size_t{1} << 15;  // pixels; about 30 microseconds
    parallel::parallel_blocks(first, last, kGrain, [&](std::size_t begin, std::size_t end) {
      std::fill(lists.data() + begin, lists.data() + end, List{});
    });
  }
  // Gives back the memory of fragments that no pixel has. O(pixels + fragments), parallel.
  void compact() {
    constexpr std::size_t kPixelsOfChunk = 4096;
    std::vector<std::vector<DeepFragment<Payload>>> compacted((lists.size() + kPixelsOfChunk - 1) /
                                                              kPixelsOfChunk);
    parallel::parallel_for(0, compacted.size(), 1, [&](std::size_t i) {
      const std::size_t begin = i * kPixelsOfChunk;
      const std::size_t end = std::min(begin + kPixelsOfChunk, lists.size());
      std::size_t size = 0;
      for (std::size_t pixel = begin; pixel < end; ++pixel) size += lists[pixel].size;
      compacted[i].reserve(size);
      for (std::size_t pixel = begin; pixel < end; ++pixel) {
        const auto first = static_cast<std::uint32_t>(compacted[i].size());
        const auto fragments = at(pixel);
        compacted[i].insert(compacted[i].end(), fragments.begin(), fragments.end());
        lists[pixel].chunk = static_cast<std::uint32_t>(i);
        lists[pixel].first = first;
      }
    });
    chunks = std::move(compacted);
  }
  // Gives a pixel its fragments: sorts them and drops what lies behind an opaque one. Those that it
  // had are forgotten. For few pixels or one thread; see DeepTile. O(k log k).
  void set(std::size_t pixel, std::span<DeepFragment<Payload>> unsorted) {
    std::sort(unsorted.begin(), unsorted.end(), in_front<Payload>);
    const auto opaque = std::find_if(unsorted.begin(), unsorted.end(), [](const auto& fragment) {
      return is_opaque(fragment.payload);
    });
    const auto end = opaque == unsorted.end() ? opaque : opaque + 1;
    constexpr std::size_t kLargestChunk = std::size_t{1} << 31;
    if (chunks.empty() || chunks.back().size() >= kLargestChunk) chunks.emplace_back();
    auto& chunk = chunks.back();
    lists[pixel] = {static_cast<std::uint32_t>(chunks.size() - 1),
                    static_cast<std::uint32_t>(chunk.size()),
                    static_cast<std::uint32_t>(end - unsorted.begin())};
    chunk.insert(chunk.end(), unsorted.begin(), end);
  }
};

}  // namespace delray::composite
