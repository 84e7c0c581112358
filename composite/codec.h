// Codecs: how partial images travel, whatever the scheme.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "composite/image_layer.h"
#include "image/image.h"

namespace delray::composite {

// All ranks of a composition use the same. The layer that make() gives is an ImageLayer: take_image
// gives the image back.
struct Codec {
  const char* name;
  const char* description;
  std::unique_ptr<Layer> (*make_8)(image::Image8&& image, Operator how);
  std::unique_ptr<Layer> (*make_f)(image::ImageF&& image, Operator how);

  std::unique_ptr<Layer> make(image::Image8&& image, Operator how = Operator::nearest) const {
    return make_8(std::move(image), how);
  }
  std::unique_ptr<Layer> make(image::ImageF&& image, Operator how = Operator::nearest) const {
    return make_f(std::move(image), how);
  }
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Codec> codecs();

// nullptr when there is no such codec.
const Codec* find_codec(std::string_view name);

}  // namespace delray::composite
