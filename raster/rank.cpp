#include "raster/internal/rank.h"

namespace delray::raster {

std::pair<std::uint64_t, std::uint64_t> Rank::own_primitives() const {
  const std::uint64_t all = first_primitives.back();
  const auto n = static_cast<std::uint64_t>(ranks());
  const auto k = static_cast<std::uint64_t>(number());
  // The first `all % n` ranks have one more.
  const auto begin = [&](std::uint64_t i) { return all / n * i + std::min(i, all % n); };
  return {begin(k), begin(k + 1)};
}

template <class Colour>
void Rank::render(const DrawList& list, std::span<const geometry::Rect> regions,
                  image::BasicImage<Colour>& image) {
  communicator.mark(comm::Phase::rasterize, 0);
  const RegionCounts done = render_regions(screen, list, shader, options, regions,
                                           depths_are_distances(), scratch, image, progress);
  communicator.work(comm::Work::primitives, done.triangles.in);
  communicator.work(comm::Work::fragments, done.fragments);
  counts.phases += done.phases;
  counts.triangles += done.triangles;
  counts.fragments += done.fragments;
  counts.tiles += done.tiles;
}

template void Rank::render(const DrawList&, std::span<const geometry::Rect>, image::Image8&);
template void Rank::render(const DrawList&, std::span<const geometry::Rect>, image::ImageF&);

}  // namespace delray::raster
