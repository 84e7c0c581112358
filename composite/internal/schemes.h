// The functions behind the table of schemes, one file each.
#pragma once

#include "composite/scheme.h"

namespace delray::composite::internal {

// Rank 0 receives and merges the whole image of every other rank, in rank order. One round; the
// others send S bytes each (S: an encoded image), rank 0 composites (n-1) * pixels.
Part centralized(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options);

// Binary swap (Ma, Painter, Hansen and Krogh 1994): in each round partners exchange halves of the
// range that both hold, and merge the half they keep. Of n ranks, p is the largest power of two
// that is at most n; first n - p pairs of neighbours fold into one rank each. Rounds: log2 p, and
// one for folding where n > p. Each of the p ranks sends, receives and composites
// pixels * (1 - 1/p) in the swap and owns pixels / p at the end, up to rounding.
Part binary_swap(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options);

}  // namespace delray::composite::internal
