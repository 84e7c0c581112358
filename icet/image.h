// Behind IceTImage: planes of pixels in the formats of the interface.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "icet/interface.h"
#include "image/image.h"

namespace delray::icet {

// Images of past frames, to be drawn into again: fresh memory from the system takes longer to write
// to than compositing takes.
class ImagePool {
 public:
  // Not initialised.
  image::Image8 take(int width, int height, image::Rgba8 /*type*/) {
    return take_from(bytes_, width, height);
  }
  image::ImageF take(int width, int height, image::RgbaF /*type*/) {
    return take_from(floats_, width, height);
  }
  void give_back(image::Image8&& image) { give_back_to(bytes_, std::move(image)); }
  void give_back(image::ImageF&& image) { give_back_to(floats_, std::move(image)); }

 private:
  static constexpr std::size_t kMost = 16;

  template <class Pixels>
  static Pixels take_from(std::vector<Pixels>& kept, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (Pixels& candidate : kept) {
      if (candidate.pixels() != pixels) continue;
      std::swap(candidate, kept.back());
      Pixels result = std::move(kept.back());
      kept.pop_back();
      result.width = width;
      result.height = height;
      return result;
    }
    return Pixels(width, height);
  }
  // Of several sizes the one that was given back first goes.
  template <class Pixels>
  static void give_back_to(std::vector<Pixels>& kept, Pixels image) {
    if (image.pixels() == 0) return;
    if (kept.size() == kMost) kept.erase(kept.begin());
    kept.push_back(std::move(image));
  }

  std::vector<image::Image8> bytes_;
  std::vector<image::ImageF> floats_;
};

// What opaque_internals points to. `bytes` has the pixels of 8-bit colours and of images without
// colour, `floats` those of float colours. Of RGB the colours are in `rgb`, three values a pixel.
struct Image {
  int width = 0, height = 0;
  IceTEnum colour_format = ICET_IMAGE_COLOR_NONE, depth_format = ICET_IMAGE_DEPTH_NONE;
  image::Image8 bytes;
  image::ImageF floats;
  image::Plane<float> rgb;

  bool is_float() const {
    return colour_format == ICET_IMAGE_COLOR_RGBA_FLOAT ||
           colour_format == ICET_IMAGE_COLOR_RGB_FLOAT;
  }
  bool is_rgb() const { return colour_format == ICET_IMAGE_COLOR_RGB_FLOAT; }
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  image::Image8& planes(image::Rgba8 /*type*/) { return bytes; }
  image::ImageF& planes(image::RgbaF /*type*/) { return floats; }
  float* depth() { return is_float() ? floats.depth.data() : bytes.depth.data(); }
};

inline IceTImage handle_of(Image& image) { return IceTImage{&image}; }

}  // namespace delray::icet
