// Codecs: how the partial images of opaque scenes travel, whatever the scheme.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "composite/layer.h"
#include "image/image.h"

namespace delray::composite {

// All ranks of a composition use the same. The layer that make() gives is an ImageLayer: take_image
// gives the image back.
struct Codec {
  const char* name;
  const char* description;
  std::unique_ptr<Layer> (*make_8)(image::Image8&& image);
  std::unique_ptr<Layer> (*make_f)(image::ImageF&& image);

  std::unique_ptr<Layer> make(image::Image8&& image) const { return make_8(std::move(image)); }
  std::unique_ptr<Layer> make(image::ImageF&& image) const { return make_f(std::move(image)); }
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Codec> codecs();

// nullptr when there is no such codec.
const Codec* find_codec(std::string_view name);

}  // namespace delray::composite
