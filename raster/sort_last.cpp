// Sort-last: every rank draws an equal, ascending part of the primitives over the whole frame, and
// a compositing scheme merges the images. On equal depths the lower rank wins, which has the lower
// primitive numbers.
#include <atomic>

#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/dense.h"
#include "composite/scheme.h"
#include "parallel/parallel_for.h"
#include "raster/internal/processor_seconds.h"
#include "raster/internal/rank.h"
#include "raster/internal/samples.h"

namespace delray::raster {
namespace {

composite::Part compose(Rank& rank, std::unique_ptr<composite::Layer> layer) {
  return timed(rank.communicator, rank.counts.phases.compose, [&] {
    return composite::compose(rank.communicator, std::move(layer), rank.options.scheme,
                              {.samples_per_pixel = rank.samples_per_pixel()});
  });
}

// All surfaces seen at the samples, those of a pixel together. Of each payload_of(tile, number, x,
// y) is kept unless it is nothing.
template <class Payload, class F>
composite::DeepImage<Payload> render_deep(Rank& rank, const DrawList& list, F&& payload_of) {
  using composite::is_opaque;
  const int n = rank.options.supersampling;
  std::vector<composite::DeepTile<Payload>> tiles(static_cast<std::size_t>(rank.screen.tiles()));
  const auto index_of = [&](int x, int y) {
    const auto pixel =
        static_cast<std::uint64_t>(y / n) * static_cast<std::uint64_t>(rank.options.width) +
        static_cast<std::uint64_t>(x / n);
    return pixel * static_cast<std::uint64_t>(n * n) +
           static_cast<std::uint64_t>(y % n * n + x % n);
  };
  const geometry::Rect frame = rank.frame();
  rank.render(list, {&frame, 1}, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    const geometry::Rect& rect = rects.front();
    composite::DeepTile<Payload>& deep =
        tiles[rect.y0 / kTileSize * rank.screen.tiles_x + rect.x0 / kTileSize];
    tile.for_each_pixel(rect, [&](int x, int y, std::span<const std::int64_t> keys) {
      const std::size_t before = deep.fragments.size();
      for (const std::int64_t key : keys) {
        const std::optional<Payload> payload = payload_of(tile, number_of(key), x, y);
        if (!payload) continue;
        const std::uint64_t primitive = list.primitive_of(number_of(key));
        deep.fragments.push_back({*payload, depth_of(key), static_cast<std::uint32_t>(primitive),
                                  static_cast<std::uint32_t>(primitive >> 32)});
        if (is_opaque(*payload)) break;
      }
      if (deep.fragments.size() > before)
        deep.pixels.push_back(
            {index_of(x, y), static_cast<std::uint32_t>(deep.fragments.size() - before)});
    });
  });
  return {rank.options.width * n * n, rank.options.height, std::move(tiles)};
}

// The pixels that this rank owns in the end, blended. colour_of gives a payload's colour.
template <class Colour, class Payload, class F>
composite::Part flatten(Rank& rank, composite::Part&& part, F&& colour_of) {
  constexpr std::size_t kGrain = 1 << 12;  // samples
  composite::Part result;
  result.ranges = part.ranges;
  const composite::DeepImage<Payload> deep = composite::take_deep<Payload>(std::move(part));
  image::BasicImage<Colour> image(deep.width, deep.height);
  const auto flatten_pixel = [&](std::size_t i, std::vector<composite::Fragment>& fragments) {
    fragments.clear();
    for (const auto& fragment : deep.at(i)) {
      const image::RgbaF colour = colour_of(fragment.payload);
      if (colour.a > 0) fragments.push_back({colour, fragment.depth, 0, 0});
    }
    image.colour[i] = {};
    image.depth[i] = fragments.empty() ? image::kEmptyDepth : fragments.front().depth;
    if (!fragments.empty()) composite::store(composite::blend(fragments), image.colour[i]);
  };
  ProcessorSeconds seconds;
  for (const composite::PixelRange& range : result.ranges)
    parallel::parallel_blocks(range.begin, range.end, kGrain,
                              [&](std::size_t begin, std::size_t end) {
                                std::vector<composite::Fragment> fragments;
                                seconds.measure([&] {
                                  for (std::size_t i = begin; i < end; ++i)
                                    flatten_pixel(i, fragments);
                                });
                              });
  rank.counts.phases.shade += seconds.seconds();
  result.layer = composite::make_dense(std::move(image));
  return result;
}

template <class Colour>
composite::Part compose_colours(Rank& rank, const DrawList& list) {
  const composite::Codec* const codec = composite::find_codec(rank.options.codec);
  return compose(rank, codec->make(rank.render_samples<Colour>(list)));
}

// Transparent surfaces have to be blended in one order over all ranks.
template <class Colour>
composite::Part compose_surfaces(Rank& rank, const DrawList& list) {
  const auto colour_of = [](TileView& tile, std::uint32_t number, int x, int y) {
    const image::RgbaF colour = tile.colour(number, x, y);
    return colour.a > 0 ? std::optional(colour) : std::nullopt;
  };
  return flatten<Colour, image::RgbaF>(
      rank, compose(rank, composite::make_deep(render_deep<image::RgbaF>(rank, list, colour_of))),
      [](const image::RgbaF& colour) { return colour; });
}

template <class Colour>
composite::Part compose_then_shade(Rank& rank, const DrawList& list) {
  const auto point_of = [](TileView& tile, std::uint32_t number, int x, int y) {
    return std::optional(point_seen(tile.frame(), tile.seen(), number, x, y));
  };
  composite::Part part =
      compose(rank, composite::make_deep(render_deep<SeenPoint>(rank, list, point_of)));
  const DrawList nothing;
  const FrameShading frame =
      make_frame_shading(rank.screen, rank.shader, nothing, rank.options.lighting, false);
  std::atomic<std::uint64_t> shaded{0};
  part = flatten<Colour, SeenPoint>(rank, std::move(part), [&](const SeenPoint& point) {
    shaded.fetch_add(1, std::memory_order_relaxed);
    return shade(frame, point);
  });
  rank.counts.shaded += shaded;
  return part;
}

template <class Colour>
Picture render(Rank& rank) {
  const auto [begin, end] = rank.own_primitives();
  const DrawList list =
      make_draw_list(pieces_of(rank.scene, rank.first_primitives, begin, end), &rank.clusters);
  if (rank.ranks() == 1) {
    auto image = rank.take_image<Colour>(rank.options.width, rank.options.height);
    const geometry::Rect frame = rank.frame();
    rank.render_pixels(list, {&frame, 1}, image);
    return image;
  }
  const auto compose = rank.options.shade == Shade::composited ? compose_then_shade<Colour>
                       : rank.transparent                      ? compose_surfaces<Colour>
                                                               : compose_colours<Colour>;
  composite::Part part = resolve<Colour>(compose(rank, list), rank.options.supersampling,
                                         rank.options.width, rank.options.height);
  part = timed(rank.communicator, rank.counts.phases.gather,
               [&] { return composite::gather(rank.communicator, std::move(part), 0); });
  if (rank.number() != 0) return image::BasicImage<Colour>();
  return composite::take_image<Colour>(std::move(part));
}

}  // namespace

Picture sort_last(Rank& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
