// Kinds of coordinates, as GeoTIFF keys and well-known text tell them in LAS and TIFF files.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace delray::files {

// The coordinate system as GeoTIFF keys tell it; LAS files have them, too.
struct GeoKeys {
  bool known = false;           // whether the kind of coordinates is told at all
  bool geographic = false;      // longitude and latitude in degrees
  bool pixel_is_point = false;  // a raster's coordinates are those of pixel centres, not of corners
};

// From a GeoKeyDirectory (OGC GeoTIFF 1.1, 7.1): four numbers of version and count, then four for
// each key. What is cut short is not read.
GeoKeys parse_geo_keys(std::span<const std::uint16_t> directory);

// From the well-known text of a coordinate reference system (OGC 01-009, ISO 19162).
GeoKeys parse_well_known_text(std::string_view text);

}  // namespace delray::files
