// Looks up two keys in a GeoKeyDirectory, and names of kinds of coordinate systems in well-known
// text.
#include "files/geo_keys.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace delray::files {

GeoKeys parse_geo_keys(std::span<const std::uint16_t> directory) {
  constexpr std::uint16_t kModelType = 1024, kRasterType = 1025;
  constexpr std::uint16_t kGeographic = 2, kPixelIsPoint = 2;
  constexpr std::size_t kHeader = 4, kKey = 4;
  GeoKeys keys;
  if (directory.size() < kHeader) return keys;
  const std::size_t count =
      std::min<std::size_t>(directory[3], (directory.size() - kHeader) / kKey);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const std::uint16_t> key = directory.subspan(kHeader + i * kKey, kKey);
    if (key[1] != 0) continue;  // a value that stands in another tag
    if (key[0] == kModelType) {
      keys.known = true;
      keys.geographic = key[3] == kGeographic;
    }
    if (key[0] == kRasterType) keys.pixel_is_point = key[3] == kPixelIsPoint;
  }
  return keys;
}

GeoKeys parse_well_known_text(std::string_view text) {
  const auto has_one_of = [text](const auto& words) {
    return std::ranges::any_of(
        words, [text](std::string_view word) { return text.find(word) != text.npos; });
  };
  // A projected system names the geographic one that it is made from.
  constexpr std::array<std::string_view, 6> kOthers = {"PROJCS", "PROJCRS",  "PROJECTEDCRS",
                                                       "GEOCCS", "LOCAL_CS", "ENGCRS"};
  constexpr std::array<std::string_view, 5> kGeographic = {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS",
                                                           "GEODCRS", "GEODETICCRS"};
  GeoKeys keys;
  const bool other = has_one_of(kOthers), geographic = has_one_of(kGeographic);
  keys.known = other || geographic;
  keys.geographic = geographic && !other;
  return keys;
}

}  // namespace delray::files
