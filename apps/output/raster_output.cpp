// Hands the blocks of a raster to a GeoTIFF, in the order of their rows: the file is the same
// however they were filled.
#include "apps/output/raster_output.h"

#include <spdlog/spdlog.h>

#include <vector>

#include "apps/session.h"
#include "image/write_geotiff.h"

namespace delray::apps {

std::unique_ptr<delaunay::TerrainRaster> make_raster(const TriangulationOutput& output,
                                                     const OutputFacts& facts) {
  try {
    const delaunay::RasterGrid grid =
        facts.bounds ? delaunay::raster_grid_within(*facts.bounds, output.cell_size)
                     : delaunay::raster_grid(facts.box, output.cell_size);
    return std::make_unique<delaunay::TerrainRaster>(
        grid, delaunay::TerrainRasterOptions{facts.memory, facts.scratch});
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--cell-size: ") + error.what());
  }
}

Json write_raster(const TriangulationOutput& output, const OutputFacts& facts,
                  const delaunay::TerrainRaster& raster) {
  constexpr float kNoData = -9999;  // as GDAL's own programs have it
  const delaunay::RasterGrid& grid = raster.grid();
  image::GeoTiffWriter writer(
      output.path, {grid.columns, grid.rows, grid.west, grid.north, grid.cell, kNoData,
                    static_cast<int>(delaunay::TerrainRaster::kBlock), facts.coordinate_system});
  if (!writer.warning().empty()) spdlog::warn("{}: {}", output.path, writer.warning());
  std::vector<float> cells(delaunay::TerrainRaster::kBlock * delaunay::TerrainRaster::kBlock);
  std::uint64_t filled = 0;
  for (std::uint64_t row = 0; row < raster.block_rows(); ++row) {
    for (std::uint64_t column = 0; column < raster.block_columns(); ++column) {
      filled += raster.read_block(column, row, kNoData, cells);
      writer.write_block(column, row, cells);
    }
  }
  writer.commit();
  if (filled == 0) {
    spdlog::warn("{}: no centre of a cell lies in the triangulation: all cells are without data",
                 output.path);
  }
  return {{"columns", grid.columns},
          {"rows", grid.rows},
          {"cell_size", grid.cell},
          {"west", grid.west},
          {"north", grid.north},
          {"interpolate", output.interpolate.empty() ? "linear" : output.interpolate},
          {"cells", filled},
          {"no_data", kNoData}};
}

}  // namespace delray::apps
