// Sort-last: every rank draws an ascending part of the primitives over the whole frame, and a
// compositing scheme merges the images. On equal depths the lower rank wins, which has the lower
// primitive numbers. Parts are of equal size in the first frame and of about equal work after it.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "comm/agree_on_failure.h"
#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/dense.h"
#include "composite/flatten.h"
#include "composite/mask.h"
#include "composite/metadata_only.h"
#include "composite/scheme.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/distances.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/others_depths.h"
#include "raster/distribute/rank_context.h"
#include "raster/packed/packed_drawing.h"
#include "raster/pipeline/processor_seconds.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// All surfaces seen at the samples, those of a pixel together. for_each(tile, rect, add) calls
// add(x, y, key, payload) for those of a tile, pixel by pixel, front to back.
template <class Payload, class F>
composite::DeepImage<Payload> end_deep(RankContext& rank, const DrawList& list,
                                       RegionDrawing& drawing, F&& for_each) {
  const int n = rank.options.supersampling;
  std::vector<composite::DeepTile<Payload>> tiles(static_cast<std::size_t>(rank.screen.tiles()));
  const auto index_of = [&](int x, int y) {
    const auto pixel =
        static_cast<std::uint64_t>(y / n) * static_cast<std::uint64_t>(rank.options.width) +
        static_cast<std::uint64_t>(x / n);
    return pixel * static_cast<std::uint64_t>(n * n) +
           static_cast<std::uint64_t>(y % n * n + x % n);
  };
  rank.end(drawing, [&](std::span<const geometry::Rect> rects, TileView& tile) {
    const geometry::Rect& rect = rects.front();
    composite::DeepTile<Payload>& deep =
        tiles[rect.y0 / kTileSize * rank.screen.tiles_x + rect.x0 / kTileSize];
    for_each(tile, rect, [&](int x, int y, std::int64_t key, const Payload& payload) {
      const std::uint64_t primitive = list.primitive_of(number_of(key));
      deep.fragments.push_back({payload, depth_of(key), static_cast<std::uint32_t>(primitive),
                                static_cast<std::uint32_t>(primitive >> 32)});
      const std::uint64_t index = index_of(x, y);
      if (deep.pixels.empty() || deep.pixels.back().index != index)
        deep.pixels.push_back({index, 0});
      ++deep.pixels.back().size;
    });
  });
  return {rank.options.width * n * n, rank.options.height, std::move(tiles)};
}

// The pixels that this rank owns in the end, blended. colour_of gives a payload's colour.
template <class Colour, class Payload, class F>
composite::OwnedPixels flatten(RankContext& rank, composite::OwnedPixels&& part, F&& colour_of) {
  constexpr std::size_t kGrain = 1 << 12;  // samples
  composite::OwnedPixels result;
  result.ranges = part.ranges;
  const composite::DeepImage<Payload> deep = composite::take_deep<Payload>(std::move(part));
  image::BasicImage<Colour> image(deep.width, deep.height);
  ProcessorSeconds seconds;
  const auto colour_if_seen = [&](const Payload& payload) {
    const image::RgbaF colour = colour_of(payload);
    return colour.a > 0 ? std::optional(colour) : std::nullopt;
  };
  for (const composite::PixelRange& range : result.ranges) {
    parallel::parallel_blocks(
        range.begin, range.end, kGrain, [&](std::size_t begin, std::size_t end) {
          seconds.measure([&] { composite::flatten(deep, begin, end, image, colour_if_seen); });
        });
  }
  rank.counts.phases.shade += seconds.seconds();
  result.layer = composite::make_dense(std::move(image));
  return result;
}

// Transparent surfaces have to be blended in one order over all ranks.
composite::DeepImage<image::RgbaF> surfaces_of(RankContext& rank, const DrawList& list,
                                               RegionDrawing& drawing) {
  return end_deep<image::RgbaF>(
      rank, list, drawing, [](TileView& tile, const geometry::Rect& rect, auto&& add) {
        tile.for_each_surface(rect, [&](int x, int y, std::span<const SurfaceSeen> surfaces) {
          for (const SurfaceSeen& surface : surfaces)
            if (surface.colour.a > 0) add(x, y, surface.key, surface.colour);
        });
      });
}
std::unique_ptr<composite::Layer> draw_surfaces(RankContext& rank, const DrawList& list,
                                                RegionDrawing& drawing) {
  return composite::make_deep(surfaces_of(rank, list, drawing));
}

template <class Colour>
composite::OwnedPixels blend_surfaces(RankContext& rank, composite::OwnedPixels&& part) {
  return flatten<Colour, image::RgbaF>(rank, std::move(part),
                                       [](const image::RgbaF& colour) { return colour; });
}

// The pixels that this rank owns in the end, as the picture has them.
template <class Colour>
composite::OwnedPixels stored(composite::OwnedPixels&& part) {
  if constexpr (std::is_same_v<Colour, image::RgbaF>) {
    return std::move(part);
  } else {
    constexpr std::size_t kGrain = 1 << 14;  // samples
    composite::OwnedPixels result;
    result.ranges = part.ranges;
    image::ImageF light = composite::take_image<image::RgbaF>(std::move(part));
    image::BasicImage<Colour> image(light.width, light.height);
    for (const composite::PixelRange& range : result.ranges) {
      parallel::parallel_for(range.begin, range.end, kGrain, [&](std::size_t i) {
        composite::store(light.colour[i], image.colour[i]);
      });
    }
    image.depth = std::move(light.depth);
    result.layer = composite::make_dense(std::move(image));
    return result;
  }
}

// A point as it travels where no texture is of set 1: without what comes last in it.
struct PlainSeenPoint {
  static constexpr std::size_t kBytes =
      offsetof(SeenPoint, point) + offsetof(shading::Point, second);
  alignas(SeenPoint) std::byte bytes[kBytes] = {};

  PlainSeenPoint() = default;
  explicit PlainSeenPoint(const SeenPoint& point) { std::memcpy(bytes, &point, kBytes); }
  explicit operator SeenPoint() const {
    SeenPoint point;
    std::memcpy(static_cast<void*>(&point), bytes, kBytes);
    return point;
  }
};
bool is_opaque(const PlainSeenPoint& point) { return is_opaque(SeenPoint(point)); }

template <class Payload>
std::unique_ptr<composite::Layer> draw_points(RankContext& rank, const DrawList& list,
                                              RegionDrawing& drawing) {
  return composite::make_deep(end_deep<Payload>(
      rank, list, drawing, [](TileView& tile, const geometry::Rect& rect, auto&& add) {
        tile.for_each_pixel(rect, [&](int x, int y, std::span<const std::int64_t> keys) {
          for (const std::int64_t key : keys) {
            const SeenPoint point = point_seen(tile.frame(), tile.seen(), number_of(key), x, y);
            add(x, y, key, Payload(point));
            if (is_opaque(point)) break;
          }
        });
      }));
}

template <class Colour, class Payload>
composite::OwnedPixels shade_points(RankContext& rank, composite::OwnedPixels&& part) {
  const DrawList nothing;
  const FrameShading frame = make_frame_shading(rank.screen, rank.prepared.shader(), nothing,
                                                rank.options.lighting, false);
  std::atomic<std::uint64_t> shaded{0};
  composite::OwnedPixels result =
      flatten<Colour, Payload>(rank, std::move(part), [&](const Payload& point) {
        shaded.fetch_add(1, std::memory_order_relaxed);
        return shade(frame, SeenPoint(point));
      });
  rank.counts.shaded += shaded;
  return result;
}

// Stands for an image that is not needed any more.
template <class Colour>
std::unique_ptr<composite::Layer> mask_of(const RankContext& rank,
                                          const image::BasicImage<Colour>& image) {
  return composite::make_metadata_only_active(composite::MaskMaker().add(image.depth.span()),
                                              sizeof(Colour) + sizeof(float),
                                              {&rank.communicator, *rank.options.count_only});
}

// Triangles are drawn as soon as they are set up, so that none are kept and hidden clusters are
// skipped: that belongs to the first step, large and blended triangles and shading to the second.
template <class Colour>
class Steps final : public FrameSteps {
 public:
  explicit Steps(RankContext& rank) : rank_(rank), seen_(rank.screen.frame()) {}

  void transform() override {
    const geometry::Rect frame = rank_.frame();
    if (PackedScene* const packed = rank_.prepared.packed) {
      packed_ = std::make_unique<PackedDrawing>(
          rank_, *packed,
          share_of_pages(visible_pages(rank_, *packed), rank_.number(), rank_.ranks()));
      drawing_.reset(new RegionDrawing(rank_.begin(packed_->list(), {&frame, 1})));
      packed_->draw(*drawing_);
      return;
    }
    list_ = make_draw_list(pieces(), &rank_.prepared.clusters);
    drawing_.reset(new RegionDrawing(rank_.begin(list_, {&frame, 1})));
    if (feeds_back()) drawing_->sample_seen();
    drawing_->draw_all();
  }

  void rasterize() override {
    if (rank_.ranks() == 1) {
      image_ = rank_.take_image<Colour>(rank_.options.width, rank_.options.height);
      rank_.end_pixels(*drawing_, image_);
    } else if (shades_last()) {
      layer_ = two_sets() ? draw_points<SeenPoint>(rank_, list(), *drawing_)
                          : draw_points<PlainSeenPoint>(rank_, list(), *drawing_);
    } else if (has_cells()) {
      layer_ = draw_cell(rank_, list(), *drawing_, cell_);
    } else if (rank_.prepared.transparent) {
      layer_ = draw_surfaces(rank_, list(), *drawing_);
    } else if (counts_only()) {
      const image::BasicImage<Colour> image = rank_.end_samples<Colour>(*drawing_);
      rank_.communicator.mark(comm::Phase::compose, 0);  // ranks that do more than count do not
      layer_ = mask_of(rank_, image);
    } else if (finishes_early()) {
      layer_ = layer_of(others_->end_samples_meanwhile<Colour>(seen_));
    } else if (is_much(seen_)) {
      layer_ = layer_of(rank_.end_samples<Colour>(*drawing_));
    } else {
      // The part is copied in the end.
      is_part_ = true;
      layer_ = codec().make(rank_.end_part<Colour>(*drawing_, seen_));
    }
    measure();
    drop_drawing();
  }

  Picture compose() override {
    if (rank_.ranks() == 1) return std::move(image_);
    composite::OwnedPixels part = timed(rank_.communicator, rank_.counts.phases.compose, [&] {
      return composite::compose(
          rank_.communicator, std::move(layer_), rank_.options.scheme,
          {.samples_per_pixel = rank_.samples_per_pixel(), .order = std::move(order_)});
    });
    if (shades_last()) {
      part = two_sets() ? shade_points<Colour, SeenPoint>(rank_, std::move(part))
                        : shade_points<Colour, PlainSeenPoint>(rank_, std::move(part));
    } else if (has_cells()) {
      part = stored<Colour>(std::move(part));
    } else if (rank_.prepared.transparent) {
      part = blend_surfaces<Colour>(rank_, std::move(part));
    }
    return picture_of(std::move(part));
  }

  // Between the first two, where the communicator may be used. Collective.
  void hide_behind_others() {
    if (shades_last() || has_cells()) return;
    others_.emplace(rank_, *drawing_);
    if (!finishes_early()) seen_ = others_->hide();
  }

  // Whether tiles can go to their owners before all are finished.
  bool has_tiles() const {
    return rank_.options.scheme == "tiles" && rank_.ranks() > 1 && !rank_.prepared.transparent &&
           !shades_last() && !has_cells() && !counts_only();
  }
  // Instead of rasterize and compose. REQUIRES: has_tiles().
  Picture rasterize_and_compose() {
    composite::OwnedPixels part = hand_over_tiles<Colour>(rank_, *drawing_);
    measure();
    return picture_of(std::move(part));
  }

 private:
  const DrawList& list() const { return packed_ ? packed_->list() : list_; }
  void drop_drawing() {
    others_.reset();
    drawing_.reset();
    if (packed_) packed_->count();
    packed_.reset();
    list_ = {};
  }
  bool shades_last() const { return rank_.options.shade == Shade::composited; }
  // Whether any material looks at both sets of texture coordinates; all ranks say the same.
  bool two_sets() const {
    const auto& materials = rank_.prepared.shader().materials;
    return std::any_of(materials.begin(), materials.end(), [&](const scenes::Material& material) {
      return shading::texture_sets(rank_.prepared.shader(), material) > 1;
    });
  }
  // Whether images are of the whole frame, and of no part of it, where no more than these samples
  // show anything.
  bool is_much(const geometry::Rect& samples) const {
    return rank_.options.supersampling > 1 || 2 * samples.area() > rank_.screen.frame().area();
  }
  // Whether this rank need not wait until it knows what others hide: its image will be of the whole
  // frame, as it shows much alone, and what they hide can be taken out of it.
  bool finishes_early() const {
    return others_ && others_->is_pending() && is_much(others_->shown()) && !has_tiles() &&
           !rank_.options.count_only && packed_ == nullptr && rank_.options.supersampling == 1;
  }
  bool has_cells() const { return rank_.options.blend == Blend::by_cell && rank_.ranks() > 1; }
  bool counts_only() const {
    return rank_.options.count_only && rank_.options.codec == "active" && rank_.ranks() > 1 &&
           !rank_.prepared.transparent && !shades_last() && !has_cells();
  }

  // Whether shares follow the work of the last frame. Frames in steps overlap, and none knows what
  // the one before took; of a wall it was another display's; and parts stay where they are.
  bool feeds_back() const {
    return rank_.ranks() > 1 && !has_cells() && rank_.prepared.packed == nullptr &&
           !rank_.in_steps && rank_.options.displays.empty() && !rank_.prepared.is_part;
  }

  // What the rank drew: counted, so that frames share out the same primitives in each run, or
  // measured.
  void measure() {
    if (!feeds_back()) return;
    constexpr double kPrimitivePrice = 0.3;  // of a pixel that is shaded
    const auto primitives = static_cast<double>(rank_.counts.triangles.in);
    const auto shaded = static_cast<double>(rank_.counts.shaded);
    double unit = 1;
    if (const double work = kPrimitivePrice * primitives + shaded;
        rank_.options.costs == CostSource::measured && work > 0) {
      const Phases& phases = rank_.counts.phases;
      unit = (phases.transform + phases.bin + phases.rasterize + phases.shade) / work;
    }
    rank_.memory.primitive_shares.measure(unit * kPrimitivePrice, unit * shaded,
                                          primitives_of(list_, rank_.scratch.seen));
  }

  const composite::Codec& codec() const { return *composite::find_codec(rank_.options.codec); }
  // With what is known of the image.
  std::unique_ptr<composite::Layer> layer_of(image::BasicImage<Colour>&& image) {
    std::unique_ptr<composite::Layer> layer = codec().make(std::move(image));
    dynamic_cast<composite::ImageLayer<Colour>&>(*layer).set_shown(
        std::exchange(rank_.scratch.shown, {}));
    return layer;
  }

  std::vector<Piece> pieces() {
    if (has_cells()) {
      SceneCells& cells = rank_.memory.cells;
      cut_scene(rank_, cells);
      cell_ = cells.cell(rank_.number());
      order_ = loadbalance::front_to_back(cells.cells, rank_.screen.view.viewpoint);
      return cells.pieces;
    }
    const auto [begin, end] = feeds_back() ? rank_.memory.primitive_shares.next(
                                                 rank_.communicator, rank_.prepared.primitives)
                                           : rank_.own_primitives();
    return pieces_of(rank_.prepared.scene, rank_.prepared.first_primitives, begin, end);
  }

  // Who has pixels that are final makes distances of their depths.
  void make_distances(composite::OwnedPixels& part) {
    const std::span depths =
        dynamic_cast<composite::ImageLayer<Colour>&>(*part.layer).image().depth.span();
    for (const composite::PixelRange& range : part.ranges)
      to_distances(depths.subspan(range.begin, range.size()), rank_.screen.view);
  }

  Picture picture_of(composite::OwnedPixels&& part) {
    if (counts_only()) {
      timed(rank_.communicator, rank_.counts.phases.gather,
            [&] { return composite::gather(rank_.communicator, std::move(part), rank_.root); });
      return image::BasicImage<Colour>();
    }
    part = resolve<Colour>(std::move(part), rank_.options.supersampling, rank_.options.width,
                           rank_.options.height);
    rank_.communicator.mark(comm::Phase::gather, 0);
    part = timed(rank_.communicator, rank_.counts.phases.gather, [&] {
      make_distances(part);
      return composite::gather(rank_.communicator, std::move(part), rank_.root);
    });
    composite::ShownBlocks shown =
        dynamic_cast<composite::ImageLayer<Colour>&>(*part.layer).take_shown();
    image::BasicImage<Colour> image = composite::take_image<Colour>(std::move(part));
    if (!rank_.in_steps && !is_part_) {
      rank_.scratch.shown = std::move(shown);
      rank_.scratch.shown_in = image.colour.data();
    }
    if (rank_.number() == rank_.root) {
      if (is_part_) return rank_.picture_around(seen_, std::move(image));
      return image;
    }
    // For the next frame. In steps the scratch memory is another frame's by now.
    if (!rank_.in_steps) (is_part_ ? rank_.scratch.part : rank_.scratch.spare) = std::move(image);
    return image::BasicImage<Colour>();
  }

  RankContext& rank_;
  DrawList list_;
  std::unique_ptr<PackedDrawing> packed_;  // instead of the list
  std::unique_ptr<RegionDrawing> drawing_;
  std::optional<OthersDepths> others_;
  geometry::Rect seen_;                      // by any rank; set before it is rasterized
  bool is_part_ = false;                     // layer_ has no more of the frame
  image::BasicImage<Colour> image_;          // a single rank's
  std::unique_ptr<composite::Layer> layer_;  // of one among several
  // With a cell for each rank.
  geometry::Box3 cell_;
  std::vector<int> order_;
};

template <class Colour>
Picture render(RankContext& rank) {
  rank.communicator.mark(comm::Phase::rasterize, 0);
  Steps<Colour> steps(rank);
  if (rank.prepared.packed != nullptr) {
    // A rank that cannot read a page would be waited for.
    comm::all_or_none(rank.communicator, comm::Phase::rasterize, [&] { steps.transform(); });
    steps.hide_behind_others();
    comm::all_or_none(rank.communicator, comm::Phase::rasterize, [&] { steps.rasterize(); });
    return steps.compose();
  }
  steps.transform();
  steps.hide_behind_others();
  if (steps.has_tiles()) return steps.rasterize_and_compose();
  steps.rasterize();
  return steps.compose();
}

}  // namespace

std::unique_ptr<FrameSteps> sort_last_steps(RankContext& rank) {
  if (rank.options.float_pixels) return std::make_unique<Steps<image::RgbaF>>(rank);
  return std::make_unique<Steps<image::Rgba8>>(rank);
}

PartialImage sort_last_share(RankContext& rank) {
  const auto [begin, end] = rank.own_primitives();
  const DrawList list =
      make_draw_list(pieces_of(rank.prepared.scene, rank.prepared.first_primitives, begin, end),
                     &rank.prepared.clusters);
  const geometry::Rect frame = rank.frame();
  RegionDrawing drawing = rank.begin(list, {&frame, 1});
  drawing.draw_all();
  if (rank.prepared.transparent) return surfaces_of(rank, list, drawing);
  return rank.end_samples<image::Rgba8>(drawing);
}

Picture sort_last(RankContext& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
