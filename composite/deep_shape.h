// Where the surfaces of a deep image lie and what they hide, without what they look like.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "composite/coverage.h"
#include "composite/deep_image.h"
#include "composite/layer.h"

namespace delray::composite {

// The payload of a surface of which nothing else counts.
struct Opacity {
  std::uint32_t is_opaque = 0;
};
inline bool is_opaque(Opacity opacity) { return opacity.is_opaque != 0; }

// Memory is in proportion to the surfaces, of which each takes 16 bytes: thousands of ranks that
// have drawn little each fit into one process. Copies share what neither has changed.
class DeepShape {
 public:
  using Surface = DeepFragment<Opacity>;
  struct Pixel {
    std::uint64_t index = 0;  // counted from the start of a range
    std::uint64_t size = 0;   // number of its surfaces, at least one
  };
  // The pixels of a range that have any surfaces, ascending, and the surfaces of one after the
  // other.
  struct Lists {
    std::span<const Pixel> pixels;
    std::span<const Surface> surfaces;
  };

  // The shape of an image of so many pixels, without surfaces.
  explicit DeepShape(std::uint64_t pixels);
  template <class Payload>
  explicit DeepShape(const DeepImage<Payload>& image);

  std::uint64_t pixels() const { return pixels_; }
  bool empty() const;

  // Appends what the range has. REQUIRES for all: range.end <= pixels().
  void read(PixelRange range, std::vector<Pixel>& pixels, std::vector<Surface>& surfaces) const;
  // As DeepLayer merges; returns the surfaces that it compares.
  std::uint64_t merge(PixelRange range, const Lists& lists);
  void remove(PixelRange range);

 private:
  // Pixels counted from the start of the group.
  struct Group {
    std::vector<Pixel> pixels;
    std::vector<Surface> surfaces;
  };
  static Group merged(const Group& own, const Group& arrived, std::uint64_t& compared);
  void set(std::size_t group, Group&& to);

  std::uint64_t pixels_;
  std::vector<std::shared_ptr<const Group>> groups_;  // of kGroupPixels; null: without surfaces
};

// ---

template <class Payload>
DeepShape::DeepShape(const DeepImage<Payload>& image) : DeepShape(image.lists.size()) {
  parallel::parallel_for(0, groups_.size(), 1, [&](std::size_t i) {
    Group group;
    const std::uint64_t begin = i * kGroupPixels;
    for (std::uint64_t k = begin; k < std::min(begin + kGroupPixels, pixels_); ++k) {
      const auto list = image.at(k);
      if (list.empty()) continue;
      group.pixels.push_back({k - begin, list.size()});
      for (const auto& fragment : list) {
        group.surfaces.push_back({{is_opaque(fragment.payload) ? 1U : 0U},
                                  fragment.depth,
                                  fragment.primitive_low,
                                  fragment.primitive_high});
      }
    }
    set(i, std::move(group));
  });
}

}  // namespace delray::composite
