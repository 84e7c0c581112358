// Packs a rank's regions, tile by tile, colours before depths, into one message for rank 0, which
// copies them to their places. Last comes a byte for each tile: whether it is there. Degenerate: a
// rank without pixels sends nothing.
#include "raster/distribute/gather_regions.h"

#include <algorithm>
#include <cstring>

#include "comm/bad_message.h"
#include "loadbalance/deliver.h"
#include "raster/shading/shade_tile.h"

namespace delray::raster {
namespace {

constexpr comm::Tag kTagRegions = 80;

// Calls f(rect, tile) for the parts of tiles in the regions of `owner`, in the order of the
// partition.
template <class F>
void for_each_part(const loadbalance::Partition& partition, int owner, const ImageTiles& tiles,
                   F&& f) {
  for (const loadbalance::Region& region : partition.regions) {
    if (region.owner != owner || region.rect.empty()) continue;
    const geometry::Rect& rect = region.rect;
    for (int y = rect.y0 / tiles.side; y * tiles.side < rect.y1; ++y) {
      for (int x = rect.x0 / tiles.side; x * tiles.side < rect.x1; ++x) {
        const geometry::Rect tile{x * tiles.side, y * tiles.side, (x + 1) * tiles.side,
                                  (y + 1) * tiles.side};
        f(geometry::intersection(rect, tile),
          static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.columns) +
              static_cast<std::size_t>(x));
      }
    }
  }
}

// Calls f(first pixel, count) for each row of a rectangle.
template <class F>
void for_each_row(const geometry::Rect& rect, int image_width, F&& f) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    f(static_cast<std::size_t>(y) * static_cast<std::size_t>(image_width) +
          static_cast<std::size_t>(rect.x0),
      static_cast<std::size_t>(rect.width()));
  }
}

template <class Colour>
bool is_empty(const image::BasicImage<Colour>& image, const geometry::Rect& rect) {
  bool empty = true;
  for_each_row(rect, image.width, [&](std::size_t pixel, std::size_t count) {
    const float* const depth = image.depth.data() + pixel;
    empty =
        empty && std::all_of(depth, depth + count, [](float d) { return d == image::kEmptyDepth; });
  });
  return empty;
}

// A message of some pixels and what is known of some parts; Byte is const to read it.
template <class Colour, class Byte>
struct Pieces {
  Pieces(Byte* message, std::size_t pixels)
      : colour(message),
        depth(colour + pixels * sizeof(Colour)),
        there(depth + pixels * sizeof(float)) {}
  Byte *colour, *depth, *there;
};
template <class Colour>
constexpr std::size_t kPixelBytes = sizeof(Colour) + sizeof(float);

template <class Colour>
comm::Buffer packed(const loadbalance::Partition& partition, int owner, const ImageTiles& tiles,
                    const image::BasicImage<Colour>& image) {
  std::vector<std::uint8_t> there;
  std::size_t pixels = 0;
  for_each_part(partition, owner, tiles, [&](const geometry::Rect& rect, std::size_t tile) {
    const bool empty = tiles.empty.empty() ? is_empty(image, rect) : tiles.empty[tile] != 0;
    there.push_back(empty ? 0 : 1);
    if (there.back() != 0) pixels += static_cast<std::size_t>(rect.area());
  });
  comm::Buffer message(pixels * kPixelBytes<Colour> + there.size());
  if (there.empty()) return message;
  Pieces<Colour, std::byte> to(message.data(), pixels);
  std::memcpy(to.there, there.data(), there.size());
  const std::uint8_t* next = there.data();
  for_each_part(partition, owner, tiles, [&](const geometry::Rect& rect, std::size_t) {
    if (*next++ == 0) return;
    for_each_row(rect, image.width, [&](std::size_t pixel, std::size_t count) {
      std::memcpy(to.colour, image.colour.data() + pixel, count * sizeof(Colour));
      std::memcpy(to.depth, image.depth.data() + pixel, count * sizeof(float));
      to.colour += count * sizeof(Colour);
      to.depth += count * sizeof(float);
    });
  });
  return message;
}

template <class Colour>
void unpack(const comm::Buffer& message, const loadbalance::Partition& partition, int owner,
            const ImageTiles& tiles, image::BasicImage<Colour>& image) {
  std::size_t parts = 0;
  for_each_part(partition, owner, tiles, [&](const geometry::Rect&, std::size_t) { ++parts; });
  comm::check_message(message.size() >= parts);
  const std::byte* there = message.data() + message.size() - parts;
  std::size_t pixels = 0;
  for_each_part(partition, owner, tiles, [&](const geometry::Rect& rect, std::size_t) {
    if (*there++ != std::byte{0}) pixels += static_cast<std::size_t>(rect.area());
  });
  comm::check_message(message.size() == pixels * kPixelBytes<Colour> + parts);
  Pieces<Colour, const std::byte> from(message.data(), pixels);
  for_each_part(partition, owner, tiles, [&](const geometry::Rect& rect, std::size_t tile) {
    const bool is_there = *from.there++ != std::byte{0};
    if (!is_there && !tiles.clear.empty() && tiles.clear[tile] != 0) return;
    if (!tiles.clear.empty()) {
      const bool whole = rect.x0 % tiles.side == 0 && rect.y0 % tiles.side == 0 &&
                         rect.width() == std::min(tiles.side, image.width - rect.x0) &&
                         rect.height() == std::min(tiles.side, image.height - rect.y0);
      tiles.clear[tile] = !is_there && whole ? 1 : 0;
    }
    if (!is_there) return clear_pixels(rect, window_of(image));
    for_each_row(rect, image.width, [&](std::size_t pixel, std::size_t count) {
      std::memcpy(image.colour.data() + pixel, from.colour, count * sizeof(Colour));
      std::memcpy(image.depth.data() + pixel, from.depth, count * sizeof(float));
      from.colour += count * sizeof(Colour);
      from.depth += count * sizeof(float);
    });
  });
}

}  // namespace

template <class Colour>
void gather_regions(comm::Communicator& communicator, const loadbalance::Partition& partition,
                    const ImageTiles& tiles, image::BasicImage<Colour>& image) {
  if (communicator.rank() != 0) {
    comm::Buffer message = packed(partition, communicator.rank(), tiles, image);
    if (!message.empty()) communicator.send(0, kTagRegions, std::move(message));
    return;
  }
  std::vector<std::uint8_t> has_pixels(static_cast<std::size_t>(communicator.size()));
  for (const loadbalance::Region& region : partition.regions)
    if (!region.rect.empty()) has_pixels[static_cast<std::size_t>(region.owner)] = 1;
  for (int owner = 1; owner < communicator.size(); ++owner) {
    if (has_pixels[static_cast<std::size_t>(owner)] == 0) continue;
    unpack(communicator.receive(owner, kTagRegions), partition, owner, tiles, image);
  }
}

template <class Colour>
std::vector<image::BasicImage<Colour>> deliver_regions(
    comm::Communicator& communicator, const loadbalance::Partition& partition,
    const image::BasicImage<Colour>& image, std::span<const loadbalance::Region> displays) {
  const int rank = communicator.rank();
  const auto stride = static_cast<std::size_t>(image.width);
  std::vector<loadbalance::Pixels> mine;
  for (const loadbalance::Region& region : partition.regions) {
    if (region.owner != rank || region.rect.empty()) continue;
    const std::size_t first = static_cast<std::size_t>(region.rect.y0) * stride +
                              static_cast<std::size_t>(region.rect.x0);
    mine.push_back({region.rect, reinterpret_cast<const std::byte*>(image.colour.data() + first),
                    image.depth.data() + first, stride});
  }
  std::vector<image::BasicImage<Colour>> pictures;
  std::vector<loadbalance::PixelsToSet> shown;
  for (const loadbalance::Region& display : displays) {
    if (display.owner != rank) continue;
    image::BasicImage<Colour>& picture =
        pictures.emplace_back(display.rect.width(), display.rect.height());
    shown.push_back({display.rect, reinterpret_cast<std::byte*>(picture.colour.data()),
                     picture.depth.data(), static_cast<std::size_t>(picture.width)});
  }
  loadbalance::deliver(communicator, mine, sizeof(Colour), displays, shown);
  return pictures;
}

template void gather_regions(comm::Communicator&, const loadbalance::Partition&, const ImageTiles&,
                             image::Image8&);
template void gather_regions(comm::Communicator&, const loadbalance::Partition&, const ImageTiles&,
                             image::ImageF&);
template std::vector<image::Image8> deliver_regions(comm::Communicator&,
                                                    const loadbalance::Partition&,
                                                    const image::Image8&,
                                                    std::span<const loadbalance::Region>);
template std::vector<image::ImageF> deliver_regions(comm::Communicator&,
                                                    const loadbalance::Partition&,
                                                    const image::ImageF&,
                                                    std::span<const loadbalance::Region>);

}  // namespace delray::raster
