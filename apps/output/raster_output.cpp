// Hands the blocks of a raster to a GeoTIFF, in the order of their rows: the file is the same
// however they were filled.
#include "apps/output/raster_output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "apps/session.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "image/write_geotiff.h"

namespace delray::apps {

namespace {

// More than any survey has: a country of a million square kilometres has as many square metres.
constexpr double kMostCells = 1e12;

// Throws UsageError for more cells than kMostCells, FileError (device) for more than the disk has
// room for.
void require_room(const std::string& path, const delaunay::RasterGrid& grid) {
  const double cells = static_cast<double>(grid.columns) * static_cast<double>(grid.rows);
  const std::string size =
      fmt::format("--cell-size {:g} makes {} x {} cells", grid.cell, grid.columns, grid.rows);
  if (cells > kMostCells) {
    throw UsageError(
        fmt::format("{}, {:.3g} in all; at most {:g} are written", size, cells, kMostCells));
  }
  const auto bytes = static_cast<std::uint64_t>(cells) * sizeof(float);
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(path, error).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || bytes <= space.available) return;
  throw files::FileError(files::Cause::device, path, "",
                         fmt::format("{}: {} are needed, {} are free", size,
                                     files::bytes_text(bytes), files::bytes_text(space.available)));
}

}  // namespace

delaunay::RasterGrid raster_grid_of(const TriangulationOutput& output, const OutputFacts& facts) {
  delaunay::RasterGrid grid;
  try {
    grid = facts.bounds ? delaunay::raster_grid_within(*facts.bounds, output.cell_size)
                        : delaunay::raster_grid(facts.box, output.cell_size);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--cell-size: ") + error.what());
  }
  require_room(output.path, grid);
  return grid;
}

std::unique_ptr<delaunay::TerrainRaster> make_raster(const TriangulationOutput& output,
                                                     const OutputFacts& facts) {
  return std::make_unique<delaunay::TerrainRaster>(
      raster_grid_of(output, facts), delaunay::TerrainRasterOptions{facts.memory, facts.scratch});
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
