// The part of writing GeoTIFFs that needs GDAL. It is a library of its own, delray_gdal, that
// write_geotiff.cpp loads on first use: GDAL brings some two hundred others.
#pragma once

#include <memory>
#include <string>

#include "image/write_geotiff.h"

namespace delray::image::gdal {

inline constexpr const char* kLibrary = "libdelray_gdal.so";
inline constexpr const char* kEntry = "delray_gdal_codec";

// A GeoTIFF that is being written; throws FileError (device), which names `name`.
class Writer {
 public:
  virtual ~Writer() = default;
  virtual const std::string& warning() const = 0;
  virtual void write_block(int column, int row, std::span<const float> pixels) = 0;
  virtual void close() = 0;
};

struct Codec {
  // In place, to `file`, which is `name` to the user.
  std::unique_ptr<Writer> (*create)(const std::filesystem::path& file, const std::string& name,
                                    const GeoRaster& raster);
};

}  // namespace delray::image::gdal
