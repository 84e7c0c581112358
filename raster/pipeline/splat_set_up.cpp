// Sets up splats: small spots by vectors, one lane a point, pixel by pixel of the square around all
// of a vector; others one by one.
//
// Spots of a few pixels in one tile become windows, which are drawn row by row; other splats of a
// few pixels become fragments at once; larger ones, of which a cluster may have any number, keep an
// entry in each tile that they touch. Cost: less than a nanosecond a point and pixel of the square,
// some dozens a splat.
//
// Degenerate: spots before the near plane or outside of the guard band are dropped, as are splats
// without a pixel of `clip`.
#include "raster/pipeline/splat_set_up.h"

#include <algorithm>
#include <limits>

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

// Those with pixels beside their own become windows, as far as they reach no farther.
inline constexpr std::int32_t kWindowReach = (WindowSpots::kWindow - 1) / 2;

// Pixels that a spot may reach to each side of its own.
constexpr std::int32_t reach_of(std::int32_t radius) {
  return (radius + kHalfPixel - 1) >> kSubpixelBits;
}

// In subpixels, of the spots of a cluster; 0 outside of the screen.
struct SpotRadii {
  alignas(64) std::int32_t of[kClusterVertices + ScreenVertices::kPadding];
  std::int32_t largest = 0;
};

// Vertices as transform() took them: positions[which[p]], or positions[p] where there is no which.
struct SpotPlaces {
  const glm::vec3* positions;
  const std::uint32_t* which;
  std::size_t count;
};

// Spots of a cluster: vertex p is at place p.
struct SpotsToSetUp {
  const ScreenVertices& vertices;
  const SpotRadii& radii;
  const Screen& screen;
  geometry::Rect clip;
  std::uint32_t begin, end, first_number;
};

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// As make_splat() has them, in the same order of operations.
void find_radii(const SplatDraw& splats, const Screen& screen, const SpotPlaces& places,
                const ScreenVertices& vertices, SpotRadii& radii) {
  const Floats d;
  const Ints di;
  const std::size_t lanes = hn::Lanes(d);
  const auto set = [&](float v) HWY_ATTR { return hn::Set(d, v); };
  const glm::vec4& row = splats.to_view.row[2];
  const bool in_perspective = !splats.in_samples && !screen.view.orthographic;
  const auto whole = set(splats.in_samples ? splats.radius : splats.radius * screen.view.scale);
  I largest = hn::Zero(di);
  HWY_ALIGN float p[3][kMostLanes];
  for (std::size_t i = 0; i < places.count; i += lanes) {
    auto radius = whole;
    if (in_perspective) {
      for (std::size_t k = 0; k < lanes; ++k) {
        const std::size_t vertex = std::min(i + k, places.count - 1);
        const glm::vec3& at =
            places.positions[places.which == nullptr ? vertex : places.which[vertex]];
        p[0][k] = at.x, p[1][k] = at.y, p[2][k] = at.z;
      }
      const auto xy =
          hn::Add(hn::Mul(set(row.x), hn::Load(d, p[0])), hn::Mul(set(row.y), hn::Load(d, p[1])));
      const auto z = hn::Add(hn::Add(xy, hn::Mul(set(row.z), hn::Load(d, p[2]))), set(row.w));
      radius = hn::Mul(set(splats.radius), hn::Div(set(screen.view.scale), z));
    }
    const auto inside = hn::Ne(hn::Load(di, vertices.x + i), hn::Set(di, kOutside));
    const auto in_subpixels = hn::NearestInt(
        hn::Mul(hn::Min(radius, set(kLargestSplat)), set(static_cast<float>(kSubpixels))));
    const I result = hn::IfThenElseZero(inside, in_subpixels);
    largest = hn::Max(largest, result);
    hn::Store(result, di, radii.of + i);
  }
  radii.largest = hn::GetLane(hn::MaxOfLanes(di, largest));
}

// A vector of spots.
struct Lanes {
  I x, y, radius;  // in subpixels from the centre of the screen; those not used: radius 0
  I column, row;   // of the pixel of the frame that each is in
  I code, number;
  Mask used;
};

HWY_INLINE Lanes load(const SpotsToSetUp& spots, std::size_t place) {
  const Ints d;
  Lanes lanes;
  lanes.x = hn::LoadU(d, spots.vertices.x + place);
  lanes.y = hn::LoadU(d, spots.vertices.y + place);
  lanes.used = hn::And(hn::FirstN(d, spots.end - place), hn::Ne(lanes.x, hn::Set(d, kOutside)));
  lanes.radius = hn::IfThenElseZero(lanes.used, hn::LoadU(d, spots.radii.of + place));
  lanes.column = hn::Add(hn::ShiftRight<kSubpixelBits>(lanes.x), hn::Set(d, spots.screen.centre_x));
  lanes.row = hn::Add(hn::ShiftRight<kSubpixelBits>(lanes.y), hn::Set(d, spots.screen.centre_y));
  lanes.code =
      hn::Not(hn::LoadU(d, reinterpret_cast<const std::int32_t*>(spots.vertices.depth) + place));
  lanes.number =
      hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(spots.first_number + place)));
  return lanes;
}

// Calls f(i, j, covered) for the pixels i to the right of and j below each spot's own one.
template <class F>
HWY_INLINE void for_each_pixel(const SpotsToSetUp& spots, const Lanes& lanes, std::int32_t reach,
                               F&& f) {
  const Ints d;
  const I none = hn::Set(d, -1), squared = hn::Mul(lanes.radius, lanes.radius);
  const I x0 = hn::Set(d, spots.clip.x0), width = hn::Set(d, spots.clip.width());
  const I y0 = hn::Set(d, spots.clip.y0), height = hn::Set(d, spots.clip.height());
  const auto to_centre = [&](I subpixels, std::int32_t pixels) HWY_ATTR {
    const I own = hn::ShiftRight<kSubpixelBits>(subpixels);
    const I pixel = hn::ShiftLeft<kSubpixelBits>(hn::Add(own, hn::Set(d, pixels)));
    return hn::Sub(hn::Add(pixel, hn::Set(d, kHalfPixel)), subpixels);
  };
  for (std::int32_t j = -reach; j <= reach; ++j) {
    const I dy = to_centre(lanes.y, j);
    const I from_top = hn::Sub(hn::Add(lanes.row, hn::Set(d, j)), y0);
    const Mask in_rows =
        hn::And(lanes.used, hn::And(hn::Gt(from_top, none), hn::Lt(from_top, height)));
    for (std::int32_t i = -reach; i <= reach; ++i) {
      const I from_left = hn::Sub(hn::Add(lanes.column, hn::Set(d, i)), x0);
      Mask covered = hn::And(in_rows, hn::And(hn::Gt(from_left, none), hn::Lt(from_left, width)));
      if (i != 0 || j != 0) {
        const I dx = to_centre(lanes.x, i);
        const I apart = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
        covered = hn::And(covered, hn::Lt(apart, squared));
      }
      f(i, j, covered);
    }
  }
}

// The pixels of a row of each spot, as bits: bit reach + i is the one i to the right of its own.
//
// A pixel of the row is covered where dx^2 < n = radius^2 - dy^2. Of n - 1 < 2^22 the root of
// floats has the right whole part, as the next whole number is further than rounding reaches.
struct RowOfSpots {
  I clip_low, clip_high;  // i that the clip leaves
  I to_centre;            // from a spot to the centre of its own pixel

  RowOfSpots(const SpotsToSetUp& spots, const Lanes& lanes) {
    const Ints d;
    clip_low = hn::Sub(hn::Set(d, spots.clip.x0), lanes.column);
    clip_high = hn::Sub(hn::Set(d, spots.clip.x1 - 1), lanes.column);
    to_centre = hn::Sub(hn::Set(d, kHalfPixel), hn::And(lanes.x, hn::Set(d, kSubpixels - 1)));
  }
  I bits(I n, Mask in_row, bool is_own, std::int32_t reach) const {
    const Ints d;
    const Floats df;
    const I zero = hn::Zero(d), one = hn::Set(d, 1);
    const I root = hn::ConvertTo(d, hn::Sqrt(hn::ConvertTo(df, hn::Max(hn::Sub(n, one), zero))));
    I low = hn::Neg(hn::ShiftRight<kSubpixelBits>(hn::Add(root, to_centre)));
    I high = hn::ShiftRight<kSubpixelBits>(hn::Sub(root, to_centre));
    if (is_own) {  // the own pixel is covered however small the spot is
      low = hn::Min(low, zero);
      high = hn::Max(high, zero);
    } else {
      in_row = hn::And(in_row, hn::Gt(n, zero));
    }
    low = hn::Max(low, clip_low);
    high = hn::Min(high, clip_high);
    in_row = hn::AndNot(hn::Gt(low, high), in_row);
    const I first = hn::Add(low, hn::Set(d, reach)), end = hn::Add(high, hn::Set(d, reach + 1));
    return hn::IfThenElseZero(in_row, hn::Sub(hn::Shl(one, end), hn::Shl(one, first)));
  }
};

HWY_INLINE void append(I v, Mask mask, std::uint32_t* to) {
  const hn::RebindToUnsigned<Ints> du;
  append(hn::BitCast(du, v), hn::RebindMask(du, mask), to);
}

// Returns which spots have pixels.
HWY_INLINE Mask append_fragments(const SpotsToSetUp& spots, const Lanes& lanes, std::int32_t reach,
                                 SetUpResult& result) {
  const Ints d;
  const I in_tile = hn::Set(d, kTileSize - 1), tiles_x = hn::Set(d, spots.screen.tiles_x);
  std::size_t size = result.fragments;
  Mask any = hn::Ne(lanes.x, lanes.x);
  for_each_pixel(spots, lanes, reach, [&](std::int32_t i, std::int32_t j, Mask covered) HWY_ATTR {
    const I x = hn::Add(lanes.column, hn::Set(d, i)), y = hn::Add(lanes.row, hn::Set(d, j));
    const I tile = hn::Add(hn::Mul(hn::ShiftRight<6>(y), tiles_x), hn::ShiftRight<6>(x));
    const I pixel = hn::Or(hn::ShiftLeft<6>(hn::And(y, in_tile)), hn::And(x, in_tile));
    append(hn::Or(hn::ShiftLeft<12>(tile), pixel), covered, result.address.data() + size);
    append(lanes.code, covered, result.code.data() + size);
    append(lanes.number, covered, result.number.data() + size);
    size += hn::CountTrue(d, covered);
    any = hn::Or(any, covered);
  });
  result.fragments = size;
  return any;
}

// Those that lie in one tile become windows, the others fragments. Returns which have pixels.
//
// REQUIRES: reach <= kWindowReach.
HWY_INLINE Mask append_windows(const SpotsToSetUp& spots, const Lanes& lanes, std::int32_t reach,
                               SetUpResult& result) {
  const Ints d;
  I upper = hn::Zero(d), lower = hn::Zero(d);
  const RowOfSpots row(spots, lanes);
  const I none = hn::Set(d, -1), squared = hn::Mul(lanes.radius, lanes.radius);
  const I y0 = hn::Set(d, spots.clip.y0), height = hn::Set(d, spots.clip.height());
  const I to_centre = hn::Sub(hn::Set(d, kHalfPixel), hn::And(lanes.y, hn::Set(d, kSubpixels - 1)));
  for (std::int32_t j = -reach; j <= reach; ++j) {
    const I dy = hn::Add(to_centre, hn::Set(d, j * kSubpixels));
    const I from_top = hn::Sub(hn::Add(lanes.row, hn::Set(d, j)), y0);
    const Mask in_row =
        hn::And(lanes.used, hn::And(hn::Gt(from_top, none), hn::Lt(from_top, height)));
    const I bits = row.bits(hn::Sub(squared, hn::Mul(dy, dy)), in_row, j == 0, reach);
    const int k = j + reach;
    I& half = k < 4 ? upper : lower;
    half = hn::Or(half, hn::ShiftLeftSame(bits, k % 4 * WindowSpots::kWindow));
  }
  const Mask any = hn::Ne(hn::Or(upper, lower), hn::Zero(d));
  const I in_tile = hn::Set(d, kTileSize - 1), side = hn::Set(d, 2 * reach);
  const I x = hn::Sub(lanes.column, hn::Set(d, reach)), y = hn::Sub(lanes.row, hn::Set(d, reach));
  const I i0 = hn::And(x, in_tile), j0 = hn::And(y, in_tile);
  const I end = hn::Set(d, kTileSize);
  const Mask whole =
      hn::And(any, hn::And(hn::Lt(hn::Add(i0, side), end), hn::Lt(hn::Add(j0, side), end)));
  const Mask others = hn::AndNot(whole, any);
  if (!hn::AllFalse(d, others)) {
    Lanes rest = lanes;
    rest.used = others;
    append_fragments(spots, rest, reach, result);
  }
  const I left = hn::Min(i0, hn::Set(d, kTileSize - WindowSpots::kWindow));
  const I shift = hn::Sub(i0, left);
  const I tile = hn::Add(hn::Mul(hn::ShiftRight<6>(y), hn::Set(d, spots.screen.tiles_x)),
                         hn::ShiftRight<6>(x));
  const I rows = hn::Set(d, (2 * reach + 1) << 12);
  WindowSpots& to = result.spots;
  append(hn::Or(rows, hn::Or(hn::ShiftLeft<6>(j0), left)), whole, to.place.data() + to.size);
  append(hn::Shl(upper, shift), whole, to.upper.data() + to.size);
  append(hn::Shl(lower, shift), whole, to.lower.data() + to.size);
  append(lanes.code, whole, to.code.data() + to.size);
  append(lanes.number, whole, to.number.data() + to.size);
  append(tile, whole, to.tile.data() + to.size);
  to.size += hn::CountTrue(d, whole);
  return any;
}

// Returns how many spots have pixels.
//
// REQUIRES: the result has room for all pixels of the square of the largest reach around each, for
// a window of each, and for a vector of either.
std::uint32_t set_up_spots(const SpotsToSetUp& spots, SetUpResult& result) {
  const Ints d;
  std::size_t shown = 0;
  for (std::size_t place = spots.begin; place < spots.end; place += hn::Lanes(d)) {
    const Lanes lanes = load(spots, place);
    const std::int32_t reach = reach_of(hn::GetLane(hn::MaxOfLanes(d, lanes.radius)));
    const bool as_windows = 0 < reach && reach <= kWindowReach && !result.fragments_only;
    const Mask any = as_windows ? append_windows(spots, lanes, reach, result)
                                : append_fragments(spots, lanes, reach, result);
    shown += hn::CountTrue(d, any);
  }
  return static_cast<std::uint32_t>(shown);
}
static_assert(kTileSize == 1 << 6 && kTilePixels == 1 << 12);

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {
namespace {

HWY_EXPORT(find_radii);
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
  const scenes::Mesh& mesh = *draw.draw->mesh;
  SpotRadii radii;
  radii.largest = std::numeric_limits<std::int32_t>::max();
  if (splats.is_spot() && mesh_cluster.vertices == mesh_cluster.count) {
    // A vertex at each place: primitives are numbered by vertices as these are first used.
    SpotPlaces places{mesh.positions.data(), nullptr, mesh_cluster.count};
    if (mesh_cluster.consecutive()) {
      places.positions += mesh_cluster.first_in_mesh;
      transform(splats.to_view, screen, std::span(places.positions, places.count), vertices);
    } else {
      const std::span<const std::uint32_t> which = block.vertices_of(mesh_cluster);
      places.which = which.data();
      transform(splats.to_view, screen, mesh.positions, which, vertices);
    }
    HWY_DYNAMIC_DISPATCH(find_radii)(splats, screen, places, vertices, radii);
  }
  if (radii.largest > kLargestSpot) {
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
      append_splat(cluster,
                   make_splat(screen, splats, mesh, mesh_cluster.first + place,
                              cluster.first_number + place),
                   result);
    }
    return;
  }
  const std::size_t side = 2 * static_cast<std::size_t>(reach_of(radii.largest)) + 1;
  const std::size_t count = cluster.end - cluster.begin;
  reserve_fragments((count + kMostLanes) * side * side + kMostLanes, result);
  result.spots.reserve(result.spots.size + count + 2 * kMostLanes);
  const std::uint32_t shown = HWY_DYNAMIC_DISPATCH(set_up_spots)(
      {vertices, radii, screen, cluster.clip, cluster.begin, cluster.end, cluster.first_number},
      result);
  result.counts.in += count;
  result.counts.rasterized += shown;
  result.counts.culled += count - shown;
}

}  // namespace delray::raster
#endif
