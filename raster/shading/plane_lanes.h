// Planes of values over the screen, many triangles at a time: make_value_planes for vectors.
//
// Compiled once per instruction set, so it has a guard of Highway's kind.
#if defined(DELRAY_RASTER_PLANE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RASTER_PLANE_LANES
#undef DELRAY_RASTER_PLANE_LANES
#else
#define DELRAY_RASTER_PLANE_LANES
#endif

#include "raster/shading/pixel_triangles.h"
#include "raster/shading/transpose.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The planes of four values at corners, for a vector's worth of triangles from `first` on.
template <class F, class To>
HWY_INLINE void store_planes(const TrianglePlanes& barycentrics, std::size_t first,
                             const FourVectors<F> (&values)[3], To* to) {
  const hn::DFromV<F> d;
  const auto weighted = [&](const float(&row)[3][TrianglePlanes::kSize]) HWY_ATTR {
    const F p = hn::LoadU(d, row[0] + first), q = hn::LoadU(d, row[1] + first),
            r = hn::LoadU(d, row[2] + first);
    FourVectors<F> sums;
    for (int k = 0; k < 4; ++k) {
      sums.v[k] = hn::Add(hn::Add(hn::Mul(p, values[0].v[k]), hn::Mul(q, values[1].v[k])),
                          hn::Mul(r, values[2].v[k]));
    }
    return sums;
  };
  store_rows(d, weighted(barycentrics.a), [&](std::size_t m) HWY_ATTR { return to[m].a; });
  store_rows(d, weighted(barycentrics.b), [&](std::size_t m) HWY_ATTR { return to[m].b; });
  store_rows(d, weighted(barycentrics.c), [&](std::size_t m) HWY_ATTR { return to[m].c; });
}

// Stores planes with the pixel that they are relative to.
template <class F>
HWY_INLINE void store_triangles(const TrianglePlanes& barycentrics, std::size_t first,
                                const FourVectors<F> (&values)[3], PixelTriangle* to) {
  const hn::DFromV<F> d;
  store_planes(barycentrics, first, values, to);
  store_rows(d,
             FourVectors<F>{{hn::LoadU(d, barycentrics.x + first),
                             hn::LoadU(d, barycentrics.y + first), hn::Zero(d), hn::Zero(d)}},
             [&](std::size_t m) HWY_ATTR { return &to[m].x; });
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#endif
