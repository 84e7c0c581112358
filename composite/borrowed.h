// Layers over pixels in somebody else's memory: what travels is read there, and only what the rank
// merges itself is copied.
#pragma once

#include <cstddef>
#include <memory>

#include "composite/image_layer.h"
#include "geometry/rect.h"
#include "image/image.h"

namespace delray::composite {

// Pixel (x, y) of a layer, at element origin + y * stride + x of both planes, as a renderer has
// them.
template <class Colour>
struct BorrowedPixels {
  const Colour* colour = nullptr;  // null: colours are {}
  const float* depth = nullptr;    // null: none, for Operator::over
  std::ptrdiff_t origin = 0, stride = 0;
  geometry::Rect window{};  // the part of the layer where the planes are looked at
  // Operator::nearest takes pixels of this depth and deeper ones, and NaN, for empty, whatever
  // their colour, Operator::over those with an alpha of 0.
  float empty_depth = 1;
  Colour background{};  // of the layer's pixels that are empty: see ImageLayer::set_background
};

// A layer that understands, and is understood by, those of codec "active". `image` gives its size
// and becomes the one of the layer; its pixels are not looked at. They are those of the layer where
// something was merged or replaced, or after settle(); memory that is not needed is not touched.
//
// REQUIRES: the planes stay as they are while the layer is in use; the window lies in the layer;
// how is nearest or over.
std::unique_ptr<Layer> make_borrowed(image::Image8&& image,
                                     const BorrowedPixels<image::Rgba8>& pixels, Operator how);
std::unique_ptr<Layer> make_borrowed(image::ImageF&& image,
                                     const BorrowedPixels<image::RgbaF>& pixels, Operator how);

// Makes the pixels of a range be in the layer's image; does nothing for layers that borrow none.
void settle(Layer& layer, PixelRange range);

}  // namespace delray::composite
