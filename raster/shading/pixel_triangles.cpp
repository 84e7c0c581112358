// Sets up the homogeneous barycentrics of a cluster's triangles (Olano and Greer 1997) as planes
// over the screen, by vectors, one lane a triangle; and planes of four values from those of their
// corners.
//
// Close to a triangle's origin floats give what the higher precision of make_barycentrics does.
// Degenerate: triangles that reach farther are computed by it one by one; those with a corner
// outside are left to the caller.
#include "raster/shading/pixel_triangles.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading/pixel_triangles.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/shading/plane_lanes.h"

#ifndef DELRAY_RASTER_PIXEL_TRIANGLES
#define DELRAY_RASTER_PIXEL_TRIANGLES
namespace delray::raster {

// Up to so many subpixels from the origin the arithmetic of make_barycentrics gives the same floats
// when it is done in floats: an edge function is at most 2^23, the sum of two at most 2^24, and a
// plane's coefficients are single products of exact numbers.
inline constexpr std::int32_t kMostExact = 2048;

inline constexpr std::size_t kMostSetUpLanes = 16;

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, kMostSetUpLanes);
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

struct ScreenCorner {
  I x, y;
  F depth;
};

HWY_INLINE I amid(I a, I b, I c, int centre, int begin, int end) {
  const Ints d;
  const I low = hn::Min(hn::Min(a, b), c), high = hn::Max(hn::Max(a, b), c);
  const I middle =
      hn::Add(hn::ShiftRight<kSubpixelBits + 1>(hn::Add(low, high)), hn::Set(d, centre));
  return hn::Min(hn::Max(middle, hn::Set(d, begin)), hn::Set(d, end - 1));
}
HWY_INLINE I subpixel_of(I pixel, int centre) {
  const Ints d;
  return hn::Add(hn::ShiftLeft<kSubpixelBits>(hn::Sub(pixel, hn::Set(d, centre))),
                 hn::Set(d, kHalfPixel));
}
HWY_INLINE I largest(I a, I b, I c) { return hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Abs(c)); }

HWY_INLINE std::uint64_t bits_of(hn::Mask<Ints> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Ints(), mask, bytes);
  return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8;
}

// Facing of a vector of triangles, by lane: see ClusterFacing.
struct LaneFacing {
  std::uint64_t counter_clockwise, proper, outside;
  std::uint64_t far;  // too far from the origin for floats
};

// Stores them from number `to` on.
HWY_INLINE LaneFacing set_up_vector(const Screen& screen, const ScreenCorner (&corner)[3],
                                    TrianglePlanes& planes, std::size_t to) {
  const Floats d;
  const Ints di;
  const auto& [p, q, r] = corner;
  const geometry::Rect& whole = screen.whole;
  const I origin_x = amid(p.x, q.x, r.x, screen.centre_x, whole.x0, whole.x1);
  const I origin_y = amid(p.y, q.y, r.y, screen.centre_y, whole.y0, whole.y1);
  const I from_x = subpixel_of(origin_x, screen.centre_x);
  const I from_y = subpixel_of(origin_y, screen.centre_y);
  const I ix0 = hn::Sub(p.x, from_x), ix1 = hn::Sub(q.x, from_x), ix2 = hn::Sub(r.x, from_x);
  const I iy0 = hn::Sub(p.y, from_y), iy1 = hn::Sub(q.y, from_y), iy2 = hn::Sub(r.y, from_y);
  const I reach = hn::Max(largest(ix0, ix1, ix2), largest(iy0, iy1, iy2));
  const I out = hn::Set(di, kOutside);
  const auto outside = hn::Or(hn::Or(hn::Eq(p.x, out), hn::Eq(q.x, out)), hn::Eq(r.x, out));

  const F x0 = hn::ConvertTo(d, ix0), x1 = hn::ConvertTo(d, ix1), x2 = hn::ConvertTo(d, ix2);
  const F y0 = hn::ConvertTo(d, iy0), y1 = hn::ConvertTo(d, iy1), y2 = hn::ConvertTo(d, iy2);
  const F c0 = hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1));
  const F c1 = hn::Sub(hn::Mul(x2, y0), hn::Mul(x0, y2));
  const F c2 = hn::Sub(hn::Mul(x0, y1), hn::Mul(x1, y0));
  const F area = hn::Add(hn::Add(c0, c1), c2);
  const auto turns = hn::Lt(area, hn::Zero(d));
  // weighted_depth().
  const auto weighted = [&](F depth) HWY_ATTR {
    return screen.view.orthographic ? hn::Set(d, -1.0F) : depth;
  };
  const F depth0 = weighted(p.depth), depth1 = weighted(q.depth), depth2 = weighted(r.depth);
  const auto near = [&](F depth) HWY_ATTR { return hn::IfThenElse(turns, depth, hn::Neg(depth)); };
  const F near0 = near(depth0), near1 = near(depth1), near2 = near(depth2);
  const F subpixels = hn::Set(d, static_cast<float>(kSubpixels));
  const F step0 = hn::Mul(near0, subpixels), step1 = hn::Mul(near1, subpixels),
          step2 = hn::Mul(near2, subpixels);
  const auto store = [&](F value, float* row) HWY_ATTR { hn::StoreU(value, d, row + to); };
  store(hn::Mul(hn::Sub(y1, y2), step0), planes.a[0]);
  store(hn::Mul(hn::Sub(y2, y0), step1), planes.a[1]);
  store(hn::Mul(hn::Sub(y0, y1), step2), planes.a[2]);
  store(hn::Mul(hn::Sub(x2, x1), step0), planes.b[0]);
  store(hn::Mul(hn::Sub(x0, x2), step1), planes.b[1]);
  store(hn::Mul(hn::Sub(x1, x0), step2), planes.b[2]);
  store(hn::Mul(c0, near0), planes.c[0]);
  store(hn::Mul(c1, near1), planes.c[1]);
  store(hn::Mul(c2, near2), planes.c[2]);
  store(hn::ConvertTo(d, origin_x), planes.x);
  store(hn::ConvertTo(d, origin_y), planes.y);

  // are_proper().
  const F nearest = hn::Neg(hn::Min(hn::Min(depth0, depth1), depth2));
  const F farthest = hn::Neg(hn::Max(hn::Max(depth0, depth1), depth2));
  const F length = hn::ConvertTo(d, reach);
  const auto proper = hn::Lt(hn::Mul(nearest, hn::Mul(length, length)),
                             hn::Mul(hn::Mul(farthest, hn::Abs(area)), hn::Set(d, kMostStretched)));
  return {bits_of(hn::RebindMask(di, turns)), bits_of(hn::RebindMask(di, proper)), bits_of(outside),
          bits_of(hn::Gt(reach, hn::Set(di, kMostExact)))};
}

void set_up_planes(const Screen& screen, const ScreenVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, std::uint32_t first_vertex,
                   TrianglePlanes& planes, std::size_t first, ClusterFacing& facing) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::uint8_t, Ints> d8;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) std::int32_t rows[kClusterVertices + ScreenVertices::kPadding][4];
  for (std::size_t i = 0; i < vertex_count; i += lanes) {
    store_rows(di,
               FourVectors<I>{{hn::Load(di, vertices.x + i), hn::Load(di, vertices.y + i),
                               hn::BitCast(di, hn::Load(d, vertices.depth + i)), hn::Zero(di)}},
               [&](std::size_t k) HWY_ATTR { return rows[i + k]; });
  }
  facing = {};
  const I first_number = hn::Set(di, static_cast<std::int32_t>(first_vertex));
  for (std::size_t i = 0; i < count; i += lanes) {
    ScreenCorner corner[3];
    for (int k = 0; k < 3; ++k) {
      const std::uint8_t* const numbers = corners.of[k] + i;
      const auto vertex = load_rows(di, [&](std::size_t m) HWY_ATTR { return rows[numbers[m]]; });
      corner[k] = {vertex.v[0], vertex.v[1], hn::BitCast(d, vertex.v[2])};
      const I number = hn::Add(hn::PromoteTo(di, hn::LoadU(d8, numbers)), first_number);
      hn::StoreU(number, di, reinterpret_cast<std::int32_t*>(planes.corner[k]) + first + i);
    }
    LaneFacing lane = set_up_vector(screen, corner, planes, first + i);
    if (HWY_UNLIKELY((lane.far & ~lane.outside) != 0)) {
      for (std::size_t m = 0; m < std::min(lanes, count - i); ++m) {
        const std::uint64_t bit = std::uint64_t{1} << m;
        if ((lane.far & ~lane.outside & bit) == 0) continue;
        const Barycentrics exact = make_barycentrics(
            screen, {vertices[corners.of[0][i + m]], vertices[corners.of[1][i + m]],
                     vertices[corners.of[2][i + m]]});
        planes.set(first + i + m, exact);
        lane.counter_clockwise &= ~bit;
        lane.proper &= ~bit;
        if (exact.counter_clockwise) lane.counter_clockwise |= bit;
        if (exact.proper) lane.proper |= bit;
      }
    }
    facing.counter_clockwise[i / 64] |= lane.counter_clockwise << i % 64;
    facing.proper[i / 64] |= lane.proper << i % 64;
    facing.outside[i / 64] |= lane.outside << i % 64;
  }
}

void set_up_colours(const TrianglePlanes& planes, const glm::vec4* radiances, std::size_t count,
                    PixelTriangle* triangles) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    FourVectors<F> radiance[3];
    for (int k = 0; k < 3; ++k) {
      radiance[k] = load_rows(
          d, [&](std::size_t m) HWY_ATTR { return &radiances[planes.corner[k][i + m]].x; });
    }
    store_triangles(planes, i, radiance, triangles + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(set_up_planes);
HWY_EXPORT(set_up_colours);

void TrianglePlanes::set(std::size_t i, const Barycentrics& barycentrics) {
  for (int k = 0; k < 3; ++k) {
    a[k][i] = barycentrics.a[k];
    b[k][i] = barycentrics.b[k];
    c[k][i] = barycentrics.c[k];
  }
  x[i] = static_cast<float>(barycentrics.x);
  y[i] = static_cast<float>(barycentrics.y);
}

void set_up_planes(const Screen& screen, const ScreenVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, std::uint32_t first_vertex,
                   TrianglePlanes& planes, std::size_t first, ClusterFacing& facing) {
  HWY_DYNAMIC_DISPATCH(set_up_planes)
  (screen, vertices, vertex_count, corners, count, first_vertex, planes, first, facing);
}

void set_up_colours(const TrianglePlanes& planes, std::span<const glm::vec4> radiances,
                    std::size_t count, PixelTriangle* triangles) {
  HWY_DYNAMIC_DISPATCH(set_up_colours)(planes, radiances.data(), count, triangles);
}

}  // namespace delray::raster
#endif
