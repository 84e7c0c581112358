// One composition for all tiles: their pixels, tile after tile, are one image to the scheme
// (composite::JoinedLayer), so that ranks with much to do in one tile share the work in others.
//
// Where the nearest shows, what is empty has the colour of the background from the moment that it
// is in an image of ours, and does not travel. Where layers are blended, who owns their pixels
// blends them over the background, and they travel to the rank that shows them as the difference
// (exclusive or) to it: pixels of the background are {} then, and do not travel.
#include "icet/compose_frame.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/forwarding.h"
#include "composite/borrowed.h"
#include "composite/image_layer.h"
#include "composite/joined.h"
#include "composite/scheme.h"
#include "icet/pixels.h"
#include "icet/strategies.h"

namespace delray::icet {
namespace {

using composite::Operator;
using composite::OwnedPixels;
using composite::PixelRange;

// Adds the time that passes while it lives.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), begin_(icetWallTime()) {}
  ~Stopwatch() { sum_ += icetWallTime() - begin_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  double begin_;
};

// Counts what a frame sends.
class CountingCommunicator final : public comm::ForwardingCommunicator {
 public:
  CountingCommunicator(comm::Communicator& inner, std::uint64_t& bytes)
      : comm::ForwardingCommunicator(inner), bytes_(bytes) {}
  void send(int to, comm::Tag tag, comm::Buffer&& message) override {
    bytes_ += message.size();
    inner().send(to, tag, std::move(message));
  }

 private:
  std::uint64_t& bytes_;
};

// Measures how long pixels are encoded and merged.
class TimedLayer final : public composite::Layer {
 public:
  TimedLayer(std::unique_ptr<composite::JoinedLayer> tiles, Timings& timings)
      : tiles_(std::move(tiles)), timings_(timings) {}
  composite::JoinedLayer& tiles() { return *tiles_; }

  std::uint64_t pixels() const override { return tiles_->pixels(); }
  int format() const override { return tiles_->format(); }
  bool empty() const override { return tiles_->empty(); }
  comm::Buffer encode(PixelRange range) override {
    const Stopwatch watch(timings_.compress);
    return tiles_->encode(range);
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, composite::Side from) override {
    const Stopwatch watch(timings_.compare);
    return tiles_->merge(range, pixels, from);
  }
  void replace(PixelRange range, const comm::Buffer& pixels) override {
    tiles_->replace(range, pixels);
  }
  std::uint64_t prune(PixelRange range, const comm::Buffer& pixels) override {
    const Stopwatch watch(timings_.compare);
    return tiles_->prune(range, pixels);
  }

 private:
  std::unique_ptr<composite::JoinedLayer> tiles_;
  Timings& timings_;
};

template <class Colour>
class FrameComposition {
 public:
  FrameComposition(Context& context, const TilePixels<Colour>& tiles)
      : context_(context),
        settings_(context.settings),
        ranks_(*context.ranks, context.frame.timings.bytes_sent),
        how_(settings_.blends() ? Operator::over : Operator::nearest),
        keeps_depth_(settings_.has_depth() && !settings_.blends() &&
                     !(settings_.has_colour() && settings_.is_enabled(ICET_COMPOSITE_ONE_BUFFER))),
        strategy_(*find_strategy(strategies(), settings_.strategy)),
        background_(!settings_.blends() || context.frame.corrects_background ||
                            strategy_.always_corrects
                        ? as(context.frame.true_background, Colour{})
                        : Colour{}) {
    std::vector<composite::JoinedLayer::Part> parts;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const auto pixels = static_cast<std::uint64_t>(settings_.tiles[i].place.area());
      parts.push_back({pixels, tiles[i] ? make_layer(i, *tiles[i]) : nullptr});
    }
    auto joined = std::make_unique<composite::JoinedLayer>(
        std::move(parts), static_cast<int>(how_),
        [this](std::size_t tile) { return make_empty(tile); });
    part_.layer = std::make_unique<TimedLayer>(std::move(joined), context.frame.timings);
  }

  void compose() {
    const char* const scheme =
        strategy_.scheme != nullptr
            ? strategy_.scheme
            : find_strategy(single_image_strategies(), settings_.single_image)->scheme;
    composite::ComposeOptions options;
    options.interlace = interlaces();
    if (settings_.is_enabled(ICET_ORDERED_COMPOSITE)) {
      options.order = context_.order;
    } else if (!settings_.blends()) {
      // Of equal depths the last rank's shows, as mostly with IceT.
      options.order.resize(static_cast<std::size_t>(ranks_.size()));
      std::iota(options.order.rbegin(), options.order.rend(), 0);
    }
    part_ = composite::compose(ranks_, std::move(part_.layer), scheme, options);
  }

  void finish() {
    const Stopwatch watch(context_.frame.timings.collect);
    const bool collects = settings_.tiles.size() != 1 || settings_.is_enabled(ICET_COLLECT_IMAGES);
    if (collects) {
      collect();
    } else if (!part_.ranges.empty()) {
      const PixelRange range{part_.ranges.front().begin, part_.ranges.back().end};
      if (settings_.blends()) put_background(tiles().existing(0), range);
      show(0, range);
    }
    give_back_images();
  }

 private:
  composite::JoinedLayer& tiles() { return dynamic_cast<TimedLayer&>(*part_.layer).tiles(); }
  static image::BasicImage<Colour>& image_of(composite::Layer& tile) {
    return dynamic_cast<composite::ImageLayer<Colour>&>(tile).image();
  }

  // Pixels of one tile that is kept where they were merged have to be neighbours. The feature, on
  // by default, allows interlacing; of four and eight ranks it took up to 1.6 times as long.
  bool interlaces() const {
    constexpr int kFewestRanks = 16;
    return settings_.is_enabled(ICET_INTERLACE_IMAGES) &&
           settings_.is_enabled(ICET_COLLECT_IMAGES) && ranks_.size() >= kFewestRanks;
  }

  image::BasicImage<Colour> new_image(std::size_t tile) {
    const geometry::Rect& place = settings_.tiles[tile].place;
    return context_.pool.take(place.width(), place.height(), Colour{});
  }

  std::unique_ptr<composite::Layer> make_layer(std::size_t tile,
                                               composite::BorrowedPixels<Colour> pixels) {
    if (!settings_.blends()) pixels.background = background_;
    return composite::make_borrowed(new_image(tile), pixels, how_);
  }

  std::unique_ptr<composite::Layer> make_empty(std::size_t tile) {
    std::unique_ptr<composite::Layer> layer = make_layer(tile, {});
    if (collects_colours_) forget_depth(*layer);
    return layer;
  }
  static void forget_depth(composite::Layer& tile) {
    dynamic_cast<composite::ImageLayer<Colour>&>(tile).forget_depth();
  }

  // Calls f(layer, pixels) for the pixels that this rank has composited, where there is a tile.
  template <class F>
  void for_each_tile(F&& f) {
    for (const PixelRange& range : part_.ranges) {
      tiles().for_each_piece(range, [&](std::size_t tile, PixelRange pixels) {
        if (composite::Layer* const layer = tiles().layer(tile)) f(*layer, pixels);
      });
    }
  }

  // Of pixels that were blended.
  void put_background(composite::Layer& tile, PixelRange pixels) {
    composite::settle(tile, pixels);
    blend_over(image_of(tile), pixels, background_);
  }

  // Sends what this rank has composited to who shows it.
  void collect() {
    if (settings_.blends()) {
      for_each_tile([&](composite::Layer& tile, PixelRange pixels) {
        put_background(tile, pixels);
        exclusive_or(image_of(tile), pixels, background_);
      });
    }
    if (!keeps_depth_) {
      collects_colours_ = true;
      for (std::size_t i = 0; i < tiles().parts(); ++i)
        if (composite::Layer* const layer = tiles().layer(i)) forget_depth(*layer);
    }
    std::vector<composite::Destination> destinations;
    for (std::size_t i = 0; i < settings_.tiles.size(); ++i) {
      destinations.push_back({tiles().range_of(i), settings_.tiles[i].display});
    }
    const int shown = tile_of(settings_, ranks_.rank());
    if (shown >= 0 && settings_.tiles.size() == 1)  // while others send theirs
      for_each_tile(composite::settle);
    part_ = composite::gather(ranks_, std::move(part_), destinations);
    if (shown < 0) return;
    const auto tile = static_cast<std::size_t>(shown);
    const PixelRange all{0, tiles().range_of(tile).size()};
    if (settings_.blends()) {
      composite::Layer& layer = tiles().existing(tile);
      composite::settle(layer, all);
      exclusive_or(image_of(layer), all, background_);
    }
    show(tile, all);
  }

  // Pixels that are final.
  void show(std::size_t tile, PixelRange valid) {
    Frame& frame = context_.frame;
    frame.valid_tile = static_cast<int>(tile);
    frame.valid_offset = static_cast<int>(valid.begin);
    frame.valid_pixels = static_cast<int>(valid.size());
    Image& result = context_.result;
    composite::Layer& layer = tiles().existing(tile);
    composite::settle(layer, valid);
    image::BasicImage<Colour>& image = image_of(layer);
    if (keeps_depth_) set_empty_depths(image.depth.span().subspan(valid.begin, valid.size()));
    result.width = image.width;
    result.height = image.height;
    result.colour_format = settings_.colour_format;
    // Depths of blended images mean nothing, but are there where they are asked for.
    const bool has_depth = keeps_depth_ || (settings_.has_depth() && settings_.blends());
    result.depth_format = has_depth ? ICET_IMAGE_DEPTH_FLOAT : ICET_IMAGE_DEPTH_NONE;
    if (!keeps_depth_ && has_depth) std::fill_n(image.depth.data(), image.pixels(), 1.0F);
    result.planes(Colour{}) = std::move(image);
    tiles().take_layer(tile);
    if constexpr (std::is_same_v<Colour, image::RgbaF>) {
      if (!result.is_rgb()) return;
      if (result.rgb.size() != 3 * result.pixels()) {
        result.rgb = image::Plane<float>(3 * result.pixels());
      }
      drop_alpha(result.floats.colour.data(), result.pixels(), result.rgb.data());
    }
  }

  void give_back_images() {
    for (std::size_t i = 0; i < tiles().parts(); ++i) {
      if (tiles().layer(i) != nullptr)
        context_.pool.give_back(std::move(image_of(*tiles().layer(i))));
    }
  }

  Context& context_;
  const Settings& settings_;
  CountingCommunicator ranks_;
  const Operator how_;
  const bool keeps_depth_;         // the program gets depths
  bool collects_colours_ = false;  // and nothing else from now on
  const Strategy& strategy_;
  const Colour background_;  // behind all
  OwnedPixels part_;
};

}  // namespace

template <class Colour>
void compose_frame(Context& context, const TilePixels<Colour>& tiles) {
  std::optional<FrameComposition<Colour>> composition;
  try {
    composition.emplace(context, tiles);
  } catch (...) {  // no memory
    fail_frame(context);
    throw;
  }
  try {
    composition->compose();
    composition->finish();
  } catch (const comm::AgreedFailure&) {
    context.ranks->finish_sends();
    throw;
  }
  context.ranks->finish_sends();
}

template void compose_frame(Context&, const TilePixels<image::Rgba8>&);
template void compose_frame(Context&, const TilePixels<image::RgbaF>&);

void fail_frame(Context& context) {
  try {
    composite::compose(*context.ranks, nullptr, {});
  } catch (const comm::AgreedFailure&) {  // as on the others
  }
  context.ranks->finish_sends();
}

}  // namespace delray::icet
