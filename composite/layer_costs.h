// What cutting and merging of layers takes on a machine.
#pragma once

namespace delray::composite {

// Seconds of one processor, by codec.
struct LayerCosts {
  double cut = 0;            // each cut
  double cut_pixel = 0;      // and for each pixel of the range
  double cut_byte = 0;       // and for each byte of the message
  double merge = 0;          // each merge
  double merge_pixel = 0;    // and for each pixel of the range
  double merge_covered = 0;  // and for each pixel composited
};

}  // namespace delray::composite
