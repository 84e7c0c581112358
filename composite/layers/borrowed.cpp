// Reads pixels where they are until something is merged with them; then those of the blocks that
// the merge touches are copied into the layer's image, empty ones as layers have them.
//
// A rank of a scheme that halves ranges sends most of its pixels as they are and copies the rest,
// 1/n of them with radix-k: what is read and written is little more than what travels.
//
// Where rows have gaps, or the window cuts them, the pixels of a group are first put together, and
// so are the last ones where a vector would reach beyond them.
// Degenerate: an empty window costs nothing but the answer that there is nothing.
#include "composite/borrowed.h"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "composite/layers/active.h"
#include "composite/layers/encode_active.h"
#include "composite/schemes/range.h"

namespace delray::composite {
namespace {

using internal::find_nearer;
using internal::find_with_alpha;

// Somewhere, of a few pixels; or copies of them.
template <class Colour>
struct SomePixels {
  const Colour* colour = nullptr;
  const float* depth = nullptr;
  bool as_layer = false;  // empty ones are as layers have them, not as they were borrowed
  image::Plane<Colour> own_colour;
  image::Plane<float> own_depth;
};

template <class Colour>
class BorrowedLayer final : public ActiveLayer<Colour> {
 public:
  BorrowedLayer(image::BasicImage<Colour>&& image, const BorrowedPixels<Colour>& pixels,
                Operator how)
      : ActiveLayer<Colour>(std::move(image), how),
        from_(pixels),
        by_depth_(how == Operator::nearest),
        is_settled_((this->pixels() + kGroupPixels - 1) / kGroupPixels) {
    assert(how != Operator::over_with_depth);
  }

  comm::Buffer encode(PixelRange range) override {
    const bool forgets_depth = by_depth_ && !this->has_depth();
    if (forgets_depth) settle_range(range);
    if (forgets_depth || settled(blocks_of(range)) == Settled::all)
      return ActiveLayer<Colour>::encode(range);
    const Coverage coverage(range.size(),
                            [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
                              return find({range.begin + begin, range.begin + end}, mask);
                            });
    return internal::encode_active<Colour>(
        coverage, by_depth_, [&](std::uint64_t begin, std::uint64_t end) {
          return view({range.begin + begin, range.begin + end}, /*colours=*/true);
        });
  }

  bool empty() const override {
    // As ImageLayer's, in strides.
    constexpr std::uint64_t kStride = 32;
    if (from_.window.empty()) return true;
    for (std::uint64_t first = 0; first < kStride; ++first) {
      for (std::uint64_t i = first; i < is_settled_.size(); i += kStride) {
        GroupMask mask{};
        if (find(block_pixels(i), mask) > 0) return false;
      }
    }
    return true;
  }

  void settle_range(PixelRange range) { settle_blocks(blocks_of(range)); }

 protected:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override {
    const PixelRange blocks = blocks_of(range);
    if (action == Action::replace) {
      // Only at its ends others are left in a block.
      if (blocks.begin < blocks.end) settle_blocks({blocks.begin, blocks.begin + 1});
      if (blocks.begin + 1 < blocks.end) settle_blocks({blocks.end - 1, blocks.end});
      for (std::uint64_t i = blocks.begin; i < blocks.end; ++i) is_settled_[i] = 1;
    } else {
      settle_blocks(blocks);
    }
    return ActiveLayer<Colour>::apply(range, pixels, action);
  }

 private:
  PixelRange blocks_of(PixelRange range) const {
    if (range.size() == 0) return {};
    return {range.begin / kGroupPixels, (range.end + kGroupPixels - 1) / kGroupPixels};
  }
  PixelRange block_pixels(std::uint64_t block) const {
    return {block * kGroupPixels, std::min((block + 1) * kGroupPixels, this->pixels())};
  }

  // Of some blocks.
  enum class Settled : std::uint8_t { none, some, all };
  Settled settled(PixelRange blocks) const {
    const auto begin = is_settled_.begin();
    const auto count = std::count(begin + static_cast<std::ptrdiff_t>(blocks.begin),
                                  begin + static_cast<std::ptrdiff_t>(blocks.end), 1);
    if (count == 0) return Settled::none;
    return static_cast<std::uint64_t>(count) == blocks.size() ? Settled::all : Settled::some;
  }

  // The covered ones of no more than a group of pixels.
  std::uint64_t find(PixelRange pixels, GroupMask& mask) const {
    const auto width = static_cast<std::uint64_t>(this->image().width);
    const auto first_row = static_cast<int>(pixels.begin / width);
    const auto last_row = static_cast<int>((pixels.end - 1) / width);
    const bool is_outside =
        from_.window.empty() || last_row < from_.window.y0 || first_row >= from_.window.y1;
    if (is_outside && settled(blocks_of(pixels)) == Settled::none) return 0;
    const SomePixels<Colour> some = view(pixels, /*colours=*/!by_depth_);
    if (by_depth_) {
      const std::span depths(some.depth, pixels.size());
      return some.as_layer ? internal::find_covered(depths, mask)
                           : find_nearer(depths, from_.empty_depth, mask);
    }
    const std::span colours(some.colour, pixels.size());
    return some.as_layer ? internal::find_coloured(colours, mask) : find_with_alpha(colours, mask);
  }

  // No more than a group of pixels, of which depths and, if asked for, colours are needed.
  SomePixels<Colour> view(PixelRange pixels, bool colours) const {
    const PixelRange blocks = blocks_of(pixels);
    SomePixels<Colour> result;
    switch (settled(blocks)) {
      case Settled::none:
        return borrowed_view(pixels, colours);
      case Settled::all:
        result.colour = this->image().colour.data() + pixels.begin;
        result.depth = this->image().depth.data() + pixels.begin;
        break;
      case Settled::some:
        result.own_colour = image::Plane<Colour>(pixels.size());
        result.own_depth = image::Plane<float>(pixels.size());
        for (std::uint64_t i = blocks.begin; i < blocks.end; ++i) {
          const PixelRange part = internal::overlap(pixels, block_pixels(i));
          Colour* const colour = result.own_colour.data() + (part.begin - pixels.begin);
          float* const depth = result.own_depth.data() + (part.begin - pixels.begin);
          if (is_settled_[i] == 0) {
            take(part, colour, depth);
            continue;
          }
          std::copy_n(this->image().colour.data() + part.begin, part.size(), colour);
          if (by_depth_) std::copy_n(this->image().depth.data() + part.begin, part.size(), depth);
        }
        result.colour = result.own_colour.data();
        result.depth = result.own_depth.data();
    }
    result.as_layer = true;
    return result;
  }

  // Borrowed pixels become those of a layer.
  void take(PixelRange pixels, Colour* colour, float* depth) const {
    const SomePixels<Colour> some = borrowed_view(pixels, /*colours=*/true);
    if (!by_depth_) {
      for (std::size_t k = 0; k < pixels.size(); ++k) {
        colour[k] = some.colour[k].a != 0 ? some.colour[k] : Colour{};
      }
      return;
    }
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const bool covered = some.depth[k] < from_.empty_depth;
      colour[k] = covered ? some.colour[k] : Colour{};
      depth[k] = covered ? some.depth[k] : image::kEmptyDepth;
    }
  }

  SomePixels<Colour> borrowed_view(PixelRange pixels, bool colours) const {
    const auto width = static_cast<std::ptrdiff_t>(this->image().width);
    const auto begin = static_cast<std::ptrdiff_t>(pixels.begin);
    const geometry::Rect& window = from_.window;
    SomePixels<Colour> result;
    // Whole vectors are read (internal::compress), also the last one, which may reach beyond what
    // the planes have.
    constexpr auto kLanes = static_cast<std::ptrdiff_t>(internal::kMostLanes);
    const auto size = static_cast<std::ptrdiff_t>(pixels.size());
    const std::ptrdiff_t read_end = begin + (size + kLanes - 1) / kLanes * kLanes;
    const bool whole_rows = window.x0 == 0 && window.x1 == width && from_.stride == width &&
                            begin >= window.y0 * width && read_end <= window.y1 * width;
    if (by_depth_) {
      if (whole_rows) {
        result.depth = from_.depth + (from_.origin + begin);
      } else {
        result.own_depth = copy(from_.depth, from_.empty_depth, pixels);
        result.depth = result.own_depth.data();
      }
    }
    if (!colours) return result;
    if (whole_rows && from_.colour != nullptr) {
      result.colour = from_.colour + (from_.origin + begin);
    } else {
      result.own_colour = copy(from_.colour, Colour{}, pixels);
      result.colour = result.own_colour.data();
    }
    return result;
  }

  // Values of pixels, `outside` where there are none.
  template <class T>
  image::Plane<T> copy(const T* plane, T outside, PixelRange pixels) const {
    image::Plane<T> result(pixels.size());
    std::fill_n(result.data(), result.size(), outside);
    if (plane == nullptr || from_.window.empty()) return result;
    const auto width = static_cast<std::ptrdiff_t>(this->image().width);
    const auto b = static_cast<std::ptrdiff_t>(pixels.begin);
    const auto e = static_cast<std::ptrdiff_t>(pixels.end);
    const geometry::Rect& window = from_.window;
    for (std::ptrdiff_t y = std::max<std::ptrdiff_t>(b / width, window.y0);
         y < window.y1 && y * width < e; ++y) {
      const std::ptrdiff_t from = std::max(b, y * width + window.x0);
      const std::ptrdiff_t to = std::min(e, y * width + window.x1);
      if (from >= to) continue;
      const std::ptrdiff_t at = from_.origin + y * from_.stride + (from - y * width);
      std::copy_n(plane + at, to - from, result.data() + (from - b));
    }
    return result;
  }

  void settle_blocks(PixelRange blocks) {
    parallel::parallel_for(blocks.begin, blocks.end, internal::kGroupsGrain, [&](std::size_t i) {
      if (is_settled_[i] != 0) return;
      const PixelRange block = block_pixels(i);
      take(block, this->image().colour.data() + block.begin,
           this->image().depth.data() + block.begin);
      is_settled_[i] = 1;
    });
  }

  BorrowedPixels<Colour> from_;
  bool by_depth_;
  std::vector<char> is_settled_;  // of blocks of kGroupPixels: their pixels are in the image
};

template <class Colour>
bool settle_if_borrowed(Layer& layer, PixelRange range) {
  auto* const borrowed = dynamic_cast<BorrowedLayer<Colour>*>(&layer);
  if (borrowed != nullptr) borrowed->settle_range(range);
  return borrowed != nullptr;
}

}  // namespace

std::unique_ptr<Layer> make_borrowed(image::Image8&& image,
                                     const BorrowedPixels<image::Rgba8>& pixels, Operator how) {
  return std::make_unique<BorrowedLayer<image::Rgba8>>(std::move(image), pixels, how);
}

std::unique_ptr<Layer> make_borrowed(image::ImageF&& image,
                                     const BorrowedPixels<image::RgbaF>& pixels, Operator how) {
  return std::make_unique<BorrowedLayer<image::RgbaF>>(std::move(image), pixels, how);
}

void settle(Layer& layer, PixelRange range) {
  if (!settle_if_borrowed<image::Rgba8>(layer, range))
    settle_if_borrowed<image::RgbaF>(layer, range);
}

}  // namespace delray::composite
