// Copies the share of a rank into a layer for each run, in memory that the run before has given
// back.
#include "apps/share_layers.h"

#include <algorithm>
#include <utility>

#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/flatten.h"

namespace delray::apps {
namespace {

using Surfaces = composite::DeepImage<image::RgbaF>;

Surfaces copy_of(const Surfaces& surfaces) {
  Surfaces copy(surfaces.width, surfaces.height);
  std::copy_n(surfaces.lists.data(), surfaces.lists.size(), copy.lists.data());
  copy.chunks = surfaces.chunks;
  return copy;
}

}  // namespace

bool is_transparent(const raster::PartialImage& share) {
  return !std::holds_alternative<image::Image8>(share);
}

std::unique_ptr<composite::Layer> ShareLayers::make(const std::string& codec) {
  if (const auto* surfaces = std::get_if<Surfaces>(&share_))
    return composite::make_deep(copy_of(*surfaces));
  const auto& image = std::get<image::Image8>(share_);
  if (spare_.pixels() != image.pixels()) spare_ = image::Image8(image.width, image.height);
  std::copy_n(image.colour.data(), image.pixels(), spare_.colour.data());
  std::copy_n(image.depth.data(), image.pixels(), spare_.depth.data());
  return composite::find_codec(codec)->make(std::exchange(spare_, {}));
}

image::Image8 ShareLayers::image_of(composite::OwnedPixels&& part) const {
  if (is_transparent(share_))
    return composite::flatten<image::Rgba8>(composite::take_deep<image::RgbaF>(std::move(part)));
  return composite::take_image<image::Rgba8>(std::move(part));
}

}  // namespace delray::apps
