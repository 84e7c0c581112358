// Coordinate systems for GDAL.
#pragma once

#include <ogr_srs_api.h>

#include "files/coordinate_system.h"

namespace delray::image::gdal {

// For OSRRelease(); null for what GDAL does not understand. Text is parsed as such: it can name no
// files.
OGRSpatialReferenceH read_coordinate_system(const files::CoordinateSystem& system);

}  // namespace delray::image::gdal
