// Packs the rows of a rank's regions, colours before depths, into one message for rank 0, which
// copies them to their places. Degenerate: a rank without pixels sends nothing.
#include "raster/distribute/gather_regions.h"

#include <cstring>

#include "loadbalance/deliver.h"

namespace delray::raster {
namespace {

constexpr comm::Tag kTagRegions = 80;

// Calls f(first pixel, count) for each row of the regions of `owner`, in the order of the
// partition.
template <class F>
void for_each_row(const loadbalance::Partition& partition, int owner, int image_width, F&& f) {
  for (const loadbalance::Region& region : partition.regions) {
    if (region.owner != owner || region.rect.empty()) continue;
    for (int y = region.rect.y0; y < region.rect.y1; ++y) {
      f(static_cast<std::size_t>(y) * image_width + region.rect.x0,
        static_cast<std::size_t>(region.rect.width()));
    }
  }
}

std::size_t pixels_of(const loadbalance::Partition& partition, int owner) {
  std::size_t pixels = 0;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == owner) pixels += static_cast<std::size_t>(region.rect.area());
  return pixels;
}

}  // namespace

template <class Colour>
void gather_regions(comm::Communicator& communicator, const loadbalance::Partition& partition,
                    image::BasicImage<Colour>& image) {
  const auto copy = [](auto* to, const auto* from, std::size_t count) {
    std::memcpy(to, from, count * sizeof(*from));
  };
  const auto message_of = [&](int owner) {
    return pixels_of(partition, owner) * (sizeof(Colour) + sizeof(float));
  };
  if (communicator.rank() != 0) {
    const int mine = communicator.rank();
    comm::Buffer message(message_of(mine));
    if (message.empty()) return;
    auto* colour = reinterpret_cast<Colour*>(message.data());
    auto* depth = reinterpret_cast<float*>(colour + pixels_of(partition, mine));
    for_each_row(partition, mine, image.width, [&](std::size_t pixel, std::size_t count) {
      copy(colour, image.colour.data() + pixel, count);
      copy(depth, image.depth.data() + pixel, count);
      colour += count;
      depth += count;
    });
    communicator.send(0, kTagRegions, std::move(message));
    return;
  }
  for (int owner = 1; owner < communicator.size(); ++owner) {
    if (message_of(owner) == 0) continue;
    const comm::Buffer message = communicator.receive(owner, kTagRegions);
    const auto* colour = reinterpret_cast<const Colour*>(message.data());
    const auto* depth = reinterpret_cast<const float*>(colour + pixels_of(partition, owner));
    for_each_row(partition, owner, image.width, [&](std::size_t pixel, std::size_t count) {
      copy(image.colour.data() + pixel, colour, count);
      copy(image.depth.data() + pixel, depth, count);
      colour += count;
      depth += count;
    });
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

template void gather_regions(comm::Communicator&, const loadbalance::Partition&, image::Image8&);
template void gather_regions(comm::Communicator&, const loadbalance::Partition&, image::ImageF&);
template std::vector<image::Image8> deliver_regions(comm::Communicator&,
                                                    const loadbalance::Partition&,
                                                    const image::Image8&,
                                                    std::span<const loadbalance::Region>);
template std::vector<image::ImageF> deliver_regions(comm::Communicator&,
                                                    const loadbalance::Partition&,
                                                    const image::ImageF&,
                                                    std::span<const loadbalance::Region>);

}  // namespace delray::raster
