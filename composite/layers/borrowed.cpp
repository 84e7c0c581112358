// Reads pixels where they are until something is merged with them; then those of the blocks that
// the merge touches are copied into the layer's image, empty ones as layers have them.
//
// A rank of a scheme that halves ranges sends most of its pixels as they are and copies the rest,
// 1/n of them with radix-k: what is read and written is little more than what travels.
//
// Where rows have gaps, or the window cuts them, the pixels of a group are first put together.
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
    const PixelRange blocks = blocks_of(range);
    const auto settled = [&](bool value) {
      return std::find(is_settled_.begin() + static_cast<std::ptrdiff_t>(blocks.begin),
                       is_settled_.begin() + static_cast<std::ptrdiff_t>(blocks.end),
                       value) != is_settled_.begin() + static_cast<std::ptrdiff_t>(blocks.end);
    };
    if (settled(true)) {
      if (settled(false)) settle_blocks(blocks);
      return ActiveLayer<Colour>::encode(range);
    }
    const Coverage coverage(range.size(),
                            [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
                              return find(range.begin + begin, range.begin + end, mask);
                            });
    return internal::encode_active<Colour>(
        coverage, by_depth_, [&](std::uint64_t begin, std::uint64_t end) {
          return view(range.begin + begin, range.begin + end, /*colours=*/true);
        });
  }

  bool empty() const override {
    // As ImageLayer's, in strides.
    constexpr std::uint64_t kStride = 32;
    if (from_.window.empty()) return true;
    for (std::uint64_t first = 0; first < kStride; ++first) {
      for (std::uint64_t i = first; i < is_settled_.size(); i += kStride) {
        GroupMask mask{};
        const PixelRange block = block_pixels(i);
        if (find(block.begin, block.end, mask) > 0) return false;
      }
    }
    return true;
  }

  void settle_range(PixelRange range) { settle_blocks(blocks_of(range)); }

 protected:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override {
    PixelRange blocks = blocks_of(range);
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

  std::uint64_t find(std::uint64_t begin, std::uint64_t end, GroupMask& mask) const {
    const auto width = static_cast<std::uint64_t>(this->image().width);
    const auto first_row = static_cast<int>(begin / width);
    const auto last_row = static_cast<int>((end - 1) / width);
    if (from_.window.empty() || last_row < from_.window.y0 || first_row >= from_.window.y1)
      return 0;
    const SomePixels<Colour> some = view(begin, end, /*colours=*/!by_depth_);
    return by_depth_ ? find_nearer(std::span(some.depth, end - begin), from_.empty_depth, mask)
                     : find_with_alpha(std::span(some.colour, end - begin), mask);
  }

  // Pixels of the layer's order that lie in no more than a group, of which depths and, if asked
  // for, colours are needed.
  SomePixels<Colour> view(std::uint64_t begin, std::uint64_t end, bool colours) const {
    const auto width = static_cast<std::ptrdiff_t>(this->image().width);
    const auto first_row = static_cast<int>(static_cast<std::ptrdiff_t>(begin) / width);
    const auto last_row = static_cast<int>(static_cast<std::ptrdiff_t>(end - 1) / width);
    const geometry::Rect& window = from_.window;
    SomePixels<Colour> result;
    const bool whole_rows = window.x0 == 0 && window.x1 == width && from_.stride == width &&
                            first_row >= window.y0 && last_row < window.y1;
    const std::ptrdiff_t first = from_.origin + static_cast<std::ptrdiff_t>(begin);
    if (by_depth_) {
      if (whole_rows) {
        result.depth = from_.depth + first;
      } else {
        result.own_depth = copy(from_.depth, from_.empty_depth, begin, end);
        result.depth = result.own_depth.data();
      }
    }
    if (!colours) return result;
    if (whole_rows && from_.colour != nullptr) {
      result.colour = from_.colour + first;
    } else {
      result.own_colour = copy(from_.colour, Colour{}, begin, end);
      result.colour = result.own_colour.data();
    }
    return result;
  }

  // Values of pixels, `outside` where there are none.
  template <class T>
  image::Plane<T> copy(const T* plane, T outside, std::uint64_t begin, std::uint64_t end) const {
    image::Plane<T> result(end - begin);
    std::fill_n(result.data(), result.size(), outside);
    if (plane == nullptr || from_.window.empty()) return result;
    const auto width = static_cast<std::ptrdiff_t>(this->image().width);
    const auto b = static_cast<std::ptrdiff_t>(begin), e = static_cast<std::ptrdiff_t>(end);
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
      is_settled_[i] = 1;
      const PixelRange block = block_pixels(i);
      const SomePixels<Colour> some = view(block.begin, block.end, /*colours=*/true);
      Colour* const colour = this->image().colour.data() + block.begin;
      if (!by_depth_) {
        for (std::size_t k = 0; k < block.size(); ++k) {
          colour[k] = some.colour[k].a != 0 ? some.colour[k] : Colour{};
        }
        return;
      }
      float* const depth = this->image().depth.data() + block.begin;
      for (std::size_t k = 0; k < block.size(); ++k) {
        const bool covered = some.depth[k] < from_.empty_depth;
        colour[k] = covered ? some.colour[k] : Colour{};
        depth[k] = covered ? some.depth[k] : image::kEmptyDepth;
      }
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
