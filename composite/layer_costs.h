// Costs of encoding and merging layers on a machine.
#pragma once

#include <cstdint>

#include "composite/codec.h"

namespace delray::composite {

// Seconds of one processor, by codec.
struct LayerCosts {
  double encode = 0;         // each message encoded
  double encode_pixel = 0;   // and for each pixel of the range
  double encode_byte = 0;    // and for each byte of the message
  double merge = 0;          // each merge
  double merge_pixel = 0;    // and for each pixel of the range
  double merge_covered = 0;  // and for each pixel composited
};

// Measures images with 8-bit colours, on this machine: threads, as ranks with a core each,
// composite images of `pixels` pixels, empty, covered in part and full, with several schemes in
// turns; the time that each spends in cuts and merges is taken, and the costs are fitted to the
// medians. Some hundred times as long as it takes to composite once. Not the same from run to run.
//
// REQUIRES: pixels >= 4096.
LayerCosts measure_layer_costs(const Codec& codec, std::uint64_t pixels = std::uint64_t{1} << 21);

// Measures deep layers, which composite fragments, of RgbaF: where the images are covered, one
// to three each.
LayerCosts measure_deep_layer_costs(std::uint64_t pixels = std::uint64_t{1} << 18);

}  // namespace delray::composite
