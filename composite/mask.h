// A set of pixels of an image: which ones a rank has covered, without their values.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "composite/coverage.h"
#include "composite/image_layer.h"
#include "composite/layer.h"

namespace delray::composite {

// One bit per pixel; groups of kGroupPixels without any take no memory, so that thousands of ranks
// that have drawn little each fit into one process.
class PixelMask {
 public:
  // The mask of an image of so many pixels, none of them in the set.
  explicit PixelMask(std::uint64_t pixels);
  PixelMask(PixelMask&&) noexcept = default;
  PixelMask& operator=(PixelMask&&) noexcept = default;

  PixelMask copy() const;
  std::uint64_t pixels() const { return pixels_; }
  bool empty() const;
  // Whether none of the range is in the set. REQUIRES: range.end <= pixels().
  bool empty(PixelRange range) const;

  // Sets the bits of the pixels of [begin, end) that are in the set, bit 0 for `begin`, and returns
  // how many there are. REQUIRES: mask is zero; end - begin <= kGroupPixels; end <= pixels().
  std::uint64_t read(std::uint64_t begin, std::uint64_t end, GroupMask& mask) const;
  // Adds pixel begin + i for every bit i. REQUIRES: all of them are below pixels().
  void add(std::uint64_t begin, const GroupMask& mask);
  void remove(std::uint64_t begin, const GroupMask& mask);
  void remove(PixelRange range);

 private:
  std::uint64_t element(std::uint64_t i) const;
  std::uint64_t& writable_element(std::uint64_t i);
  // Calls f(element, its bits in the range) where a group is there, in order, while it returns
  // true; returns whether it always did.
  template <class F>
  bool for_elements(PixelRange range, F&& f) const;

  std::uint64_t pixels_;
  std::vector<std::unique_ptr<GroupMask>> groups_;  // null: none of its pixels
};

// Metadata of a rank's image.
struct ImageMasks {
  PixelMask covered;
  PixelMask unhidden;  // those of them that no lower rank hides
  ImageMasks copy() const { return {covered.copy(), unhidden.copy()}; }
};

// The masks of the images of all ranks, from the lowest up: rank 0, or the first of
// ComposeOptions::order.
class MaskMaker {
 public:
  // The next rank's depths, for Operator::nearest; of as many pixels as the first's. O(pixels).
  ImageMasks add(std::span<const float> depth);
  // The next rank's image; all of one size and for one operator. No colour is negative. O(pixels).
  template <class Colour>
  ImageMasks add(const image::BasicImage<Colour>& image, Operator how);

 private:
  std::vector<float> nearest_;          // of all ranks so far
  std::optional<PixelMask> concealed_;  // by any rank so far, of layers that are blended
};

extern template ImageMasks MaskMaker::add(const image::Image8& image, Operator how);
extern template ImageMasks MaskMaker::add(const image::ImageF& image, Operator how);

}  // namespace delray::composite
