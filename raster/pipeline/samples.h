// Supersampling: a pixel is n x n samples, which the pixel's owner averages.
//
// A frame of samples is a frame of n times the width and height. Where samples travel, those of a
// pixel lie together: sample (i, j) of pixel p is element p * n * n + j * n + i.
#pragma once

#include "composite/layer.h"
#include "geometry/rect.h"
#include "raster/pipeline/window.h"

namespace delray::raster {

// The samples of the pixels.
inline geometry::Rect samples_of(const geometry::Rect& pixels, int n) {
  return {pixels.x0 * n, pixels.y0 * n, pixels.x1 * n, pixels.y1 * n};
}
// The pixels with a sample in the rectangle.
inline geometry::Rect pixels_of(const geometry::Rect& samples, int n) {
  return {samples.x0 / n, samples.y0 / n, (samples.x1 + n - 1) / n, (samples.y1 + n - 1) / n};
}

// Pixels from a window of samples: the mean colour in linear light (codes of 8 bits are looked up
// and summed as whole numbers), and the least depth.
template <class Colour>
void resolve(const Window<Colour>& samples, int n, const geometry::Rect& pixels,
             const Window<Colour>& window);

// The samples of `pixels`, row by row in one window, into an image that has them together: its
// width is n * n times that of the frame.
template <class Colour>
void gather_samples(const Window<Colour>& samples, int n, const geometry::Rect& pixels,
                    image::BasicImage<Colour>& image);

// Of a part of an image with samples together, the same part in pixels. `width` and `height` are
// the frame's.
//
// REQUIRES: the part's ranges are of whole pixels.
template <class Colour>
composite::OwnedPixels resolve(composite::OwnedPixels&& part, int n, int width, int height);

}  // namespace delray::raster
