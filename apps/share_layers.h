// Layers of what a rank has drawn, for one composition after the other.
#pragma once

#include <memory>
#include <string>

#include "composite/scheme.h"
#include "raster/render.h"

namespace delray::apps {

// The layers of repeated runs, in the same memory: fresh memory takes long to write to.
class ShareLayers {
 public:
  // REQUIRES: the share outlives this.
  explicit ShareLayers(const raster::PartialImage& share) : share_(share) {}

  // A copy of the share; its codec counts for flat ones only.
  std::unique_ptr<composite::Layer> make(const std::string& codec);
  // The image of a part, only the part's ranges of which are final.
  image::Image8 image_of(composite::OwnedPixels&& part) const;
  void recycle(image::Image8&& image) { spare_ = std::move(image); }

 private:
  const raster::PartialImage& share_;
  image::Image8 spare_;
};

// Whether layers are lists of surfaces, whatever the codec.
bool is_transparent(const raster::PartialImage& share);

}  // namespace delray::apps
