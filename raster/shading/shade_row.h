// Rows of pixels, by vectors.
#pragma once

#include <cstdint>
#include <span>

#include "image/image.h"
#include "raster/shading/pixel_triangles.h"
#include "raster/shading/tile_runs.h"
#include "shading/points.h"

namespace delray::raster {

// Rows are stored so many pixels at a time.
inline constexpr int kBlockSize = shading::kBlockPoints;

// Stores the colours of pixels x .. x + count - 1 of row y, transparent black where no triangle is
// shown. `pixels` may be changed up to the next multiple of kBlockSize.
//
// REQUIRES: 1 <= count <= kTileSize.
void shade_row(std::span<const PixelTriangle> triangles, const TriangleIndices& indices,
               const RowRuns& row, int x, int y, int count, image::Rgba8* pixels);
void shade_row(std::span<const PixelTriangle> triangles, const TriangleIndices& indices,
               const RowRuns& row, int x, int y, int count, image::RgbaF* pixels);

// Stores kBlockSize linear colours, opaque, or transparent black where the bit of `shown` is not
// set.
void store_colours(const shading::Vectors16& colours, shading::LaneMask shown,
                   image::Rgba8* pixels);
void store_colours(const shading::Vectors16& colours, shading::LaneMask shown,
                   image::RgbaF* pixels);

// The depths of `count` keys, or the distances that they stand for in `view` if it is given,
// infinity where nothing is seen. `depths` may be changed up to the next multiple of kBlockSize.
void store_depths(const std::int64_t* keys, int count, const scenes::View* view, float* depths);

}  // namespace delray::raster
