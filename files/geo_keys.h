// Kinds of coordinates, as GeoTIFF keys and well-known text tell them in LAS and TIFF files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace delray::files {

// The coordinate system as GeoTIFF keys tell it; LAS files have them, too.
struct GeoKeys {
  bool known = false;           // whether the kind of coordinates is told at all
  bool geographic = false;      // longitude and latitude in degrees
  bool pixel_is_point = false;  // a raster's coordinates are those of pixel centres, not of corners
  std::string name;             // of the system, as it stands there; empty if none does
  int epsg = 0;                 // its number in the EPSG registry; 0 if none is told
};

// From a GeoKeyDirectory (OGC GeoTIFF 1.1, 7.1): four numbers of version and count, then four for
// each key. `texts` is what GeoAsciiParams holds, with names of systems. What is cut short is not
// read.
GeoKeys parse_geo_keys(std::span<const std::uint16_t> directory, std::string_view texts = {});

// From the well-known text of a coordinate reference system (OGC 01-009, ISO 19162). The number is
// that of the system as a whole, or else of the first of those that it is composed of.
GeoKeys parse_well_known_text(std::string_view text);

}  // namespace delray::files
