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
#include <optional>
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

// As something that compilers select by vectors.
const std::uint32_t* words(const image::Rgba8* colour) {
  return reinterpret_cast<const std::uint32_t*>(colour);
}
std::uint32_t* words(image::Rgba8* colour) { return reinterpret_cast<std::uint32_t*>(colour); }
const image::RgbaF* words(const image::RgbaF* colour) { return colour; }
image::RgbaF* words(image::RgbaF* colour) { return colour; }

template <class Word>
void take_nearer(const Word* colour, const float* depth, std::size_t size, float empty_depth,
                 Word background, Word* to) {
  for (std::size_t k = 0; k < size; ++k) to[k] = depth[k] < empty_depth ? colour[k] : background;
}

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
    this->set_background(pixels.background);
  }

  comm::Buffer encode(PixelRange range) override {
    if (settled(blocks_of(range)) == Settled::all) return ActiveLayer<Colour>::encode(range);
    const Coverage coverage(range.size(),
                            [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
                              return find({range.begin + begin, range.begin + end}, mask);
                            });
    return internal::encode_active<Colour>(
        coverage, this->has_depth(), [&](std::uint64_t begin, std::uint64_t end) {
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
    const Coverage coverage(range.size(), {pixels.data(), pixels.size()});
    if (action == Action::replace) {
      // Only at its ends others are left in a block.
      if (blocks.begin < blocks.end) settle_blocks({blocks.begin, blocks.begin + 1});
      if (blocks.begin + 1 < blocks.end) settle_blocks({blocks.end - 1, blocks.end});
      for (std::uint64_t i = blocks.begin; i < blocks.end; ++i) is_settled_[i] = 1;
    } else {
      settle_covered(range, coverage);
    }
    return this->apply_covered(range, coverage, pixels, action);
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
            take(part, colour, by_depth_ ? depth : nullptr);
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

  // Borrowed pixels become those of a layer; without depths if there is no place for them.
  void take(PixelRange pixels, Colour* colour, float* depth) const {
    for_each_run(pixels, [&](std::size_t at, std::size_t size, std::optional<std::ptrdiff_t> from) {
      const Colour* const colours =
          from && from_.colour != nullptr ? from_.colour + *from : nullptr;
      if (!by_depth_) {
        for (std::size_t k = 0; k < size; ++k)
          colour[at + k] = colours != nullptr && colours[k].a != 0 ? colours[k] : Colour{};
        return;
      }
      if (!from) {
        std::fill_n(colour + at, size, from_.background);
      } else if (colours == nullptr) {
        for (std::size_t k = 0; k < size; ++k) {
          const bool covered =
              from_.depth[*from + static_cast<std::ptrdiff_t>(k)] < from_.empty_depth;
          colour[at + k] = covered ? Colour{} : from_.background;
        }
      } else {
        take_nearer(words(colours), from_.depth + *from, size, from_.empty_depth,
                    *words(&from_.background), words(colour + at));
      }
      if (depth == nullptr) return;
      if (!from) {
        std::fill_n(depth + at, size, image::kEmptyDepth);
      } else {
        take_nearer(from_.depth + *from, from_.depth + *from, size, from_.empty_depth,
                    image::kEmptyDepth, depth + at);
      }
    });
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
    for_each_run(pixels, [&](std::size_t at, std::size_t size, std::optional<std::ptrdiff_t> from) {
      if (from && plane != nullptr) {
        std::copy_n(plane + *from, size, result.data() + at);
      } else {
        std::fill_n(result.data() + at, size, outside);
      }
    });
    return result;
  }

  // Calls f(first, size, from) for runs of pixels, counted from the first of the range, that are
  // neighbours at `from` in the planes, or outside of the window.
  template <class F>
  void for_each_run(PixelRange pixels, F&& f) const {
    const auto width = static_cast<std::ptrdiff_t>(this->image().width);
    const auto end = static_cast<std::ptrdiff_t>(pixels.end);
    const geometry::Rect& window = from_.window;
    auto at = static_cast<std::ptrdiff_t>(pixels.begin);
    const auto run = [&](std::ptrdiff_t to, std::optional<std::ptrdiff_t> from) {
      if (to > at) {
        f(static_cast<std::size_t>(at) - pixels.begin, static_cast<std::size_t>(to - at), from);
        at = to;
      }
    };
    while (at < end) {
      const std::ptrdiff_t y = at / width, row = y * width;
      if (window.empty() || y >= window.y1) {
        run(end, {});
      } else if (y < window.y0) {
        run(std::min(end, window.y0 * width), {});
      } else {
        run(std::min(end, row + window.x0), {});
        run(std::min(end, row + window.x1), from_.origin + y * from_.stride + (at - row));
        run(std::min(end, row + width), {});
      }
    }
  }

  // The blocks of groups of a range in which anything is covered.
  void settle_covered(PixelRange range, const Coverage& coverage) {
    std::vector<char> wanted(is_settled_.size());
    for (std::size_t i = 0; i < coverage.groups(); ++i) {
      const Coverage::Group group = coverage.group(i);
      if (group.covered == 0) continue;
      const PixelRange blocks = blocks_of({range.begin + group.begin, range.begin + group.end});
      for (std::uint64_t k = blocks.begin; k < blocks.end; ++k) wanted[k] = 1;
    }
    settle_if(blocks_of(range), [&](std::size_t i) { return wanted[i] != 0; });
  }
  void settle_blocks(PixelRange blocks) {
    settle_if(blocks, [](std::size_t /*block*/) { return true; });
  }
  template <class F>
  void settle_if(PixelRange blocks, F&& is_wanted) {
    parallel::parallel_for(blocks.begin, blocks.end, internal::kGroupsGrain, [&](std::size_t i) {
      if (is_settled_[i] != 0 || !is_wanted(i)) return;
      const PixelRange block = block_pixels(i);
      take(block, this->image().colour.data() + block.begin,
           this->has_depth() ? this->image().depth.data() + block.begin : nullptr);
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
