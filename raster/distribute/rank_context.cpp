// The code that strategies share on a rank: its equal part of the primitives, drawings of regions
// with their counts, tiles stored into an image, and the gather of regions on rank 0.
//
// Ranks remember which tiles they left clear in a picture's memory, and do not clear them again.
// Degenerate: with fewer primitives than ranks some have none.
#include "raster/distribute/rank_context.h"

#include <algorithm>
#include <cassert>

#include "comm/collectives.h"
#include "raster/distribute/gather_regions.h"
#include "raster/distribute/primitive_shares.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {

PreparedScene::PreparedScene(const scenes::Scene& source,
                             std::shared_ptr<const shading::Shader> given)
    : scene(source),
      shader_of_scene(given != nullptr
                          ? std::move(given)
                          : std::make_shared<const shading::Shader>(shading::make_shader(scene))),
      first_primitives(scenes::first_primitives(scene)),
      primitives(first_primitives.back()),
      transparent(std::any_of(
          scene.meshes.begin(), scene.meshes.end(),
          [&](const scenes::Mesh& mesh) { return is_blended(*shader_of_scene, mesh); })),
      clusters(scene.meshes) {}

PreparedScene::PreparedScene(comm::Communicator& communicator, const scenes::ScenePart& part,
                             std::shared_ptr<const shading::Shader> given)
    : PreparedScene(part.scene, std::move(given)) {
  for (std::uint64_t& first : first_primitives) first += part.first_triangle;
  primitives = part.triangles;
  is_part = true;
  transparent = comm::all_reduce_value(communicator, std::uint8_t{transparent},
                                       [](auto a, auto b) { return std::max(a, b); }) != 0;
}

std::pair<std::uint64_t, std::uint64_t> RankContext::own_primitives(int holders) const {
  if (prepared.is_part) {
    assert(holders == ranks());
    return {prepared.first_primitives.front(), prepared.first_primitives.back()};
  }
  const std::uint64_t all = prepared.primitives;
  const int k = number();
  if (k >= holders) return {all, all};
  return {begin_of_equal_share(all, holders, k), begin_of_equal_share(all, holders, k + 1)};
}

RegionDrawing RankContext::begin(const DrawList& list, std::span<const geometry::Rect> regions) {
  std::vector<geometry::Rect> in_samples;
  for (const geometry::Rect& r : regions)
    in_samples.push_back(samples_of(r, options.supersampling));
  return RegionDrawing(
      {screen, list, prepared.shader(), options, in_samples, depths_are_distances(), progress},
      scratch);
}

void RankContext::report_work(const RegionCounts& done) const {
  communicator.work(comm::Work::primitives, done.triangles.in);
  communicator.work(comm::Work::fragments, done.fragments);
}

void RankContext::count(const RegionCounts& done) {
  if (!in_steps) report_work(done);
  counts += done;
}

void RankContext::end(RegionDrawing& drawing, FinishTile finish_tile) {
  count(drawing.finish(finish_tile));
}

void RankContext::end_rows(RegionDrawing& drawing, int first, int rows, FinishTile finish_tile,
                           parallel::FunctionRef<void(int, int)> rows_finished) {
  drawing.finish_rows(first, rows, finish_tile, [&](int begin, int end, const RegionCounts& done) {
    count(done);
    rows_finished(begin, end);
  });
}

void RankContext::render(const DrawList& list, std::span<const geometry::Rect> regions,
                         FinishTile finish_tile) {
  communicator.mark(comm::Phase::rasterize, 0);
  RegionDrawing drawing = begin(list, regions);
  drawing.draw_all();
  end(drawing, finish_tile);
}

template <class Colour>
void store_pixels(std::span<const geometry::Rect> rects, TileView& tile, int n,
                  const Window<Colour>& window) {
  for (const geometry::Rect& rect : rects) tile.shade_pixels(rect, n, window);
}

template <class Colour>
void store_samples(std::span<const geometry::Rect> rects, TileView& tile, int n,
                   image::BasicImage<Colour>& image) {
  for (const geometry::Rect& rect : rects) {
    if (n == 1) {
      tile.shade(rect, window_of(image));
      continue;
    }
    const Window<Colour> samples = tile_window<Colour>(rect);
    tile.shade(rect, samples);
    gather_samples(samples, n, pixels_of(rect, n), image);
  }
}

template <class Colour>
void RankContext::end_pixels(RegionDrawing& drawing, image::BasicImage<Colour>& image) {
  const Window<Colour> window = window_of(image);
  // Tiles that were left clear in the same memory before need not be cleared again.
  std::vector<std::uint8_t>&clear = scratch.clear_tiles, &empty = scratch.empty_tiles;
  const auto tiles = static_cast<std::size_t>(screen.tiles());
  if (scratch.taken != image.colour.data() || clear.size() != tiles) clear.assign(tiles, 0);
  empty.assign(tiles, 1);
  scratch.taken = nullptr;
  end(drawing, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    const geometry::Rect& first = rects.front();
    const int number = first.y0 / kTileSize * screen.tiles_x + first.x0 / kTileSize;
    const auto index = static_cast<std::size_t>(number);
    empty[index] = static_cast<std::uint8_t>(tile.empty());
    if (tile.empty() && clear[index] != 0) return;
    clear[index] = static_cast<std::uint8_t>(tile.empty() && first == screen.tile(number));
    store_pixels(rects, tile, options.supersampling, window);
  });
  scratch.clear_in = image.colour.data();
}

template <class Colour>
void RankContext::render_pixels(const DrawList& list, std::span<const geometry::Rect> regions,
                                image::BasicImage<Colour>& image) {
  communicator.mark(comm::Phase::rasterize, 0);
  RegionDrawing drawing = begin(list, regions);
  drawing.draw_all();
  end_pixels(drawing, image);
}

template <class Colour>
image::BasicImage<Colour> RankContext::end_samples(RegionDrawing& drawing) {
  const int n = options.supersampling;
  if (n == 1) {
    ImageOfTiles<Colour> tiles(*this);
    end(drawing,
        [&](std::span<const geometry::Rect> rects, TileView& tile) { tiles.store(rects, tile); });
    return tiles.take();
  }
  image::BasicImage<Colour> image =
      take_image<Colour>(options.width * samples_per_pixel(), options.height);
  scratch.shown = {};
  end(drawing, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    store_samples(rects, tile, n, image);
  });
  return image;
}

template <class Colour>
image::BasicImage<Colour> RankContext::end_part(RegionDrawing& drawing,
                                                const geometry::Rect& part) {
  auto* const spare = std::get_if<image::BasicImage<Colour>>(&scratch.part);
  const bool fits =
      spare != nullptr && spare->width == part.width() && spare->height == part.height();
  image::BasicImage<Colour> image =
      fits ? std::exchange(*spare, {}) : image::BasicImage<Colour>(part.width(), part.height());
  const Window<Colour> window{image.colour.data(), image.depth.data(), part.x0, part.y0,
                              part.width()};
  end(drawing, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    for (const geometry::Rect& rect : rects) {
      assert(tile.empty() || geometry::intersection(rect, part) == rect);
      if (part.contains(rect.x0, rect.y0)) tile.shade(rect, window);
    }
  });
  return image;
}

template <class Colour>
image::BasicImage<Colour> RankContext::picture_around(const geometry::Rect& part,
                                                      image::BasicImage<Colour>&& image) {
  image::BasicImage<Colour> whole = take_image<Colour>(options.width, options.height);
  const Window<Colour> window = window_of(whole);
  std::vector<std::uint8_t>& clear = scratch.clear_tiles;
  const auto tiles = static_cast<std::size_t>(screen.tiles());
  if (scratch.taken != whole.colour.data() || clear.size() != tiles) clear.assign(tiles, 0);
  parallel::parallel_for(0, tiles, 1, [&](std::size_t index) {
    const geometry::Rect rect = screen.tile(static_cast<int>(index));
    const auto count = static_cast<std::size_t>(rect.width());
    const auto from = [&](int y) {
      return static_cast<std::size_t>(y - part.y0) * static_cast<std::size_t>(part.width()) +
             static_cast<std::size_t>(rect.x0 - part.x0);
    };
    const auto is_empty = [&](int y) {
      bool any = false;
      for (std::size_t i = 0; i < count; ++i)
        any |= image.depth.data()[from(y) + i] != image::kEmptyDepth;
      return !any;
    };
    bool shows = false;
    if (part.contains(rect.x0, rect.y0))
      for (int y = rect.y0; y < rect.y1 && !shows; ++y) shows = !is_empty(y);
    if (!shows) {
      if (clear[index] == 0) clear_pixels(rect, window);
      clear[index] = 1;
      return;
    }
    clear[index] = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
      std::copy_n(image.colour.data() + from(y), count,
                  whole.colour.data() + window.at(rect.x0, y));
      std::copy_n(image.depth.data() + from(y), count, whole.depth.data() + window.at(rect.x0, y));
    }
  });
  scratch.clear_in = whole.colour.data();
  scratch.part = std::move(image);
  return whole;
}

template <class Colour>
Picture RankContext::gather(const loadbalance::Partition& partition,
                            image::BasicImage<Colour>&& image) {
  communicator.mark(comm::Phase::gather, 0);
  const double before = communicator.seconds();
  if (options.displays.empty()) {
    ImageTiles tiles{kTileSize / options.supersampling, screen.tiles_x, {}, {}};
    // Unless somebody else wrote into the image.
    if (scratch.clear_in != nullptr && scratch.clear_in == image.colour.data())
      tiles.empty = scratch.empty_tiles, tiles.clear = scratch.clear_tiles;
    gather_regions(communicator, partition, tiles, image);
  } else {
    for (auto& display : deliver_regions(communicator, partition, image, options.displays))
      shown.emplace_back(std::move(display));
  }
  counts.phases.gather += communicator.seconds() - before;
  if (number() == 0 && options.displays.empty()) return std::move(image);
  if (image.width > 0) scratch.spare = std::move(image);  // for the next frame
  return image::BasicImage<Colour>();
}

template <class Colour>
image::BasicImage<Colour> RankContext::take_image(int width, int height) {
  const void* const shown_in = std::exchange(scratch.shown_in, nullptr);
  if (auto* const spare = std::get_if<image::BasicImage<Colour>>(&scratch.spare);
      spare != nullptr && spare->width == width && spare->height == height) {
    if (shown_in != spare->colour.data()) scratch.shown = {};
    return std::exchange(*spare, {});
  }
  scratch.taken = nullptr;
  scratch.shown = {};
  return image::BasicImage<Colour>(width, height);
}

template <class Colour>
ImageOfTiles<Colour>::ImageOfTiles(RankContext& rank)
    : rank_(rank),
      image_(rank.take_image<Colour>(rank.options.width, rank.options.height)),
      shown_(image_.pixels()) {}

template <class Colour>
void ImageOfTiles<Colour>::store(std::span<const geometry::Rect> rects, TileView& tile) {
  const Window<Colour> window = window_of(image_);
  const composite::ShownBlocks& before = rank_.scratch.shown;
  for (const geometry::Rect& rect : rects) {
    const bool is_empty = tile.empty();
    if (!is_empty) tile.shade(rect, window);
    const auto width = static_cast<std::size_t>(rect.width());
    for (int y = rect.y0; y < rect.y1 && width > 0; ++y) {
      const std::size_t at = window.at(rect.x0, y);
      if (!is_empty)
        shown_.add(at, width);
      else if (!before.is_known() || before.any(at, width))
        clear_pixels({rect.x0, y, rect.x1, y + 1}, window);
    }
  }
}

template <class Colour>
image::BasicImage<Colour> ImageOfTiles<Colour>::take() {
  rank_.scratch.shown = std::move(shown_);
  return std::move(image_);
}

template class ImageOfTiles<image::Rgba8>;
template class ImageOfTiles<image::RgbaF>;

template void RankContext::end_pixels(RegionDrawing&, image::Image8&);
template void RankContext::end_pixels(RegionDrawing&, image::ImageF&);
template void RankContext::render_pixels(const DrawList&, std::span<const geometry::Rect>,
                                         image::Image8&);
template void RankContext::render_pixels(const DrawList&, std::span<const geometry::Rect>,
                                         image::ImageF&);
template image::Image8 RankContext::end_samples(RegionDrawing&);
template image::ImageF RankContext::end_samples(RegionDrawing&);
template image::Image8 RankContext::end_part(RegionDrawing&, const geometry::Rect&);
template image::ImageF RankContext::end_part(RegionDrawing&, const geometry::Rect&);
template image::Image8 RankContext::picture_around(const geometry::Rect&, image::Image8&&);
template image::ImageF RankContext::picture_around(const geometry::Rect&, image::ImageF&&);
template Picture RankContext::gather(const loadbalance::Partition&, image::Image8&&);
template Picture RankContext::gather(const loadbalance::Partition&, image::ImageF&&);
template image::Image8 RankContext::take_image(int, int);
template image::ImageF RankContext::take_image(int, int);

template void store_pixels(std::span<const geometry::Rect>, TileView&, int,
                           const Window<image::Rgba8>&);
template void store_pixels(std::span<const geometry::Rect>, TileView&, int,
                           const Window<image::RgbaF>&);
template void store_samples(std::span<const geometry::Rect>, TileView&, int, image::Image8&);
template void store_samples(std::span<const geometry::Rect>, TileView&, int, image::ImageF&);

}  // namespace delray::raster
