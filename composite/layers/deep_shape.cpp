// Merges sorted lists of surfaces that have no colours: two lists pixel by pixel, front to back up
// to the first opaque surface. Groups of pixels without a surface have no memory; copies share
// groups until one of them changes. O(surfaces of both in the groups that a message touches).
#include "composite/deep_shape.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "composite/schemes/range.h"

namespace delray::composite {
namespace {

using Surface = DeepShape::Surface;

// Appends the surfaces of both in order, up to the first opaque one; returns how many.
std::uint64_t merge_lists(std::span<const Surface> a, std::span<const Surface> b,
                          std::vector<Surface>& to) {
  const std::size_t before = to.size();
  while (!a.empty() || !b.empty()) {
    std::span<const Surface>& from =
        b.empty() || (!a.empty() && !in_front(b.front(), a.front())) ? a : b;
    to.push_back(from.front());
    if (is_opaque(from.front().payload)) break;
    from = from.subspan(1);
  }
  return to.size() - before;
}

// Walks through the pixels that have surfaces.
class Walk {
 public:
  Walk(std::span<const DeepShape::Pixel> pixels, std::span<const Surface> surfaces)
      : pixels_(pixels), surfaces_(surfaces) {}
  bool ended() const { return pixels_.empty(); }
  std::uint64_t pixel() const { return pixels_.front().index; }
  std::span<const Surface> take() {
    const std::size_t size = pixels_.front().size;
    const auto list = surfaces_.first(size);
    surfaces_ = surfaces_.subspan(size);
    pixels_ = pixels_.subspan(1);
    return list;
  }

 private:
  std::span<const DeepShape::Pixel> pixels_;
  std::span<const Surface> surfaces_;
};

}  // namespace

DeepShape::DeepShape(std::uint64_t pixels)
    : pixels_(pixels), groups_((pixels + kGroupPixels - 1) / kGroupPixels) {}

bool DeepShape::empty() const {
  return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return !group; });
}

void DeepShape::set(std::size_t group, Group&& to) {
  groups_[group] = to.pixels.empty() ? nullptr : std::make_shared<const Group>(std::move(to));
}

void DeepShape::read(PixelRange range, std::vector<Pixel>& pixels,
                     std::vector<Surface>& surfaces) const {
  assert(range.begin <= range.end && range.end <= pixels_);
  for (std::uint64_t i = range.begin / kGroupPixels; i * kGroupPixels < range.end; ++i) {
    if (!groups_[i]) continue;
    for (Walk walk(groups_[i]->pixels, groups_[i]->surfaces); !walk.ended();) {
      const std::uint64_t pixel = i * kGroupPixels + walk.pixel();
      const auto list = walk.take();
      if (pixel < range.begin || pixel >= range.end) continue;
      pixels.push_back({pixel - range.begin, list.size()});
      surfaces.insert(surfaces.end(), list.begin(), list.end());
    }
  }
}

DeepShape::Group DeepShape::merged(const Group& own, const Group& arrived,
                                   std::uint64_t& compared) {
  Group result;
  Walk a(own.pixels, own.surfaces), b(arrived.pixels, arrived.surfaces);
  while (!a.ended() || !b.ended()) {
    const std::uint64_t pixel = b.ended()   ? a.pixel()
                                : a.ended() ? b.pixel()
                                            : std::min(a.pixel(), b.pixel());
    std::span<const Surface> mine, other;
    if (!a.ended() && a.pixel() == pixel) mine = a.take();
    if (!b.ended() && b.pixel() == pixel) other = b.take();
    if (!other.empty()) compared += mine.size() + other.size();
    result.pixels.push_back({pixel, merge_lists(mine, other, result.surfaces)});
  }
  return result;
}

std::uint64_t DeepShape::merge(PixelRange range, const Lists& lists) {
  assert(range.begin <= range.end && range.end <= pixels_);
  std::uint64_t compared = 0;
  for (Walk walk(lists.pixels, lists.surfaces); !walk.ended();) {
    const std::uint64_t group = (range.begin + walk.pixel()) / kGroupPixels;
    Group arrived;
    while (!walk.ended() && (range.begin + walk.pixel()) / kGroupPixels == group) {
      const std::uint64_t pixel = range.begin + walk.pixel() - group * kGroupPixels;
      const auto list = walk.take();
      arrived.pixels.push_back({pixel, list.size()});
      arrived.surfaces.insert(arrived.surfaces.end(), list.begin(), list.end());
    }
    set(group, merged(groups_[group] ? *groups_[group] : Group(), arrived, compared));
  }
  return compared;
}

void DeepShape::remove(PixelRange range) {
  for (std::uint64_t i = range.begin / kGroupPixels; i * kGroupPixels < range.end; ++i) {
    if (!groups_[i]) continue;
    const std::uint64_t begin = i * kGroupPixels, end = std::min(begin + kGroupPixels, pixels_);
    const PixelRange gone = internal::overlap(range, {begin, end});
    Group rest;
    for (Walk walk(groups_[i]->pixels, groups_[i]->surfaces); !walk.ended();) {
      const std::uint64_t pixel = walk.pixel();
      const auto list = walk.take();
      if (gone.begin <= begin + pixel && begin + pixel < gone.end) continue;
      rest.pixels.push_back({pixel, list.size()});
      rest.surfaces.insert(rest.surfaces.end(), list.begin(), list.end());
    }
    set(i, std::move(rest));
  }
}

}  // namespace delray::composite
