// Sets up splats: small spots by vectors, one lane a point, pixel by pixel of the square around all
// of them; others one by one.
//
// Splats of a few pixels become fragments at once; larger ones, of which a cluster may have any
// number, keep an entry in each tile that they touch. Cost: about a nanosecond a point and pixel of
// the square, some dozens a splat.
//
// Degenerate: spots before the near plane or outside of the guard band are dropped, as are splats
// without a pixel of `clip`.
#include "raster/pipeline/splat_set_up.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/splat_set_up.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/pipeline/triangle_lanes.h"

#ifndef DELRAY_RASTER_SPLAT_SET_UP
#define DELRAY_RASTER_SPLAT_SET_UP
namespace delray::raster {

// Spots of a larger radius are set up one by one.
inline constexpr std::int32_t kLargestSpot = 4 * kSubpixels;

// Spots of a cluster: vertex p is at place p.
struct SpotsToSetUp {
  const ScreenVertices& vertices;
  const Screen& screen;
  geometry::Rect clip;
  std::uint32_t begin, end, first_number;
  std::int32_t radius;  // subpixels
};

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// REQUIRES: the result has room for all pixels of the square of `reach` around each, and a vector.
void set_up_spots(const SpotsToSetUp& spots, std::int32_t reach, SetUpResult& result) {
  const Ints d;
  const hn::RebindToUnsigned<Ints> du;
  const std::size_t lanes = hn::Lanes(d);
  const I centre_x = hn::Set(d, spots.screen.centre_x),
          centre_y = hn::Set(d, spots.screen.centre_y);
  const I tiles_x = hn::Set(d, spots.screen.tiles_x), in_tile = hn::Set(d, kTileSize - 1);
  const I x0 = hn::Set(d, spots.clip.x0), width = hn::Set(d, spots.clip.width());
  const I y0 = hn::Set(d, spots.clip.y0), height = hn::Set(d, spots.clip.height());
  const I squared = hn::Set(d, spots.radius * spots.radius);
  std::size_t size = result.fragments;
  for (std::size_t place = spots.begin; place < spots.end; place += lanes) {
    const I x = hn::LoadU(d, spots.vertices.x + place), y = hn::LoadU(d, spots.vertices.y + place);
    const I depth =
        hn::LoadU(d, reinterpret_cast<const std::int32_t*>(spots.vertices.depth) + place);
    const I number =
        hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(spots.first_number + place)));
    const Mask used = hn::And(hn::FirstN(d, spots.end - place), hn::Ne(x, hn::Set(d, kOutside)));
    const I own_x = hn::ShiftRight<kSubpixelBits>(x), own_y = hn::ShiftRight<kSubpixelBits>(y);
    for (std::int32_t j = -reach; j <= reach; ++j) {
      const I row = hn::Add(own_y, hn::Set(d, j));
      const I dy = hn::Sub(hn::Add(hn::ShiftLeft<kSubpixelBits>(row), hn::Set(d, kHalfPixel)), y);
      const I pixel_y = hn::Add(row, centre_y), from_top = hn::Sub(pixel_y, y0);
      const Mask in_rows =
          hn::And(used, hn::And(hn::Gt(from_top, hn::Set(d, -1)), hn::Lt(from_top, height)));
      const I tile_row = hn::Mul(hn::ShiftRight<6>(pixel_y), tiles_x);
      const I row_address = hn::ShiftLeft<6>(hn::And(pixel_y, in_tile));
      for (std::int32_t i = -reach; i <= reach; ++i) {
        const I column = hn::Add(own_x, hn::Set(d, i));
        const I pixel_x = hn::Add(column, centre_x), from_left = hn::Sub(pixel_x, x0);
        Mask covered =
            hn::And(in_rows, hn::And(hn::Gt(from_left, hn::Set(d, -1)), hn::Lt(from_left, width)));
        if (i != 0 || j != 0) {
          const I dx =
              hn::Sub(hn::Add(hn::ShiftLeft<kSubpixelBits>(column), hn::Set(d, kHalfPixel)), x);
          const I apart = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
          covered = hn::And(covered, hn::Lt(apart, squared));
        }
        const I tile = hn::Add(tile_row, hn::ShiftRight<6>(pixel_x));
        const I address =
            hn::Or(hn::ShiftLeft<12>(tile), hn::Or(row_address, hn::And(pixel_x, in_tile)));
        const auto mask = hn::RebindMask(du, covered);
        append(hn::BitCast(du, address), mask, result.address.data() + size);
        append(hn::BitCast(du, hn::Not(depth)), mask, result.code.data() + size);
        append(hn::BitCast(du, number), mask, result.number.data() + size);
        size += hn::CountTrue(d, covered);
      }
    }
  }
  result.fragments = size;
}
static_assert(kTileSize == 1 << 6 && kTilePixels == 1 << 12);

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {
namespace {

HWY_EXPORT(set_up_spots);

// Splats of at most so many pixels in their box become fragments.
constexpr std::int64_t kFewPixels = 256;

void reserve_fragments(std::size_t more, SetUpResult& result) {
  const std::size_t most = result.fragments + more;
  if (result.address.size() >= most) return;
  result.address.resize(2 * most);
  result.code.resize(2 * most);
  result.number.resize(2 * most);
}

void append_pixels(const Screen& screen, const geometry::Rect& pixels, const Splat& splat,
                   SetUpResult& result) {
  reserve_fragments(static_cast<std::size_t>(pixels.area()), result);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      float depth;
      if (!covers(screen, splat, x, y, depth)) continue;
      const int tile = y / kTileSize * screen.tiles_x + x / kTileSize;
      const std::size_t i = result.fragments++;
      result.address[i] = static_cast<std::uint32_t>(tile * kTilePixels +
                                                     y % kTileSize * kTileSize + x % kTileSize);
      result.code[i] = static_cast<std::uint32_t>(code_of_depth(depth));
      result.number[i] = splat.number;
    }
  }
}

void append_splat(const ClusterToSetUp& cluster, const Splat& splat, SetUpResult& result) {
  const Screen& screen = cluster.on_screen.screen;
  const geometry::Rect pixels = geometry::intersection(splat.pixels, cluster.clip);
  ++result.counts.in;
  if (pixels.empty()) {
    ++result.counts.culled;
    return;
  }
  ++result.counts.rasterized;
  if (pixels.area() <= kFewPixels) {
    append_pixels(screen, pixels, splat, result);
    return;
  }
  const auto entry = static_cast<std::uint32_t>(result.splats.size());
  result.splats.push_back(splat);
  for (int y = pixels.y0 / kTileSize; y <= (pixels.y1 - 1) / kTileSize; ++y) {
    for (int x = pixels.x0 / kTileSize; x <= (pixels.x1 - 1) / kTileSize; ++x)
      result.splat_entries.push_back({static_cast<std::uint32_t>(y * screen.tiles_x + x), entry});
  }
}

}  // namespace

void set_up_splats(const ClusterToSetUp& cluster, ScreenVertices& vertices, SetUpResult& result) {
  const auto& [screen, draw, block, mesh_cluster, unused] = cluster.on_screen;
  const SplatDraw& splats = draw.splats;
  const auto radius = static_cast<std::int32_t>(std::nearbyint(splats.radius * kSubpixels));
  const bool by_vectors = splats.is_spot() && splats.in_samples && radius <= kLargestSpot &&
                          mesh_cluster.vertices == mesh_cluster.count;
  if (!by_vectors) {
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
      append_splat(cluster,
                   make_splat(screen, splats, *draw.draw->mesh, mesh_cluster.first + place,
                              cluster.first_number + place),
                   result);
    }
    return;
  }
  // A vertex at each place: primitives are numbered by vertices as these are first used.
  const std::span<const std::uint32_t> which = block.vertices_of(mesh_cluster);
  const std::vector<glm::vec3>& positions = draw.draw->mesh->positions;
  if (mesh_cluster.consecutive)
    transform(splats.to_view, screen, std::span(positions).subspan(which[0], which.size()),
              vertices);
  else
    transform(splats.to_view, screen, positions, which, vertices);
  const std::int32_t reach = (radius + kHalfPixel - 1) >> kSubpixelBits;
  const auto side = static_cast<std::size_t>(2 * reach + 1);
  const std::size_t count = cluster.end - cluster.begin;
  reserve_fragments((count + kMostLanes) * side * side + kMostLanes, result);
  const std::size_t before = result.fragments;
  HWY_DYNAMIC_DISPATCH(set_up_spots)
  ({vertices, screen, cluster.clip, cluster.begin, cluster.end, cluster.first_number, radius},
   reach, result);
  const std::uint64_t shown = std::min<std::uint64_t>(count, result.fragments - before);
  result.counts.in += count;
  result.counts.rasterized += shown;
  result.counts.culled += count - shown;
}

}  // namespace delray::raster
#endif
