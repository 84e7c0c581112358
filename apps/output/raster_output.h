// Rasters of heights as GeoTIFF files.
#pragma once

#include <memory>

#include "apps/output/triangulation_output.h"
#include "delaunay/terrain_raster.h"

namespace delray::apps {

// The grid of the raster that the output asks for, over all points. Throws UsageError for more
// cells than anybody needs, FileError (device) for more than the disk has room for.
delaunay::RasterGrid raster_grid_of(const TriangulationOutput& output, const OutputFacts& facts);
// The raster itself, without a height. Throws as above.
std::unique_ptr<delaunay::TerrainRaster> make_raster(const TriangulationOutput& output,
                                                     const OutputFacts& facts);
// Writes it, with its coordinate system. What statistics say of it.
Json write_raster(const TriangulationOutput& output, const OutputFacts& facts,
                  const delaunay::TerrainRaster& raster);

}  // namespace delray::apps
