// Layers without pixels: schemes run on them as on any other, and what they send and composite is
// what real layers would, to the last byte, in a small part of the time and memory.
//
// Their messages stand for those of real layers (comm::Buffer::standing_for): they go between ranks
// of one process only, in practice those of the simulated machine.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "comm/communicator.h"
#include "composite/deep_shape.h"
#include "composite/layer.h"
#include "composite/layer_costs.h"
#include "composite/mask.h"

namespace delray::composite {

// Bytes of a pixel that travels: its colour and its depth; with Operator::over its colour alone.
inline constexpr std::size_t kPixelBytes8 = 8, kPixelBytesF = 20;
inline constexpr std::size_t kColourBytes8 = 4, kColourBytesF = 16;

// The codecs, and "deep" layers, whose messages metadata-only layers know the size of. That of
// "lz4" depends on the values of pixels: only real layers can tell.
enum class MetadataOnly : std::uint8_t { dense, bounds, active, deep };
// Nothing for other codecs.
std::optional<MetadataOnly> metadata_only_of(std::string_view codec);

// Charges what a layer does to a rank as work, so that it takes time on the simulated machine.
// Pixels composited are not charged: schemes tell of them themselves.
struct LayerClock {
  comm::Communicator* communicator = nullptr;  // null: nothing takes time
  LayerCosts costs;
};

// Stands for a layer of codec "dense": nothing but its size is known.
std::unique_ptr<Layer> make_metadata_only_dense(std::uint64_t pixels, std::size_t pixel_bytes,
                                                bool empty, const LayerClock& clock = {});

// Stands for a layer of codec "active": the pixels that it covers are known, and those of them that
// are left when all lower ranks have had it pruned.
std::unique_ptr<Layer> make_metadata_only_active(ImageMasks&& image, std::size_t pixel_bytes,
                                                 const LayerClock& clock = {});

// A metadata-only layer for codec "bounds". REQUIRES: width, the image's, is >= 1 where it has
// pixels.
std::unique_ptr<Layer> make_metadata_only_bounds(ImageMasks&& image, std::uint64_t width,
                                                 std::size_t pixel_bytes,
                                                 const LayerClock& clock = {});

// Stands for a deep layer: where its surfaces lie is known, and which of them are opaque.
std::unique_ptr<Layer> make_metadata_only_deep(DeepShape image,
                                               std::size_t fragment_bytes = sizeof(Fragment),
                                               const LayerClock& clock = {});

}  // namespace delray::composite
