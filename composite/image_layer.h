// Layers of images: how pixels of two are merged. The codec decides how they travel.
#pragma once

#include <memory>
#include <utility>

#include "composite/coverage.h"
#include "composite/layer.h"
#include "composite/shown_blocks.h"
#include "image/image.h"
#include "image/operators.h"

namespace delray::composite {

// Operators that merge pixels.
enum class Operator : std::uint8_t {
  // The nearer one wins, the lower interval of ranks on equal depths. A pixel that nothing covers
  // has kEmptyDepth and the colour {}, or the background, so that every codec leaves the same
  // bytes.
  nearest,
  // The lower interval of ranks lies over the higher (Porter and Duff 1984): ordered blending of
  // layers that were blended before. Depths are neither read nor written and do not travel; a pixel
  // that nothing covers has the colour {}. Rounded after every merge, so that the result depends on
  // the scheme and the number of ranks, by no more than docs/compositing.md says.
  over,
  // The same, and depths travel: a pixel has that of the foremost layer that covers it, which is to
  // say, has a depth there.
  over_with_depth,
};

// Owns the image. A codec derives from it, for encode and apply.
template <class Colour>
class ImageLayer : public Layer {
 public:
  explicit ImageLayer(image::BasicImage<Colour>&& image, Operator how = Operator::nearest)
      : image_(std::move(image)), operator_(how) {}

  image::BasicImage<Colour>& image() { return image_; }
  const image::BasicImage<Colour>& image() const { return image_; }

  // From now on only colours travel, of the pixels that were covered till then, and depths are not
  // changed any more: what is replaced, or settled (borrowed.h), is not to be encoded again, nor
  // what lies in the same group of pixels (coverage.h).
  void forget_depth() { forgets_depth_ = true; }
  // The colour of pixels that nothing covers, {} if not set: what replaces others by nothing leaves
  // it. Those that are there already are not changed. REQUIRES: Operator::nearest; alike on ranks.
  void set_background(Colour colour) { background_ = colour; }

  // What may be covered in the image, where that is known; kept up to date by what is applied.
  // REQUIRES: no background is set.
  void set_shown(ShownBlocks&& shown) { shown_ = std::move(shown); }
  ShownBlocks take_shown() { return std::exchange(shown_, {}); }

  std::uint64_t pixels() const final { return image_.pixels(); }
  int format() const final { return static_cast<int>(operator_); }
  bool empty() const override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) final {
    return apply(range, pixels, from == Side::lower ? Action::merge_lower : Action::merge_higher);
  }
  void replace(PixelRange range, const comm::Buffer& pixels) final {
    apply(range, pixels, Action::replace);
  }
  std::uint64_t prune(PixelRange range, const comm::Buffer& pixels) final {
    return apply(range, pixels, Action::prune);
  }

 protected:
  enum class Action : std::uint8_t { merge_lower, merge_higher, replace, prune };
  // Consecutive pixels that arrived, or the covered ones among them; `depth` may be anything
  // where has_depth() is false.
  struct Pixels {
    const Colour* colour = nullptr;
    const float* depth = nullptr;
    std::size_t readable = 0;  // values that both pointers may be read at
  };

  // Does `action` with what encode(range) gave elsewhere; returns the pixels that it looked at.
  virtual std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) = 0;

  // Whether depths travel.
  bool has_depth() const { return operator_ != Operator::over && !forgets_depth_; }
  std::size_t bytes_per_pixel() const { return sizeof(Colour) + (has_depth() ? sizeof(float) : 0); }
  // Sets the bits of covered pixels of a group and returns how many. REQUIRES: mask is zero.
  std::uint64_t find_covered(std::size_t begin, std::size_t end, GroupMask& mask) const;

  // To pixels [first, first + size) of the image: all of them, the covered ones of a group, or
  // none, which matters to replace only.
  void apply_to_all(Action action, std::size_t first, std::size_t size, const Pixels& pixels);
  void apply_to_covered(Action action, std::size_t first, std::size_t size, const GroupMask& mask,
                        const Pixels& covered);
  void apply_to_none(Action action, std::size_t first, std::size_t size);

 private:
  // As find_covered, of pixels of which nothing is known.
  std::uint64_t find_in_all(std::size_t begin, std::size_t end, GroupMask& mask) const;
  void prune_pixel(std::size_t pixel, const Pixels& others, std::size_t k);

  image::BasicImage<Colour> image_;
  Operator operator_;
  Colour background_{};
  bool forgets_depth_ = false;
  ShownBlocks shown_;
};

extern template class ImageLayer<image::Rgba8>;
extern template class ImageLayer<image::RgbaF>;

// The image of a part; only the part's ranges of it are final.
//
// REQUIRES: the part's layer is an ImageLayer<Colour>, whatever its codec.
template <class Colour>
image::BasicImage<Colour> take_image(OwnedPixels&& part) {
  return std::move(dynamic_cast<ImageLayer<Colour>&>(*part.layer).image());
}

// For a finished part whose colours are all that the rank it is gathered on needs; depths stay as
// they are. On all ranks, as take_image.
template <class Colour>
void forget_depth(OwnedPixels& part) {
  dynamic_cast<ImageLayer<Colour>&>(*part.layer).forget_depth();
}

}  // namespace delray::composite
