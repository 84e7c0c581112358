// Degrees and metres, from GeoTIFF keys and well-known text.
#include "files/geo_keys.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::files {
namespace {

TEST(GeoKeys, TellTheKindOfCoordinatesAndOfPixels) {
  const std::vector<std::uint16_t> keys = {1,    1, 0, 3,    1024, 0, 1, 2,
                                           2048, 0, 1, 4326, 1025, 0, 1, 2};
  EXPECT_TRUE(parse_geo_keys(keys).known);
  EXPECT_TRUE(parse_geo_keys(keys).geographic);
  EXPECT_TRUE(parse_geo_keys(keys).pixel_is_point);
  for (std::size_t size = 0; size < keys.size(); ++size) {
    const GeoKeys cut = parse_geo_keys(std::span(keys).first(size));
    EXPECT_EQ(cut.geographic, size >= 8);
    EXPECT_FALSE(cut.pixel_is_point);
  }
}

TEST(GeoKeys, TellAProjectedSystemFromTheGeographicOneInIt) {
  EXPECT_TRUE(parse_well_known_text("GEOGCS[\"WGS 84\",DATUM[]]").geographic);
  EXPECT_TRUE(parse_well_known_text("COMPD_CS[\"a\",GEOGCS[\"b\"],VERT_CS[\"c\"]]").geographic);
  EXPECT_TRUE(parse_well_known_text("GEOGCRS[\"WGS 84\"]").geographic);
  const GeoKeys projected = parse_well_known_text("PROJCS[\"UTM\",GEOGCS[\"WGS 84\"]]");
  EXPECT_TRUE(projected.known);
  EXPECT_FALSE(projected.geographic);
  EXPECT_FALSE(parse_well_known_text("").known);
}

}  // namespace
}  // namespace delray::files
