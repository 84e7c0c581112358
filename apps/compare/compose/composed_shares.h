// The images that the ranks of sort-last have drawn, and the time that it takes to composite them.
#pragma once

#include <string>
#include <vector>

#include "apps/compare/compose/compare_compose.h"
#include "apps/share_layers.h"
#include "comm/communicator.h"
#include "composite/deep_shape.h"
#include "composite/mask.h"
#include "composite/simulate.h"
#include "raster/render.h"

namespace delray::apps {

// The shapes of the ranks' images without pixels: masks of flat ones, or where surfaces lie.
class ShareShapes {
 public:
  // The next rank's.
  void add(const raster::PartialImage& share);
  // REQUIRES: all shares were transparent for codec "deep", and flat for others, which
  // metadata-only layers can stand for. Valid as long as this is.
  composite::MetadataOnlyImages metadata_only(const std::string& codec, int width) const;
  bool are_transparent() const { return !deep_.empty(); }

 private:
  composite::MaskMaker maker_;
  std::vector<composite::ImageMasks> masks_;
  std::vector<composite::DeepShape> deep_;
};

// Draws the shares of so many ranks one by one. Parallel in the caller's arena.
class ShareDrawer {
 public:
  ShareDrawer(const CompareRequest& request, const Prepared& prepared,
              parallel::Progress* progress);
  raster::PartialImage draw(int rank, int ranks);
  // The shapes of all ranks, from the first to the last.
  ShareShapes shapes(int ranks);

 private:
  const Prepared& prepared_;
  raster::RenderOptions options_;
  parallel::Progress* progress_;
  raster::Renderer renderer_;
};

// One scheme with one codec, run again and again.
struct MeasuredScheme {
  std::string scheme, codec;
  composite::Counts compose, gather;                    // on rank 0
  std::string hash;                                     // on rank 0
  std::vector<double> compose_seconds, gather_seconds;  // of each run, until the last rank is done
};

// Collective: composites copies of the shares once more. The first time is to warm up, which is
// when it counts; those that follow are timed, on rank 0. Schemes that are to be compared should
// take turns and use the same memory: the machine may become faster or slower by a third.
void measure(comm::Communicator& communicator, ShareLayers& layers, const CompareRequest& request,
             const Prepared& prepared, bool is_first, MeasuredScheme& measured);

}  // namespace delray::apps
