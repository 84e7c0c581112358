// Hybrid of sort-first and sort-last (Samanta et al. 2000): every group of primitives goes to one
// rank, which draws all of it, and every rank has a region of the screen, both chosen together so
// that little of what a rank draws lies outside its region. What does goes to the owners of those
// samples, who composite it. No primitive is drawn twice but those of groups that are too much for
// one rank, as a ground of two triangles is: of these every rank draws what lies in its region.
#include <algorithm>
#include <cassert>
#include <type_traits>

#include "comm/collectives.h"
#include "loadbalance/region_index.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/distances.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/hybrid_shares.h"
#include "raster/distribute/others_depths.h"
#include "raster/distribute/tile_fragments.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

using geometry::Rect;

// The parts of `outer` that are not in `inner`.
std::vector<Rect> outside(const Rect& outer, const Rect& inner) {
  const Rect common = geometry::intersection(outer, inner);
  if (common.empty()) return outer.empty() ? std::vector<Rect>() : std::vector{outer};
  std::vector<Rect> parts = {{outer.x0, outer.y0, outer.x1, common.y0},
                             {outer.x0, common.y0, common.x0, common.y1},
                             {common.x1, common.y0, outer.x1, common.y1},
                             {outer.x0, common.y1, outer.x1, outer.y1}};
  std::erase_if(parts, [](const Rect& part) { return part.empty(); });
  return parts;
}

// One rank's drawing into its own region and, for their owners, into the others'.
template <class Colour, bool kTransparent>
class Drawing {
 public:
  Drawing(RankContext& rank, SharedOut& out, image::BasicImage<Colour>& image)
      : rank_(rank),
        out_(out),
        shares_(out.shares),
        window_(window_of(image)),
        contested_(static_cast<std::size_t>(rank.screen.tiles())),
        kept_(contested_.size()),
        leaving_(contested_.size()) {
    for (const loadbalance::Region& region : shares_.plan->partition.regions.regions)
      if (region.owner == rank.number()) own_ = region.rect;
    drawn_ = {rank.options.width, rank.options.height, 0, 0};
    for (std::size_t i = 0; i < shares_.plan->boxes.size(); ++i) {
      const Rect& box = shares_.plan->boxes[i].box;
      const int owner = shares_.plan->partition.owners[i];
      if (owner == rank.number()) {
        drawn_ = {std::min(drawn_.x0, box.x0), std::min(drawn_.y0, box.y0),
                  std::max(drawn_.x1, box.x1), std::max(drawn_.y1, box.y1)};
      } else if (owner != loadbalance::kEverybody) {
        contest(samples_of(geometry::intersection(box, own_), samples()));
      }
    }
  }

  void draw() {
    const std::size_t places = contested_.size() * kTilePixels;
    if (merges_into_image() && out_.numbers.size() != places)
      out_.numbers = image::Plane<std::uint32_t>(places);  // touched where tiles are contested
    std::vector<Rect> rects = outside(drawn_, own_);
    if (!own_.empty()) rects.push_back(own_);
    const Rect own = samples_of(own_, samples());
    const loadbalance::RegionIndex index(shares_.plan->partition.regions);
    rank_.communicator.mark(comm::Phase::rasterize, 0);
    RegionDrawing drawing = rank_.begin(out_.list, rects);
    drawing.draw_all();
    const auto finish_tile = [&](std::span<const Rect> parts, TileView& tile) {
      const int k =
          parts.front().y0 / kTileSize * rank_.screen.tiles_x + parts.front().x0 / kTileSize;
      for (const Rect& part : parts) {
        if (!own.contains(part.x0, part.y0)) {
          if (!tile.empty()) hand_on(index, part, k, tile);
        } else if (contested_[k] && merges_into_image()) {
          tile.shade_pixels(part, 1, window_);
          keep_numbers(tile, part, k);
        } else if (contested_[k]) {
          append(tile, part, {}, kept_[k]);
        } else {
          tile.shade_pixels(part, samples(), window_);
          if (!tile.empty()) to_distances(pixels_of(part, samples()), window_, view());
        }
      }
    };
    OthersDepths others(rank_, drawing);
    // In tiles of its own region alone in which no other draws anything.
    others.finish_meanwhile(finish_tile, [&](int tile) {
      const Rect rect = rank_.screen.tile(tile);
      return geometry::intersection(rect, own) == rect && !contested_[tile];
    });
    others.hide();
    rank_.end(drawing, finish_tile);
  }

  // Sends others what was seen in their regions and composites what they saw in this rank's.
  void compose() {
    std::vector<std::vector<Span>> tiles_for(static_cast<std::size_t>(rank_.ranks()));
    for (std::size_t k = 0; k < leaving_.size(); ++k) {
      for (const Leaving& leaving : leaving_[k]) {
        tiles_for[leaving.owner].push_back(span_of(static_cast<int>(k), leaving.seen));
        rank_.fragments_travelled += leaving.seen.fragments.size();
      }
    }
    std::vector<comm::Parcel> parcels;
    for (int k = 0; k < rank_.ranks(); ++k) {
      if (!tiles_for[k].empty())
        parcels.push_back({k, pack_tiles(std::span<const Span>(tiles_for[k]))});
    }
    const std::vector<comm::Parcel> arrived =
        comm::exchange(rank_.communicator, std::move(parcels));

    std::vector<std::vector<Span>> seen(contested_.size());
    std::uint64_t composited = 0;
    for (const comm::Parcel& parcel : arrived) {
      for (const Span& span : unpack_tiles<Payload>(parcel.message)) {
        assert(contested_[span.tile]);
        seen[span.tile].push_back(span);
        composited += span.fragments.size();
      }
    }
    parallel::parallel_for(0, contested_.size(), 1, [&](std::size_t k) {
      if (!contested_[k]) return;
      if (!merges_into_image()) seen[k].push_back(span_of(static_cast<int>(k), kept_[k]));
      const Rect rect = geometry::intersection(rank_.screen.tile(static_cast<int>(k)),
                                               samples_of(own_, samples()));
      if (!seen[k].empty()) compose_tile(seen[k], rect, k);
      to_distances(pixels_of(rect, samples()), window_, view());
    });
    rank_.communicator.work(comm::Work::pixels_composited, composited);
  }

 private:
  using Payload = std::conditional_t<kTransparent, image::RgbaF, Colour>;
  using Span = TileSpan<Payload>;
  struct Leaving {
    int owner = 0;
    TileFragments<Payload> seen;
  };

  int samples() const { return rank_.options.supersampling; }
  const scenes::View& view() const { return rank_.screen.view; }

  void contest(const Rect& rect) {
    if (rect.empty()) return;
    for (int y = rect.y0 / kTileSize; y <= (rect.y1 - 1) / kTileSize; ++y) {
      for (int x = rect.x0 / kTileSize; x <= (rect.x1 - 1) / kTileSize; ++x)
        contested_[y * rank_.screen.tiles_x + x] = 1;
    }
  }

  static void append(TileView& tile, const Rect& rect, std::span<const PrimitiveRange> passed_over,
                     TileFragments<Payload>& seen) {
    if constexpr (kTransparent)
      append_surfaces(tile, rect, passed_over, seen);
    else
      append_opaque(tile, rect, passed_over, seen);
  }

  void hand_on(const loadbalance::RegionIndex& index, const Rect& rect, int k, TileView& tile) {
    index.for_each_region(pixels_of(rect, samples()),
                          [&](const loadbalance::Region& region, const Rect& common) {
                            TileFragments<Payload> seen;
                            append(tile, samples_of(common, samples()), shares_.everybodys, seen);
                            if (!seen.positions.empty())
                              leaving_[k].push_back({region.owner, std::move(seen)});
                          });
  }

  // Whether a sample that others may see, too, is shaded into the image at once: what arrives is
  // held against it. Else all that is seen of a contested tile is composited in the end.
  bool merges_into_image() const { return !kTransparent && samples() == 1; }
  std::span<std::uint32_t> numbers_of(std::size_t tile) {
    return out_.numbers.span().subspan(tile * kTilePixels, kTilePixels);
  }
  void keep_numbers(const TileView& tile, const Rect& rect, int k) {
    const std::span<std::uint32_t> numbers = numbers_of(static_cast<std::size_t>(k));
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        numbers[y % kTileSize * kTileSize + x % kTileSize] = tile.opaque_number(x, y);
    }
  }

  void compose_tile(std::span<const Span> seen, const Rect& rect, std::size_t k) {
    if constexpr (!kTransparent) {
      if (merges_into_image()) {
        merge_nearest(seen, rect, out_.list, numbers_of(k), window_);
        return;
      }
    }
    const Window<Colour> to = samples() == 1 ? window_ : tile_window<Colour>(rect);
    if constexpr (kTransparent)
      blend_surfaces(seen, rect, to);
    else
      keep_nearest(seen, rect, to);
    if (samples() > 1) resolve(to, samples(), pixels_of(rect, samples()), window_);
  }

  RankContext& rank_;
  SharedOut& out_;
  const Shares& shares_;
  Window<Colour> window_;
  Rect own_, drawn_;  // in pixels: this rank's region, and where its groups may be seen
  // By tile: whether others' groups may be seen in the rank's own region; what it saw itself there,
  // unless that is in the image; what it saw in others' regions.
  std::vector<std::uint8_t> contested_;
  std::vector<TileFragments<Payload>> kept_;
  std::vector<std::vector<Leaving>> leaving_;
};

template <class Colour, bool kTransparent>
Picture render(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  SharedOut& out = share_out_frame(rank);

  auto image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  Drawing<Colour, kTransparent> drawing(rank, out, image);
  drawing.draw();
  communicator.mark(comm::Phase::compose, 0);
  const double drawn = communicator.seconds();
  drawing.compose();
  const double composed = communicator.seconds();
  rank.counts.phases.compose += composed - drawn;
  return rank.gather(out.shares.plan->partition.regions, std::move(image));
}

template <class Colour>
Picture render(RankContext& rank) {
  return rank.prepared.transparent ? render<Colour, true>(rank) : render<Colour, false>(rank);
}

}  // namespace

Picture hybrid(RankContext& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
