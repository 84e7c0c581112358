// Collects the surfaces that a tile shows as fragments, packs them into messages, and merges what
// several ranks saw: the nearest by depth and primitive, or all of them sorted by position and
// blended.
//
// Degenerate: samples at which nobody saw anything become empty; a message may have no tile.
#include "raster/distribute/tile_fragments.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "composite/deep.h"
#include "raster/pipeline/screen.h"

namespace delray::raster {
namespace {

struct TileHeader {
  std::uint32_t tile = 0, fragments = 0;
};

// Bytes of so many positions in a message: what follows is aligned.
std::size_t bytes_of_positions(std::size_t fragments) {
  return (fragments * sizeof(std::uint16_t) + 3) / 4 * 4;
}

std::uint16_t position_of(int x, int y) {
  return static_cast<std::uint16_t>(y % kTileSize * kTileSize + x % kTileSize);
}

template <class Payload>
composite::DeepFragment<Payload> fragment_of(const Payload& payload, float depth,
                                             std::uint64_t primitive) {
  return {payload, depth, static_cast<std::uint32_t>(primitive),
          static_cast<std::uint32_t>(primitive >> 32)};
}

// Where a position of the tile that `rect` lies in is in the window.
template <class Colour>
std::size_t at(const Window<Colour>& window, const geometry::Rect& rect, std::uint32_t position) {
  return window.at(rect.x0 / kTileSize * kTileSize + static_cast<int>(position % kTileSize),
                   rect.y0 / kTileSize * kTileSize + static_cast<int>(position / kTileSize));
}

bool is_in(std::span<const PrimitiveRange> ranges, std::uint64_t primitive) {
  const auto after = std::upper_bound(
      ranges.begin(), ranges.end(), primitive,
      [](std::uint64_t p, const PrimitiveRange& range) { return p < range.begin; });
  return after != ranges.begin() && primitive < std::prev(after)->end;
}

// The tile without what `rect` shows of such primitives; null where that is nothing. Valid until
// the thread's next call.
const VisibilityTile* without(const TileView& tile, const geometry::Rect& rect,
                              std::span<const PrimitiveRange> ranges) {
  static thread_local VisibilityTile rest;
  bool any = false;
  std::uint32_t last = kNothing;
  bool drops = false;  // the last
  for (int y = rect.y0; y < rect.y1 && !ranges.empty(); ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::uint32_t number = tile.opaque_number(x, y);
      if (number == kNothing) continue;
      if (number != last) {
        last = number;
        drops = is_in(ranges, tile.frame().list.primitive_of(number));
      }
      if (!drops) continue;
      if (!any) std::copy_n(tile.opaque()->key, kTilePixels, rest.key);
      any = true;
      rest.key[position_of(x, y)] = kEmptyKey;
    }
  }
  return any ? &rest : nullptr;
}

// By position of a tile; null where nothing is seen.
template <class Colour>
using NearestOfTile = std::array<const composite::DeepFragment<Colour>*, kTilePixels>;

// Valid until the thread's next call.
template <class Colour>
const NearestOfTile<Colour>& find_nearest(std::span<const TileSpan<Colour>> seen) {
  static thread_local NearestOfTile<Colour> nearest;
  nearest.fill(nullptr);
  for (const TileSpan<Colour>& span : seen) {
    for (std::size_t i = 0; i < span.fragments.size(); ++i) {
      const auto*& best = nearest[span.positions[i]];
      if (best == nullptr || composite::in_front(span.fragments[i], *best))
        best = &span.fragments[i];
    }
  }
  return nearest;
}

}  // namespace

void append_surfaces(TileView& tile, const geometry::Rect& rect,
                     std::span<const PrimitiveRange> passed_over,
                     TileFragments<image::RgbaF>& seen) {
  tile.for_each_surface(rect, [&](int x, int y, std::span<const SurfaceSeen> surfaces) {
    for (const SurfaceSeen& surface : surfaces) {
      const std::uint64_t primitive = tile.frame().list.primitive_of(number_of(surface.key));
      if (surface.colour.a <= 0 || is_in(passed_over, primitive)) continue;
      seen.positions.push_back(position_of(x, y));
      seen.fragments.push_back(fragment_of(surface.colour, depth_of(surface.key), primitive));
    }
  });
}

template <class Colour>
void append_opaque(TileView& tile, const geometry::Rect& rect,
                   std::span<const PrimitiveRange> passed_over, TileFragments<Colour>& seen) {
  if (tile.empty()) return;
  // Surfaces that are passed over need not be shaded.
  if (const VisibilityTile* const rest = without(tile, rect, passed_over)) {
    TileView part = tile.of_part(*rest);
    append_opaque(part, rect, {}, seen);
    tile.count(part);
    return;
  }
  const DrawList& list = tile.frame().list;
  const Window<Colour> window = tile_window<Colour>(rect);
  tile.shade(rect, window);
  const std::size_t most = seen.fragments.size() + static_cast<std::size_t>(rect.area());
  seen.positions.reserve(most);
  seen.fragments.reserve(most);
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::uint32_t number = tile.opaque_number(x, y);
      if (number == kNothing) continue;
      const std::size_t i = window.at(x, y);
      seen.positions.push_back(position_of(x, y));
      seen.fragments.push_back(
          fragment_of(window.colour[i], window.depth[i], list.primitive_of(number)));
    }
  }
}

template <class Payload>
comm::Buffer pack_tiles(std::span<const TileSpan<Payload>> tiles) {
  std::size_t bytes = 0;
  for (const TileSpan<Payload>& tile : tiles) {
    bytes += sizeof(TileHeader) + tile.fragments.size_bytes() +
             bytes_of_positions(tile.positions.size());
  }
  comm::Buffer message(bytes);
  std::byte* to = message.data();
  const auto append = [&](const void* from, std::size_t size) {
    if (size > 0) std::memcpy(to, from, size);  // of nothing the address may be null
    to += size;
  };
  for (const TileSpan<Payload>& tile : tiles) {
    const TileHeader header{static_cast<std::uint32_t>(tile.tile),
                            static_cast<std::uint32_t>(tile.fragments.size())};
    append(&header, sizeof header);
    append(tile.fragments.data(), tile.fragments.size_bytes());
    append(tile.positions.data(), tile.positions.size_bytes());
    constexpr std::uint16_t kPadding = 0;
    if (tile.positions.size() % 2 != 0) append(&kPadding, sizeof kPadding);
  }
  return message;
}

template <class Payload>
std::vector<TileSpan<Payload>> unpack_tiles(const comm::Buffer& message) {
  using Seen = composite::DeepFragment<Payload>;
  std::vector<TileSpan<Payload>> tiles;
  for (const std::byte *from = message.data(), *end = from + message.size(); from != end;) {
    const auto* const header = reinterpret_cast<const TileHeader*>(from);
    const std::size_t count = header->fragments;
    from += sizeof(TileHeader);
    const auto* const fragments = reinterpret_cast<const Seen*>(from);
    from += count * sizeof(Seen);
    const auto* const positions = reinterpret_cast<const std::uint16_t*>(from);
    from += bytes_of_positions(count);
    tiles.push_back({static_cast<int>(header->tile), {positions, count}, {fragments, count}});
  }
  return tiles;
}

template <class Colour>
void keep_nearest(std::span<const TileSpan<Colour>> seen, const geometry::Rect& rect,
                  const Window<Colour>& window) {
  const NearestOfTile<Colour>& nearest = find_nearest(seen);
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const auto* const best = nearest[position_of(x, y)];
      const std::size_t i = window.at(x, y);
      window.colour[i] = best == nullptr ? Colour{} : best->payload;
      window.depth[i] = best == nullptr ? image::kEmptyDepth : best->depth;
    }
  }
}

template <class Colour>
void merge_nearest(std::span<const TileSpan<Colour>> arrived, const geometry::Rect& rect,
                   const DrawList& list, std::span<const std::uint32_t> numbers,
                   const Window<Colour>& window) {
  const NearestOfTile<Colour>& nearest = find_nearest(arrived);
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const auto* const best = nearest[position_of(x, y)];
      if (best == nullptr) continue;
      const std::size_t i = window.at(x, y);
      const std::uint32_t own = numbers[position_of(x, y)];
      if (own != kNothing) {
        if (window.depth[i] < best->depth) continue;
        if (window.depth[i] == best->depth &&
            !composite::in_front(*best,
                                 fragment_of(best->payload, best->depth, list.primitive_of(own))))
          continue;
      }
      window.colour[i] = best->payload;
      window.depth[i] = best->depth;
    }
  }
}

template <class Colour>
void blend_surfaces(std::span<const TileSpan<image::RgbaF>> seen, const geometry::Rect& rect,
                    const Window<Colour>& window) {
  clear_pixels(rect, window);
  struct Placed {
    std::uint16_t position;
    const composite::Fragment* fragment;
  };
  static thread_local std::vector<Placed> placed;
  static thread_local std::vector<composite::Fragment> fragments;
  placed.clear();
  for (const TileSpan<image::RgbaF>& span : seen) {
    for (std::size_t i = 0; i < span.fragments.size(); ++i)
      placed.push_back({span.positions[i], &span.fragments[i]});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.position != b.position ? a.position < b.position
                                    : composite::in_front(*a.fragment, *b.fragment);
  });
  for (auto next = placed.begin(); next != placed.end();) {
    const std::uint16_t position = next->position;
    fragments.clear();
    for (; next != placed.end() && next->position == position; ++next) {
      if (fragments.empty() || !composite::is_opaque(fragments.back().payload))
        fragments.push_back(*next->fragment);
    }
    const std::size_t i = at(window, rect, position);
    window.depth[i] = fragments.front().depth;
    composite::store(composite::blend(fragments), window.colour[i]);
  }
}

template void append_opaque(TileView&, const geometry::Rect&, std::span<const PrimitiveRange>,
                            TileFragments<image::Rgba8>&);
template void append_opaque(TileView&, const geometry::Rect&, std::span<const PrimitiveRange>,
                            TileFragments<image::RgbaF>&);
template comm::Buffer pack_tiles(std::span<const TileSpan<image::Rgba8>>);
template comm::Buffer pack_tiles(std::span<const TileSpan<image::RgbaF>>);
template std::vector<TileSpan<image::Rgba8>> unpack_tiles(const comm::Buffer&);
template std::vector<TileSpan<image::RgbaF>> unpack_tiles(const comm::Buffer&);
template void keep_nearest(std::span<const TileSpan<image::Rgba8>>, const geometry::Rect&,
                           const Window<image::Rgba8>&);
template void keep_nearest(std::span<const TileSpan<image::RgbaF>>, const geometry::Rect&,
                           const Window<image::RgbaF>&);
template void merge_nearest(std::span<const TileSpan<image::Rgba8>>, const geometry::Rect&,
                            const DrawList&, std::span<const std::uint32_t>,
                            const Window<image::Rgba8>&);
template void merge_nearest(std::span<const TileSpan<image::RgbaF>>, const geometry::Rect&,
                            const DrawList&, std::span<const std::uint32_t>,
                            const Window<image::RgbaF>&);
template void blend_surfaces(std::span<const TileSpan<image::RgbaF>>, const geometry::Rect&,
                             const Window<image::Rgba8>&);
template void blend_surfaces(std::span<const TileSpan<image::RgbaF>>, const geometry::Rect&,
                             const Window<image::RgbaF>&);

}  // namespace delray::raster
