// What the ranks of sort-last have drawn, and what it takes to composite it.
#pragma once

#include <string>
#include <vector>

#include "apps/compare_compose.h"
#include "apps/share_layers.h"
#include "comm/communicator.h"
#include "composite/deep_shape.h"
#include "composite/mask.h"
#include "composite/simulate.h"
#include "raster/render.h"

namespace delray::apps {

// What is known without pixels of the shares of ranks: masks of flat ones, or where surfaces lie.
class ShareShapes {
 public:
  // The next rank's.
  void add(const raster::Share& share);
  // REQUIRES: all shares were transparent for codec "deep", and flat for others, which hollow
  // layers can stand for. Valid as long as this is.
  composite::HollowImages hollow(const std::string& codec, int width) const;
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
  raster::Share draw(int rank, int ranks);
  // Of all ranks, from the first to the last.
  ShareShapes shapes(int ranks);

 private:
  const Prepared& prepared_;
  raster::RenderOptions options_;
  parallel::Progress* progress_;
  raster::Renderer renderer_;
};

struct MeasuredScheme {
  composite::Counts compose, gather;
  Spread compose_seconds, gather_seconds;  // until the last rank is done
  std::string hash;                        // on rank 0
};

// Collective: composites copies of the shares `repeats` times after once to warm up, which is when
// it counts. Schemes that are to be compared should use the same memory, which may be faster or
// slower by a third: give them the same layers. The result is rank 0's.
MeasuredScheme measure_scheme(comm::Communicator& communicator, ShareLayers& layers,
                              const std::string& scheme, const std::string& codec, int repeats,
                              const CompareRequest& request, const Prepared& prepared);

}  // namespace delray::apps
