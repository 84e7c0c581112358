// Rasterizes triangles into a tile of keys, depth above primitive number, of which the least stays:
// edge functions (Pineda 1988) over vectors of pixels, with the farthest depth of each block to
// reject early (Greene et al. 1993).
//
// As the key orders ties too, the order of triangles makes no difference. Large triangles go block
// by block: outside, inside or tested; smaller ones row by row in their box or window. Farthest
// depths are refreshed after large triangles, and after some dozens of small ones. O(pixels of the
// boxes).
//
// Degenerate: triangles without area cover nothing; fragments behind a pixel's key change nothing.
#include "raster/pipeline/visibility.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/visibility.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, VisibilityTile::kBlockWidth);
using Ints = hn::RebindToSigned<Floats>;
using Codes = hn::RebindToUnsigned<Floats>;
#if HWY_TARGET == HWY_SCALAR
using KeyCodes = Codes;
#else
using KeyCodes = hn::Half<Codes>;  // a vector of codes fills two of keys
#endif
using Keys = hn::Rebind<std::int64_t, KeyCodes>;

// Refreshing costs as much as drawing a few small triangles.
constexpr int kRefreshAfter = 64;

// How the three edge functions of a triangle are known inside a rectangle.
enum class Inside : bool { tested, certain };

// The lesser of the keys in memory and those of `codes` and `number` stays.
HWY_INLINE void keep_least_of_half(hn::Vec<KeyCodes> codes, hn::Vec<Keys> number,
                                   std::int64_t* keys) {
  const Keys d;
  const hn::RebindToUnsigned<Keys> du;
  const auto depth = hn::BitCast(d, hn::ShiftLeft<32>(hn::PromoteTo(du, codes)));
  hn::Store(hn::Min(hn::Load(d, keys), hn::Or(depth, number)), d, keys);
}
HWY_INLINE void keep_least(hn::Vec<Codes> codes, hn::Vec<Keys> number, std::int64_t* keys) {
#if HWY_TARGET == HWY_SCALAR
  keep_least_of_half(codes, number, keys);
#else
  const KeyCodes d;
  keep_least_of_half(hn::LowerHalf(d, codes), number, keys);
  keep_least_of_half(hn::UpperHalf(d, codes), number, keys + hn::Lanes(d));
#endif
}

// Pixels [i0, i1) x [j0, j1) of the tile; i0 and i1 are multiples of the vector's length.
template <Inside inside>
void draw(const TileTriangle& t, std::uint32_t number, int i0, int i1, int j0, int j1,
          VisibilityTile& tile) {
  const Floats d;
  const Ints di;
  const Codes du;
  const Keys dk;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto slope_x = hn::Set(d, t.slope_x);
  const auto depth = hn::Set(d, t.depth);
  const auto nearest = hn::Set(d, t.nearest);
  const auto farthest = hn::Set(d, t.farthest);
  const auto numbers = hn::Set(dk, std::int64_t{number});
  const auto behind_all = hn::Set(du, 0x7FFFFFFFU);
  for (int i = i0; i < i1; i += lanes) {
    // Iota of a constant: of a variable, lanes would be filled one by one.
    const auto column = hn::Add(hn::Iota(di, 0), hn::Set(di, i));
    const auto x = hn::Mul(slope_x, hn::Add(hn::Set(d, t.x), hn::ConvertTo(d, column)));
    const auto edge0 = hn::Mul(hn::Set(di, t.a[0]), column);
    const auto edge1 = hn::Mul(hn::Set(di, t.a[1]), column);
    const auto edge2 = hn::Mul(hn::Set(di, t.a[2]), column);
    for (int j = j0; j < j1; ++j) {
      const auto y = hn::Set(d, t.slope_y * (t.y + static_cast<float>(j)));
      const auto plane = hn::Add(hn::Add(x, y), depth);
      const auto z = hn::Min(hn::Max(plane, nearest), farthest);
      auto code = hn::Not(hn::BitCast(du, z));
      if constexpr (inside == Inside::tested) {
        const auto value0 = hn::Add(edge0, hn::Set(di, t.b[0] * j + t.c[0]));
        const auto value1 = hn::Add(edge1, hn::Set(di, t.b[1] * j + t.c[1]));
        const auto value2 = hn::Add(edge2, hn::Set(di, t.b[2] * j + t.c[2]));
        const auto all = hn::Or(hn::Or(value0, value1), value2);
        const auto covered = hn::Gt(all, hn::Set(di, -1));
        if (hn::AllFalse(di, covered)) continue;
        code = hn::IfThenElse(hn::RebindMask(du, covered), code, behind_all);
      }
      keep_least(code, numbers, tile.key + j * kTileSize + i);
    }
  }
}

void refresh(int block, VisibilityTile& tile) {
  const Keys d;
  const std::int64_t* const keys = tile.key + VisibilityTile::first_pixel(block);
  auto farthest = hn::Zero(d);
  for (int j = 0; j < VisibilityTile::kBlockHeight; ++j) {
    for (int i = 0; i < VisibilityTile::kBlockWidth; i += static_cast<int>(hn::Lanes(d)))
      farthest = hn::Max(farthest, hn::Load(d, keys + j * kTileSize + i));
  }
  HWY_ALIGN std::int64_t lanes[16];
  hn::Store(farthest, d, lanes);
  std::int64_t key = 0;
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) key = std::max(key, lanes[k]);
  tile.set_farthest(block, static_cast<std::int32_t>(key >> 32));
}

void refresh_if_due(VisibilityTile& tile) {
  if (tile.since_refresh < kRefreshAfter) return;
  tile.since_refresh = 0;
  for (int block = 0; block < VisibilityTile::kBlocks; ++block)
    if (tile.stale >> block & 1) refresh(block, tile);
  tile.stale = 0;
}

// A triangle that spans many blocks, one block after the other.
void draw_blocks(const TileTriangle& t, std::uint32_t number, int bx0, int bx1, int by0, int by1,
                 VisibilityTile& tile) {
  constexpr int kRight = VisibilityTile::kBlockWidth - 1;
  constexpr int kDown = VisibilityTile::kBlockHeight - 1;
  for (int by = by0; by <= by1; ++by) {
    for (int bx = bx0; bx <= bx1; ++bx) {
      const int block = by * VisibilityTile::kBlocksX + bx;
      const int i = bx * VisibilityTile::kBlockWidth;
      const int j = by * VisibilityTile::kBlockHeight;
      bool outside = false, certain = true;
      for (int k = 0; k < 3; ++k) {
        const std::int32_t corner = t.a[k] * i + t.b[k] * j + t.c[k];
        const std::int32_t x = t.a[k] * kRight, y = t.b[k] * kDown;
        outside |= corner + std::max(x, 0) + std::max(y, 0) < 0;
        certain &= corner + std::min(x, 0) + std::min(y, 0) >= 0;
      }
      if (outside) continue;
      // Every step of the plane's evaluation is monotone, rounding included: the corner where both
      // slopes are least is a lower bound of the block's depths, exactly.
      const float nearest =
          depth_at(t, t.slope_x < 0 ? i + kRight : i, t.slope_y < 0 ? j + kDown : j);
      if (code_of_depth(nearest) > tile.farthest[block]) continue;
      const int i1 = i + VisibilityTile::kBlockWidth;
      const int j1 = j + VisibilityTile::kBlockHeight;
      if (certain)
        draw<Inside::certain>(t, number, i, i1, j, j1, tile);
      else
        draw<Inside::tested>(t, number, i, i1, j, j1, tile);
      refresh(block, tile);
      tile.stale &= ~(1U << block);
    }
  }
}

void rasterize(const Screen& screen, const geometry::Rect& rect,
               std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
               VisibilityTile& tile) {
  constexpr int kBlockWidth = VisibilityTile::kBlockWidth;
  constexpr int kBlockHeight = VisibilityTile::kBlockHeight;
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  // The farthest of the whole tile, an upper bound: depths only come nearer.
  const auto farthest_of_all = [&] {
    return *std::max_element(tile.farthest, tile.farthest + VisibilityTile::kBlocks);
  };
  std::int32_t farthest = farthest_of_all();
  for (const std::uint32_t entry : entries) {
    if (entry & kMasked) continue;
    const ScreenTriangle& triangle = triangles[entry];
    const ScreenVertex* v = triangle.vertex;
    const std::int32_t nearest = code_of_depth(std::min({v[0].depth, v[1].depth, v[2].depth}));
    if (nearest > farthest) continue;
    const geometry::Rect pixels =
        geometry::intersection(centres_in_box(v[0], v[1], v[2], screen), rect);
    if (pixels.empty()) continue;
    const int i0 = pixels.x0 - tile_x, i1 = pixels.x1 - tile_x;
    const int j0 = pixels.y0 - tile_y, j1 = pixels.y1 - tile_y;
    const int bx0 = i0 / kBlockWidth, bx1 = (i1 - 1) / kBlockWidth;
    const int by0 = j0 / kBlockHeight, by1 = (j1 - 1) / kBlockHeight;

    std::uint32_t touched = 0;
    bool hidden = true;
    for (int by = by0; by <= by1; ++by) {
      for (int bx = bx0; bx <= bx1; ++bx) {
        const int block = by * VisibilityTile::kBlocksX + bx;
        touched |= 1U << block;
        hidden &= nearest > tile.farthest[block];
      }
    }
    if (hidden) continue;
    TileTriangle t;
    if (!make_tile_triangle(triangle, screen, tile_x, tile_y, t)) continue;
    if (bx1 - bx0 > 1 || by1 - by0 > 1) {
      draw_blocks(t, triangle.number, bx0, bx1, by0, by1, tile);
      farthest = farthest_of_all();
      continue;
    }
    draw<Inside::tested>(t, triangle.number, i0 / lanes * lanes, (i1 + lanes - 1) / lanes * lanes,
                         j0, j1, tile);
    tile.came_nearer(touched);
    ++tile.since_refresh;
    refresh_if_due(tile);
  }
}

void rasterize_fragments(std::span<const Fragment> fragments, VisibilityTile& tile) {
  std::uint32_t touched = 0;
  for (const Fragment& fragment : fragments) {
    std::int64_t& key = tile.key[fragment.pixel];
    key = std::min(key, fragment.key);
    const std::uint32_t block_x = fragment.pixel % kTileSize / VisibilityTile::kBlockWidth;
    const std::uint32_t block_y = fragment.pixel / kTileSize / VisibilityTile::kBlockHeight;
    touched |= 1U << (block_y * VisibilityTile::kBlocksX + block_x);
  }
  tile.came_nearer(touched);
  tile.since_refresh += static_cast<int>(fragments.size());
  refresh_if_due(tile);
}

static_assert(WindowTriangles::kMostRows <= 2 * VisibilityTile::kBlockHeight);

// The lesser of the keys in memory and those of `codes` and `number` stays.
template <class V>
HWY_INLINE void keep_least_of_window(V codes, std::uint32_t number, std::int64_t* keys) {
  const hn::DFromV<V> d;
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(hn::DFromV<V>()) > WindowTriangles::kWindowWidth) {
    const hn::Half<decltype(d)> half;
    keep_least_of_window(hn::LowerHalf(half, codes), number, keys);
    keep_least_of_window(hn::UpperHalf(half, codes), number, keys + hn::Lanes(half));
    return;
  } else
#endif
  {
    const hn::Rebind<std::int64_t, decltype(d)> dk;
    const hn::RebindToUnsigned<decltype(dk)> duk;
    const auto upper = hn::BitCast(dk, hn::ShiftLeft<32>(hn::PromoteTo(duk, codes)));
    const auto mine = hn::Or(upper, hn::Set(dk, std::int64_t{number}));
    hn::Store(hn::Min(hn::Load(dk, keys), mine), dk, keys);
  }
}

// Columns [i, i + lanes) of a window, a vector's worth, that starts at `keys`.
template <class D>
HWY_INLINE void draw_window(D d, const WindowTriangles& triangles, std::uint32_t k, int i, int rows,
                            std::int64_t* keys) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  const WindowTriangles::Edges& edges = triangles.edges[k];
  const WindowTriangles::Columns& columns = triangles.columns[k];
  const WindowTriangles::Rows& down = triangles.rows[k];
  const WindowTriangles::Plane& plane = triangles.planes[k];
  const WindowTriangles::Depths& depths = triangles.depths[k];
  const auto column = hn::Add(hn::Iota(di, 0), hn::Set(di, i));
  const auto edge = [&](int e) HWY_ATTR {
    return hn::Add(hn::Set(di, edges.value[e]), hn::Mul(hn::Set(di, columns.step[e]), column));
  };
  auto value0 = edge(0), value1 = edge(1), value2 = edge(2);
  const auto down0 = hn::Set(di, down.step[0]), down1 = hn::Set(di, down.step[1]),
             down2 = hn::Set(di, down.step[2]);
  const auto x =
      hn::Mul(hn::Set(d, plane.slope_x), hn::Add(hn::Set(d, plane.x), hn::ConvertTo(d, column)));
  const auto depth = hn::Set(d, depths.depth);
  const auto nearest = hn::Set(d, depths.nearest), farthest = hn::Set(d, depths.farthest);
  const auto behind_all = hn::Set(du, 0x7FFFFFFFU);
  float row = plane.y;
  const auto next_row = [&]() HWY_ATTR {
    const auto y = hn::Set(d, plane.slope_y * row);
    const auto z = hn::Min(hn::Max(hn::Add(hn::Add(x, y), depth), nearest), farthest);
    const auto covered = hn::Gt(hn::Or(hn::Or(value0, value1), value2), hn::Set(di, -1));
    const auto code =
        hn::IfThenElse(hn::RebindMask(du, covered), hn::Not(hn::BitCast(du, z)), behind_all);
    keep_least_of_window(code, columns.number, keys);
    value0 = hn::Add(value0, down0);
    value1 = hn::Add(value1, down1);
    value2 = hn::Add(value2, down2);
    row += 1.0F;  // exact
    keys += kTileSize;
  };
  static_assert(WindowTriangles::kRowsAtOnce == 4);
  for (; rows > 0; rows -= 4) {
    next_row();
    next_row();
    next_row();
    next_row();
  }
}

void rasterize_windows(const WindowTriangles& triangles, std::span<const std::uint32_t> which,
                       VisibilityTile& tile) {
  using Window = HWY_CAPPED(std::int64_t, WindowTriangles::kWindowWidth);
  const hn::Rebind<float, Window> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (const std::uint32_t k : which) {
    const WindowTriangles::Edges& edges = triangles.edges[k];
    const int i0 = static_cast<int>(edges.window & 63),
              j0 = static_cast<int>(edges.window >> 6 & 63);
    const int above = static_cast<int>(edges.window >> 12 & 3);
    const int below = static_cast<int>(edges.window >> 14 & 3);
    const int rows = static_cast<int>(edges.window >> 16 & 15) * WindowTriangles::kRowsAtOnce;
    const int width = static_cast<int>(edges.window >> 20) * WindowTriangles::kWindowWidth;
    const std::uint32_t touched = blocks_touched(i0, i0 + width, j0 + above, j0 + rows - below);
    const std::int32_t nearest_code = code_of_depth(triangles.depths[k].nearest);
    bool hidden = true;
    for (std::uint32_t rest = touched; rest != 0; rest &= rest - 1)
      hidden &= nearest_code > tile.farthest[std::countr_zero(rest)];
    if (hidden) continue;

    std::int64_t* const keys = tile.key + j0 * kTileSize + i0;
    int i = 0;
#if HWY_TARGET <= HWY_AVX3
    const HWY_CAPPED(float, 2 * WindowTriangles::kWindowWidth) d2;
    if (width > WindowTriangles::kWindowWidth) {
      draw_window(d2, triangles, k, 0, rows, keys);
      i = 2 * WindowTriangles::kWindowWidth;
    }
#endif
    for (; i < width; i += lanes) draw_window(d, triangles, k, i, rows, keys + i);
    tile.came_nearer(touched);
    ++tile.since_refresh;
    refresh_if_due(tile);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(rasterize);
HWY_EXPORT(rasterize_fragments);
HWY_EXPORT(rasterize_windows);
HWY_EXPORT(refresh_if_due);

void VisibilityTile::clear(const geometry::Rect& rect) {
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int i1 = i0 + rect.width(), j1 = j0 + rect.height();
  if (rect.area() == kTilePixels) {
    std::fill_n(key, kTilePixels, kEmptyKey);
  } else {
    std::fill_n(key, kTilePixels, std::int64_t{0});
    for (int j = j0; j < j1; ++j)
      std::fill(key + j * kTileSize + i0, key + j * kTileSize + i1, kEmptyKey);
  }
  for (int block = 0; block < kBlocks; ++block) set_farthest(block, kEmptyCode);
  stale = changed = 0;
  since_refresh = 0;
}

std::int32_t VisibilityTile::farthest_now(int block) const {
  if ((stale >> block & 1) == 0) return farthest_of(block);
  const std::int64_t* keys = key + first_pixel(block);
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  for (int j = 0; j < kBlockHeight; ++j, keys += kTileSize)
    last = std::max(last, *std::max_element(keys, keys + kBlockWidth));
  return static_cast<std::int32_t>(last >> 32);
}

void rasterize(const Screen& screen, const geometry::Rect& rect,
               std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
               VisibilityTile& tile) {
  HWY_DYNAMIC_DISPATCH(rasterize)(screen, rect, triangles, entries, tile);
}

void rasterize_fragments(std::span<const Fragment> fragments, VisibilityTile& tile) {
  HWY_DYNAMIC_DISPATCH(rasterize_fragments)(fragments, tile);
}

void rasterize_windows(const WindowTriangles& triangles, std::span<const std::uint32_t> which,
                       VisibilityTile& tile) {
  HWY_DYNAMIC_DISPATCH(rasterize_windows)(triangles, which, tile);
}

void note_drawn(std::uint32_t blocks, std::size_t count, VisibilityTile& tile) {
  tile.came_nearer(blocks);
  tile.since_refresh += static_cast<int>(count);
  HWY_DYNAMIC_DISPATCH(refresh_if_due)(tile);
}

void rasterize_masked(const Screen& screen, const geometry::Rect& rect,
                      std::span<const ScreenTriangle> triangles,
                      std::span<const std::uint32_t> entries,
                      parallel::FunctionRef<bool(std::uint32_t, int, int)> alpha_test,
                      VisibilityTile& tile) {
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  for (const std::uint32_t entry : entries) {
    if (!(entry & kMasked)) continue;
    const ScreenTriangle& triangle = triangles[entry & kIndex];
    for_each_covered(screen, rect, triangle, [&](int i, int j, std::int64_t key) {
      std::int64_t& old = tile.key[j * kTileSize + i];
      if (key < old && alpha_test(triangle.number, tile_x + i, tile_y + j)) old = key;
    });
  }
}

std::uint64_t draw_and_shade(const Screen& screen, const geometry::Rect& rect,
                             std::span<const ScreenTriangle> triangles,
                             std::span<const std::uint32_t> entries,
                             parallel::FunctionRef<bool(std::uint32_t, int, int)> alpha_test,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile) {
  std::uint64_t shaded = 0;
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  for (const std::uint32_t entry : entries) {
    const ScreenTriangle& triangle = triangles[entry & kIndex];
    for_each_covered(screen, rect, triangle, [&](int i, int j, std::int64_t key) {
      std::int64_t& old = tile.key[j * kTileSize + i];
      if (key >= old) return;
      if ((entry & kMasked) != 0 && !alpha_test(triangle.number, tile_x + i, tile_y + j)) return;
      old = key;
      ++shaded;
      shade(triangle.number, tile_x + i, tile_y + j);
    });
  }
  return shaded;
}

std::uint64_t draw_and_shade(std::span<const Fragment> fragments, const geometry::Rect& rect,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile) {
  std::uint64_t shaded = 0;
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  for (const Fragment& fragment : fragments) {
    std::int64_t& old = tile.key[fragment.pixel];
    if (fragment.key >= old) continue;
    old = fragment.key;
    ++shaded;
    shade(number_of(old), tile_x + static_cast<int>(fragment.pixel % kTileSize),
          tile_y + static_cast<int>(fragment.pixel / kTileSize));
  }
  return shaded;
}

}  // namespace delray::raster
#endif
