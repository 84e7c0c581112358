// A coordinate reference system as a file has it, to be handed on to another file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace delray::files {

// In one of several ways; nothing is known where all are empty.
struct CoordinateSystem {
  std::string well_known_text;  // OGC 01-009, ISO 19162
  // GeoTIFF's keys with the numbers and texts that they refer to (OGC GeoTIFF 1.1, 7.1), as LAS
  // files have them too.
  std::vector<std::uint16_t> geo_keys;
  std::vector<double> geo_numbers;
  std::string geo_texts;
  std::filesystem::path raster;  // a GeoTIFF that has it

  bool empty() const { return well_known_text.empty() && geo_keys.empty() && raster.empty(); }
};

// Of a LAS or LAZ file, from the records between its header and its points; nothing for other
// files, for streams, and for what breaks off.
CoordinateSystem read_las_coordinate_system(const std::filesystem::path& path);

}  // namespace delray::files
