// One run of a compositing scheme, to be looked at.
#pragma once

#include <string>
#include <vector>

#include "apps/compare/compose/composed_shares.h"
#include "comm/ledger.h"
#include "image/image.h"

namespace delray::apps {

struct ShownScheme {
  std::string scheme, codec;
  comm::Ledger ledger;
  std::vector<image::Image8> partial;  // what each rank had drawn, reduced
  std::vector<image::Image8> pieces;   // what each rank owned in the end, reduced; else transparent
  image::Image8 picture;
};

// The number of runs, of which the one that takes the median time is shown.
inline constexpr int kShownRuns = 5;

// Collective: composites copies of the shares once more. The result is rank 0's.
ShownScheme show_scheme(comm::Communicator& communicator, const raster::PartialImage& share,
                        const std::string& scheme, const std::string& codec,
                        const CompareRequest& request, const Prepared& prepared);

// Each pixel the mean of side x side of the image's, the last row and column of what there is.
// REQUIRES: side >= 1.
image::Image8 reduced(const image::Image8& image, int side);

}  // namespace delray::apps
