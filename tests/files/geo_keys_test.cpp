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

TEST(GeoKeys, TellNameAndNumber) {
  // Texts "Own|Whole|" hold the names of the projected system and of all.
  std::vector<std::uint16_t> keys = {1, 1,    0,    4,     1024, 0, 1,    1,     3072, 0,
                                     1, 2992, 3073, 34737, 4,    0, 1026, 34737, 6,    4};
  EXPECT_EQ(parse_geo_keys(keys, "Own|Whole|").name, "Own");
  EXPECT_EQ(parse_geo_keys(keys, "Own|Whole|").epsg, 2992);
  keys[12] = 9999;
  EXPECT_EQ(parse_geo_keys(keys, "Own|Whole|").name, "Whole");
  EXPECT_EQ(parse_geo_keys(keys, "Ow").name, "");
  keys[11] = 32767;  // user-defined
  EXPECT_EQ(parse_geo_keys(keys).epsg, 0);

  const char* const datum =
      "GEOGCS[\"WGS 84\",DATUM[\"a]b\",AUTHORITY[\"EPSG\",\"6326\"]],AUTHORITY[\"EPSG\",\"4326\"]]";
  EXPECT_EQ(parse_well_known_text(datum).epsg, 4326);
  EXPECT_EQ(parse_well_known_text(datum).name, "WGS 84");
  const std::string projected = std::string("PROJCS[\"UTM\",") + datum;
  EXPECT_EQ(parse_well_known_text(projected + "]").epsg, 0);
  const std::string numbered = projected + ",AUTHORITY[\"EPSG\",\"32633\"]]";
  EXPECT_EQ(parse_well_known_text(numbered).epsg, 32633);
  EXPECT_EQ(parse_well_known_text("COMPD_CS[\"both\"," + numbered + "]").epsg, 32633);
  EXPECT_EQ(parse_well_known_text("PROJCRS[\"x\",ID[\"EPSG\",28992]]").epsg, 28992);
  EXPECT_EQ(parse_well_known_text("PROJCS[\"x").name, "");
}

}  // namespace
}  // namespace delray::files
