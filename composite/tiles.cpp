#include "composite/tiles.h"

#include <algorithm>

#include "composite/internal/exchange.h"
#include "composite/internal/schemes.h"

namespace delray::composite {
namespace {

// Enough to even out what is drawn where, and for merging to begin early.
constexpr std::uint64_t kTilesOfRank = 16;
// Below it a message costs more than its pixels.
constexpr std::uint64_t kFewestPixels = 4096;

int tiles_for(std::uint64_t pixels, int ranks) {
  const auto n = static_cast<std::uint64_t>(ranks);
  return ranks *
         static_cast<int>(std::clamp<std::uint64_t>(pixels / n / kFewestPixels, 1, kTilesOfRank));
}

}  // namespace

TileCompositor::TileCompositor(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                               const ComposeOptions& options)
    : communicator_(communicator),
      layer_(std::move(layer)),
      samples_per_pixel_(options.samples_per_pixel),
      tiles_(tiles_for(layer_->pixels(), communicator.size())),
      own_(static_cast<std::size_t>(tiles_ / communicator.size())) {
  internal::for_each_outwards(communicator.rank(), communicator.size(),
                              [&](int rank) { order_.push_back(rank); });
  for (int tile = communicator.rank(); tile < tiles_; tile += communicator.size()) {
    if (range(tile).size() > 0) missing_ += order_.size();
  }
}

PixelRange TileCompositor::range(int tile) const {
  return internal::piece_of({0, layer_->pixels()}, tile, tiles_, samples_per_pixel_);
}

void TileCompositor::merge_what_came(int tile) {
  Own& own = own_[static_cast<std::size_t>(tile / communicator_.size())];
  if (!own.drawn) return;
  for (; own.merged < order_.size(); ++own.merged) {
    const auto next = own.not_yet.find(order_[own.merged]);
    if (next == own.not_yet.end()) return;
    const Side side = next->first < communicator_.rank() ? Side::lower : Side::higher;
    communicator_.work(comm::Work::pixels_composited,
                       layer_->merge(range(tile), next->second, side));
    own.not_yet.erase(next);
  }
}

// The number of a tile goes before its pixels.
void TileCompositor::take_one(int from) {
  const int tile = communicator_.receive(from, internal::kTagTile).as<int>()[0];
  own_[static_cast<std::size_t>(tile / communicator_.size())].not_yet.emplace(
      from, communicator_.receive(from, internal::kTagTilePixels));
  --missing_;
  merge_what_came(tile);
}

void TileCompositor::drawn(int tile) {
  const PixelRange pixels = range(tile);
  if (pixels.size() == 0) return;
  communicator_.mark(comm::Phase::compose, 0);
  if (const int to = owner(tile); to != communicator_.rank()) {
    communicator_.send(to, internal::kTagTile, comm::Buffer::of_value(tile));
    communicator_.send(to, internal::kTagTilePixels, layer_->cut(pixels));
  } else {
    own_[static_cast<std::size_t>(tile / communicator_.size())].drawn = true;
    merge_what_came(tile);
  }
  while (missing_ > 0) {
    const auto next =
        communicator_.probe(comm::kAnyRank, internal::kTagTile, comm::Deadline::now());
    if (!next) return;
    take_one(next->source);
  }
}

Part TileCompositor::finish() {
  communicator_.mark(comm::Phase::compose, 0);
  while (missing_ > 0) {
    const auto next =
        communicator_.probe(comm::kAnyRank, internal::kTagTile, comm::Deadline::never());
    take_one(next->source);
  }
  Part part;
  for (int tile = communicator_.rank(); tile < tiles_; tile += communicator_.size()) {
    if (range(tile).size() > 0) part.ranges.push_back(range(tile));
  }
  part.layer = std::move(layer_);
  return part;
}

namespace internal {

Part tiles(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
           const ComposeOptions& options) {
  TileCompositor compositor(communicator, std::move(layer), options);
  // Each rank begins elsewhere, so that not all of them send to one.
  for (int i = 1; i <= compositor.tiles(); ++i) {
    compositor.drawn((communicator.rank() + i) % compositor.tiles());
  }
  return compositor.finish();
}

}  // namespace internal
}  // namespace delray::composite
