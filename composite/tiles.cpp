// A distributed framebuffer (OSPRay's: Usher, Wald, Amstutz et al. 2019): direct-send of tiles as
// soon as they are drawn.
//
// A rank has several tiles, fewer where they would be small. It sends a tile's number, then its
// pixels, and takes whatever has come in between. A tile's images are merged from its owner's rank
// outwards whatever the order in which they come, so that the result is always the same; those that
// come early wait. One round, A (1 - 1/n) pixels for a rank to send and to composite.
//
// Degenerate: a tile without pixels is neither sent nor waited for; one in which a rank has nothing
// is a number alone.
#include "composite/tiles.h"

#include <algorithm>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite {
namespace {

// Enough to even out what is drawn where, and for merging to begin early.
constexpr std::uint64_t kTilesOfRank = 16;
// Below it a message costs more than its pixels.
constexpr std::uint64_t kFewestPixelsOfTile = 4096;

int tiles_for(std::uint64_t pixels, int ranks) {
  const auto n = static_cast<std::uint64_t>(ranks);
  return ranks * static_cast<int>(
                     std::clamp<std::uint64_t>(pixels / n / kFewestPixelsOfTile, 1, kTilesOfRank));
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
  std::size_t of_source = 0;
  for (int tile = communicator.rank(); tile < tiles_; tile += communicator.size()) {
    if (range(tile).size() > 0) ++of_source;
  }
  numbers_to_come_.assign(static_cast<std::size_t>(communicator.size()), of_source);
  numbers_to_come_[static_cast<std::size_t>(communicator.rank())] = 0;
  missing_ = of_source * order_.size();
}

PixelRange TileCompositor::range(int tile) const {
  return internal::piece_of({0, layer_->pixels()}, tile, tiles_, samples_per_pixel_);
}

void TileCompositor::merge_what_came(int tile) {
  Own& mine = own(tile);
  if (!mine.drawn) return;
  for (; mine.merged < order_.size(); ++mine.merged) {
    const auto next = mine.not_yet.find(order_[mine.merged]);
    if (next == mine.not_yet.end()) return;
    const Side side = next->first < communicator_.rank() ? Side::lower : Side::higher;
    if (next->second) {
      communicator_.work(comm::Work::pixels_composited,
                         layer_->merge(range(tile), *next->second, side));
    }
    mine.not_yet.erase(next);
  }
}

void TileCompositor::add(int tile, int from, std::optional<comm::Buffer>&& pixels) {
  own(tile).not_yet.emplace(from, std::move(pixels));
  --missing_;
  merge_what_came(tile);
}

// Who is done may make the next compositor before others are, and speak to them: such numbers have
// to wait, behind all that the source has sent for this one.
std::optional<int> TileCompositor::sender_of_next_number(comm::Deadline deadline) {
  const auto any = communicator_.probe(comm::kAnyRank, internal::kTagTile, deadline);
  if (!any) return std::nullopt;
  const auto is_to_come = [&](int rank) {
    return numbers_to_come_[static_cast<std::size_t>(rank)] > 0;
  };
  if (is_to_come(any->source)) return any->source;
  for (const int rank : order_) {
    if (is_to_come(rank) && communicator_.probe(rank, internal::kTagTile, comm::Deadline::now()))
      return rank;
  }
  const auto first = std::find_if(order_.begin(), order_.end(), is_to_come);
  if (first == order_.end() || !communicator_.probe(*first, internal::kTagTile, deadline))
    return std::nullopt;
  return *first;
}

// The number of a tile goes before its pixels; the complement of the number if there are none.
void TileCompositor::take_number(int from) {
  --numbers_to_come_[static_cast<std::size_t>(from)];
  const int number = communicator_.receive(from, internal::kTagTile).as<int>()[0];
  if (number < 0) {
    add(~number, from, std::nullopt);
  } else {
    announced_[from].push_back(number);
  }
}

void TileCompositor::take_pixels(Announced::iterator from) {
  const int source = from->first, tile = from->second.front();
  from->second.pop_front();
  if (from->second.empty()) announced_.erase(from);
  add(tile, source, communicator_.receive(source, internal::kTagTilePixels));
}

// Large messages may be on their way for as long as their sender is drawing: they are not waited
// for.
void TileCompositor::take_what_came() {
  const auto now = comm::Deadline::now();
  while (missing_ > 0) {
    const std::optional<int> next = sender_of_next_number(now);
    if (!next) break;
    take_number(*next);
  }
  for (auto from = announced_.begin(); from != announced_.end();) {
    const auto here = from++;
    for (auto left = here->second.size(); left > 0; --left) {
      if (!communicator_.probe(here->first, internal::kTagTilePixels, now)) break;
      take_pixels(here);
    }
  }
}

void TileCompositor::drawn(int tile) { hand_over(tile, true); }
void TileCompositor::nothing_in(int tile) { hand_over(tile, false); }

void TileCompositor::hand_over(int tile, bool has_pixels) {
  const PixelRange pixels = range(tile);
  if (pixels.size() == 0) return;
  communicator_.mark(comm::Phase::compose, 0);
  if (const int to = owner(tile); to != communicator_.rank()) {
    const int number = has_pixels ? tile : ~tile;
    communicator_.send(to, internal::kTagTile, comm::Buffer::of_value(number));
    if (has_pixels) communicator_.send(to, internal::kTagTilePixels, layer_->encode(pixels));
  } else {
    own(tile).drawn = true;
    merge_what_came(tile);
  }
  take_what_came();
}

OwnedPixels TileCompositor::finish() {
  communicator_.mark(comm::Phase::compose, 0);
  for (take_what_came(); missing_ > 0; take_what_came()) {
    if (announced_.empty()) {
      take_number(*sender_of_next_number(comm::Deadline::never()));
    } else {
      take_pixels(announced_.begin());
    }
  }
  OwnedPixels part;
  for (int tile = communicator_.rank(); tile < tiles_; tile += communicator_.size()) {
    if (range(tile).size() > 0) part.ranges.push_back(range(tile));
  }
  part.layer = std::move(layer_);
  return part;
}

namespace internal {

OwnedPixels tiles(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
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
