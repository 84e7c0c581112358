// Elevations as GeoTIFF files (OGC 19-008r4), block by block, by GDAL, which is loaded on first
// use.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "files/coordinate_system.h"

namespace delray::image {

// A raster of 32-bit floats; rows from north to south.
struct GeoRaster {
  std::uint64_t width = 0, height = 0;  // at most 2^31 - 1
  double west = 0, north = 0;           // of the outer corner of pixel (0, 0)
  double cell = 1;                      // side of a pixel
  float no_data = -9999;
  int block = 256;  // pixels a side of the file's tiles
  files::CoordinateSystem coordinate_system;
};

// Writes a tiled GeoTIFF, a BigTIFF where it needs to be one; the same bytes for the same blocks in
// the same order. It appears whole or not at all (files::AtomicFile).
//
// Throws FileError (device).
class GeoTiffWriter {
 public:
  GeoTiffWriter(const std::filesystem::path& path, const GeoRaster& raster);
  ~GeoTiffWriter();
  GeoTiffWriter(const GeoTiffWriter&) = delete;
  GeoTiffWriter& operator=(const GeoTiffWriter&) = delete;

  // What GDAL made nothing of and the file goes without: one sentence, or empty.
  const std::string& warning() const;
  // block * block pixels, row by row; those beyond the raster are not looked at.
  void write_block(std::uint64_t column, std::uint64_t row, std::span<const float> pixels);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delray::image
