// One rank's rendering: pieces of a scene into regions of an image.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "raster/internal/draw_into_tiles.h"
#include "raster/internal/shade_tile.h"
#include "raster/render.h"

namespace delray::raster {

// Memory that one frame leaves to the next.
struct Scratch {
  Picture spare;  // nobody's any more
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  LargeTriangles large;
};

// An image of any content, the spare one if that fits.
template <class Colour>
image::BasicImage<Colour> take_image(const Screen& screen, Scratch& scratch) {
  if (auto* const spare = std::get_if<image::BasicImage<Colour>>(&scratch.spare);
      spare != nullptr && spare->width == screen.width && spare->height == screen.height)
    return std::exchange(*spare, {});
  return image::BasicImage<Colour>(screen.width, screen.height);
}

// What rendering took, summed over threads, and what it did.
struct RegionCounts {
  Phases phases;
  TriangleCounts triangles;
  std::uint64_t fragments = 0, tiles = 0;
};

// Renders the list into those pixels of the image (which has the frame's size) that `regions`
// cover; depths are -near / distance, or with `distances` those. The regions are disjoint.
// Parallel: batches of clusters, then tiles.
template <class Colour>
RegionCounts render_regions(const Screen& screen, const DrawList& list,
                            const shading::Shader& shader, const RenderOptions& options,
                            std::span<const geometry::Rect> regions, bool distances,
                            Scratch& scratch, image::BasicImage<Colour>& image,
                            parallel::Progress* progress);

}  // namespace delray::raster
