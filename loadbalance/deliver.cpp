// Cuts what a rank has by displays, packs for each receiver rectangles, then depths, then colours,
// and copies what stays. Degenerate: a rank that has or shows nothing takes part all the same.
#include "loadbalance/deliver.h"

#include <cassert>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "loadbalance/region_index.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

// A part of what a rank has, within one display.
struct Part {
  Rect rect;
  int display;
};

std::size_t pixels_of(const Rect& rect) { return static_cast<std::size_t>(rect.area()); }

template <class Byte, class Float>
std::size_t place_in(const BasicPixels<Byte, Float>& pixels, int x, int y) {
  return static_cast<std::size_t>(y - pixels.rect.y0) * pixels.stride +
         static_cast<std::size_t>(x - pixels.rect.x0);
}

void copy(const Rect& rect, const Pixels& from, std::size_t colour_bytes, const PixelsToSet& to) {
  const auto width = static_cast<std::size_t>(rect.width());
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::size_t source = place_in(from, rect.x0, y), target = place_in(to, rect.x0, y);
    std::memcpy(to.depth + target, from.depth + source, width * sizeof(float));
    std::memcpy(to.colour + target * colour_bytes, from.colour + source * colour_bytes,
                width * colour_bytes);
  }
}

// Parts of messages, one after the other: how many, all of them, depths of all, colours of all.
std::size_t bytes_before_depths(std::size_t parts) {
  return sizeof(std::uint64_t) + parts * sizeof(Part);
}

// For one receiver: parts with the pixels that each is of.
comm::Buffer pack(std::span<const std::pair<Part, const Pixels*>> parts, std::size_t colour_bytes) {
  std::size_t pixels = 0;
  for (const auto& [part, from] : parts) pixels += pixels_of(part.rect);
  const std::uint64_t count = parts.size();
  comm::Buffer message(bytes_before_depths(count) + pixels * (sizeof(float) + colour_bytes));
  std::memcpy(message.data(), &count, sizeof(count));
  std::byte* at = message.data() + sizeof(count);
  auto* depth = reinterpret_cast<float*>(message.data() + bytes_before_depths(count));
  auto* colour = reinterpret_cast<std::byte*>(depth + pixels);
  for (const auto& [part, from] : parts) {
    std::memcpy(at, &part, sizeof(part));
    at += sizeof(part);
    const auto width = static_cast<std::size_t>(part.rect.width());
    copy(part.rect, *from, colour_bytes, {part.rect, colour, depth, width});
    depth += pixels_of(part.rect);
    colour += pixels_of(part.rect) * colour_bytes;
  }
  return message;
}

// Calls set(part, its pixels) for all parts of a message.
template <class F>
void unpack(const comm::Buffer& message, std::size_t colour_bytes, F&& set) {
  std::uint64_t count = 0;
  std::memcpy(&count, message.data(), sizeof(count));
  std::vector<Part> parts(count);
  std::memcpy(parts.data(), message.data() + sizeof(count), count * sizeof(Part));
  std::size_t pixels = 0;
  for (const Part& part : parts) pixels += pixels_of(part.rect);
  const auto* depth = reinterpret_cast<const float*>(message.data() + bytes_before_depths(count));
  const auto* colour = reinterpret_cast<const std::byte*>(depth + pixels);
  for (const Part& part : parts) {
    set(part, Pixels{part.rect, colour, depth, static_cast<std::size_t>(part.rect.width())});
    depth += pixels_of(part.rect);
    colour += pixels_of(part.rect) * colour_bytes;
  }
}

Rect around(std::span<const Region> regions) {
  Rect result;
  for (const Region& region : regions) {
    const Rect& r = region.rect;
    if (result.empty()) result = r;
    result = {std::min(result.x0, r.x0), std::min(result.y0, r.y0), std::max(result.x1, r.x1),
              std::max(result.y1, r.y1)};
  }
  return result;
}

}  // namespace

// Before depths there are 8 bytes and 20 for each part: a multiple of 4, as floats want it.
static_assert(sizeof(Part) == 20);

void deliver(comm::Communicator& communicator, std::span<const Pixels> mine,
             std::size_t colour_bytes, std::span<const Region> displays,
             std::span<const PixelsToSet> shown) {
  std::vector<const PixelsToSet*> memory(displays.size());
  std::size_t own = 0;
  for (std::size_t i = 0; i < displays.size(); ++i) {
    if (displays[i].owner != communicator.rank()) continue;
    assert(own < shown.size() && shown[own].rect == displays[i].rect);
    memory[i] = &shown[own++];
  }
  assert(own == shown.size());
  const auto set = [&](const Part& part, const Pixels& from) {
    copy(part.rect, from, colour_bytes, *memory[static_cast<std::size_t>(part.display)]);
  };

  const Partition places{around(displays), {displays.begin(), displays.end()}};
  const RegionIndex index(places);
  std::map<int, std::vector<std::pair<Part, const Pixels*>>> by_receiver;
  for (const Pixels& from : mine) {
    index.for_each_region(from.rect, [&](const Region& display, const Rect& common) {
      const Part part{common, static_cast<int>(&display - places.regions.data())};
      if (display.owner == communicator.rank()) {
        set(part, from);
      } else {
        by_receiver[display.owner].emplace_back(part, &from);
      }
    });
  }
  std::vector<comm::Parcel> parcels;
  for (const auto& [receiver, parts] : by_receiver)
    parcels.push_back({receiver, pack(parts, colour_bytes)});
  for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels)))
    unpack(parcel.message, colour_bytes, set);
}

}  // namespace delray::loadbalance
