// Looks up keys in a GeoKeyDirectory; in well-known text names of kinds of coordinate systems, the
// first name, and AUTHORITY or ID by the depth of brackets that they stand at.
#include "files/geo_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

namespace delray::files {

namespace {

// Without blanks and the bar that ends a text among others.
std::string trimmed(std::string_view text) {
  constexpr std::string_view kEnds = std::string_view(" \t\r\n|\0", 6);
  const std::size_t begin = text.find_first_not_of(kEnds);
  if (begin == text.npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kEnds) - begin + 1));
}

// The EPSG number of the system itself, or of the first of those that it is composed of; numbers
// deeper in brackets are those of its datum, units and other parts.
int find_epsg(std::string_view text) {
  constexpr std::string_view kRegistry = "\"EPSG\",";
  const bool compound = text.starts_with("COMPD_CS") || text.starts_with("COMPOUNDCRS");
  const int deepest = compound ? 2 : 1;
  int depth = 0, best_depth = deepest + 1, best = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      i = text.find('"', i + 1);
      if (i == text.npos) return best;
    } else if (c == ']' || c == ')') {
      --depth;
    } else if (c == '[' || c == '(') {
      const bool number =
          text.substr(0, i).ends_with("AUTHORITY") || text.substr(0, i).ends_with(",ID");
      std::string_view rest = text.substr(i + 1);
      if (number && depth < best_depth && rest.starts_with(kRegistry)) {
        rest.remove_prefix(kRegistry.size());
        rest.remove_prefix(std::min(rest.find_first_not_of(" \""), rest.size()));
        int found = 0;
        const auto parsed = std::from_chars(rest.data(), rest.data() + rest.size(), found);
        if (parsed.ec == std::errc() && found > 0) {
          best = found;
          best_depth = depth;
        }
      }
      ++depth;
    }
  }
  return best;
}

}  // namespace

GeoKeys parse_geo_keys(std::span<const std::uint16_t> directory, std::string_view texts) {
  constexpr std::uint16_t kModelType = 1024, kRasterType = 1025, kCitation = 1026;
  constexpr std::uint16_t kGeographicType = 2048, kGeographicCitation = 2049;
  constexpr std::uint16_t kProjectedType = 3072, kProjectedCitation = 3073;
  constexpr std::uint16_t kTexts = 34737;
  constexpr std::uint16_t kGeographic = 2, kPixelIsPoint = 2, kUserDefined = 32767;
  constexpr std::size_t kHeader = 4, kKey = 4;
  GeoKeys keys;
  int projected = 0, geographic = 0;
  std::string projected_name, geographic_name, name;
  if (directory.size() < kHeader) return keys;
  const std::size_t count =
      std::min<std::size_t>(directory[3], (directory.size() - kHeader) / kKey);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const std::uint16_t> key = directory.subspan(kHeader + i * kKey, kKey);
    if (key[1] == kTexts && key[3] <= texts.size()) {
      const std::string text = trimmed(texts.substr(key[3], key[2]));
      if (key[0] == kCitation) name = text;
      if (key[0] == kProjectedCitation) projected_name = text;
      if (key[0] == kGeographicCitation) geographic_name = text;
    }
    if (key[1] != 0) continue;  // a value that stands in another tag
    if (key[0] == kModelType) {
      keys.known = true;
      keys.geographic = key[3] == kGeographic;
    }
    if (key[0] == kRasterType) keys.pixel_is_point = key[3] == kPixelIsPoint;
    if (key[0] == kProjectedType && key[3] != kUserDefined) projected = key[3];
    if (key[0] == kGeographicType && key[3] != kUserDefined) geographic = key[3];
  }
  keys.epsg = projected != 0 || !keys.geographic ? projected : geographic;
  const std::string& own = keys.geographic ? geographic_name : projected_name;
  keys.name = own.empty() ? name : own;
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
  if (!keys.known) return keys;
  keys.epsg = find_epsg(text);
  const std::size_t begin = text.find('"') + 1, end = text.find('"', begin);
  if (begin > 0 && end != text.npos) keys.name = trimmed(text.substr(begin, end - begin));
  return keys;
}

}  // namespace delray::files
