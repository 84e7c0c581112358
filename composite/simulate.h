// Compositing on the simulated machine: what a scheme moves and how long it would take there, of as
// many ranks as one likes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "comm/ledger.h"
#include "comm/network.h"
#include "composite/layer_costs.h"
#include "composite/mask.h"
#include "composite/metadata_only.h"
#include "composite/scheme.h"

namespace delray::composite {

// Counted exactly, over all ranks.
struct Counts {
  std::uint64_t rounds = 0;  // numbers of rounds in which anybody sent or received
  std::uint64_t bytes_total = 0, bytes_sent_max = 0, bytes_received_max = 0;
  std::uint64_t messages = 0;
  std::uint64_t pixels_composited_total = 0, pixels_composited_max = 0;
  bool operator==(const Counts&) const = default;
};
Counts count(std::span<const comm::Tally> ranks, comm::Phase phase);
// Collective: the same of all ranks of the communicator, each of which has its own tally; the
// result is rank 0's. Call it on the communicator that was recorded, not on the recording.
Counts count(comm::Communicator& communicator, const comm::Tally& own, comm::Phase phase);

// Metadata of the ranks' images, and how they send them.
struct MetadataOnlyImages {
  std::span<const ImageMasks> ranks;  // at least one, all of one size; without MetadataOnly::deep
  MetadataOnly codec = MetadataOnly::dense;
  std::size_t pixel_bytes = kPixelBytes8;  // or another of metadata-only.h
  std::uint64_t width = 1;                 // of the images, for MetadataOnly::bounds
  std::span<const DeepShape> deep = {};    // in place of `ranks`, with MetadataOnly::deep

  int count() const {
    return static_cast<int>(codec == MetadataOnly::deep ? deep.size() : ranks.size());
  }
};

// A machine on which layers are cut and merged.
struct MachineModel {
  comm::Network network;
  LayerCosts costs;
};

// Counts and predicted times of a scheme.
struct Simulated {
  Counts compose, gather;
  double compose_seconds = 0, gather_seconds = 0;
};

// Runs the scheme and the gather to rank 0, ranks waiting for each other in between. Time and
// memory grow with the messages and the pixels covered, not with ranks times pixels.
//
// Throws std::invalid_argument for a scheme that does not exist and for no images.
// REQUIRES: masks were made in the order of the options.
Simulated simulate(std::string_view scheme, const MetadataOnlyImages& images,
                   const MachineModel& machine, const ComposeOptions& options = {});

}  // namespace delray::composite
