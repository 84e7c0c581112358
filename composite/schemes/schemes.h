// The functions behind the table of schemes, one file each.
//
// A is the number of pixels, n of ranks. Costs are those of dense layers; pixels sent, received and
// composited by one rank, up to rounding where pieces cannot be equal.
#pragma once

#include "composite/scheme.h"

namespace delray::composite::internal {

// Rank 0 receives and merges the whole image of every other rank, in rank order. One round; the
// others send A, rank 0 composites (n-1) A.
OwnedPixels centralized(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                        const ComposeOptions& options);

// The last rank hands its image to the one before, which merges and hands it on, down to rank 0, in
// P pieces so that all ranks work at a time (PixelFlow: Molnar, Eyles and Poulton 1992). n - 2 + P
// rounds; all but the last composite A, all but the first send A.
OwnedPixels pipeline(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                     const ComposeOptions& options);

// Binomial tree: every round half of the ranks that are left send their image to the other half.
// ceil(log2 n) rounds; all but rank 0 send A, which composites A in each round.
OwnedPixels tree(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options);

// Binary swap (Ma, Painter, Hansen and Krogh 1994): in each round partners exchange halves of the
// range that both hold, and merge the half they keep. A power of two takes log2 n rounds, in which
// each rank sends and composites A (1 - 1/n). Of other counts, p is the largest power of two below.
//
// Folded: n - p pairs of neighbours become one rank each before. One round more, A more for both.
OwnedPixels binary_swap_folded(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                               const ComposeOptions& options);
// Remainder (Moreland 2018; the 3-2 elimination of Rabenseifner and Traeff 2004): in each round
// whoever has no partner sends a half to either of the last pair, and is done. floor(log2 n)
// rounds.
OwnedPixels binary_swap_remainder(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                                  const ComposeOptions& options);
// Telescoping (Moreland, Kendall, Peterka and Huang 2011): groups, each the largest power of two of
// what is left, swap on their own; then each hands its pieces to the next larger one.
OwnedPixels binary_swap_telescoping(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                                    const ComposeOptions& options);
// 2-3-4 (Nonaka, Ono and Fujita 2018): p / 2 groups of two, three or four; all of a group send one
// half to its first, the other to its second, and those swap. floor(log2 n) rounds.
OwnedPixels binary_swap_234(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                            const ComposeOptions& options);

// Ranks are a mesh, column by column: strips are exchanged among the ranks of a column, then
// regions of the strip among the ranks of a row, one message a round (Lee 1996). With r rows and c
// columns r + c - 2 rounds; each rank sends and composites A (1 - 1/n).
// Options: columns, rows; otherwise as square as the factors of n allow.
OwnedPixels mesh(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options);

// Every rank in turn sends its image to all that come later, which forget what it hides, and to
// rank 0, which merges (Cox and Hanrahan 1994). n rounds. Counted as messages from rank to rank; on
// a medium that all listen to, each image travels once.
OwnedPixels bus(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                const ComposeOptions& options);

// Every rank owns an n-th of the image, which all others send it (Hsu 1993). One round of n - 1
// messages per rank; each sends and composites A (1 - 1/n).
OwnedPixels direct_send(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                        const ComposeOptions& options);

// Radix-k (Peterka, Goodell, Ross, Shen and Thakur 2009): rounds of direct-send in groups of k. The
// product m of all radices is n or, where n has large factors, a little less: the n - m extra ranks
// are spread over blocks of P neighbours each, to whose members they send a P-th of their image,
// and own nothing (radices.h). Members send A (1 - 1/m) and composite as much, and A / P
// for each extra rank of the block. Options: the radices, round by round, of which the last is
// repeated; a factor is taken as near below each as there is. Without: up to 8.
OwnedPixels radix_k(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                    const ComposeOptions& options);

// 2-3 swap (Yu, Wang and Ma 2008): a tree of groups, each of two or three smaller ones, all leaves
// at one depth. The members of a group of s hold an s-th each; when groups join, pieces change
// hands so that the members of the new one do. floor(log2 n) rounds.
OwnedPixels two_three_swap(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                           const ComposeOptions& options);

// Direct-send of small tiles that are assigned to the ranks in turn, composited as they arrive
// (OSPRay's distributed framebuffer: Usher, Wald, Amstutz et al. 2019). See tiles.h.
OwnedPixels tiles(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                  const ComposeOptions& options);

}  // namespace delray::composite::internal
