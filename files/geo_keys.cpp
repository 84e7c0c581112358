// Looks up keys in a GeoKeyDirectory; in well-known text names of kinds of coordinate systems, the
// first name, and AUTHORITY or ID by the depth of brackets that they stand at.
#include "files/geo_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <limits>

namespace delray::files {

namespace {

// Without blanks and the bar that ends a text among others.
std::string trimmed(std::string_view text) {
  constexpr std::string_view kEnds = std::string_view(" \t\r\n|\0", 6);
  const std::size_t begin = text.find_first_not_of(kEnds);
  if (begin == text.npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kEnds) - begin + 1));
}

bool is_word(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

// The EPSG number that stands at the least depth of brackets, the first of several.
int find_epsg(std::string_view text) {
  int depth = 0, best_depth = std::numeric_limits<int>::max(), best = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      i = text.find('"', i + 1);
      if (i == text.npos) return best;
    } else if (c == ']' || c == ')') {
      --depth;
    } else if (c == '[' || c == '(') {
      std::size_t word = i;
      while (word > 0 && is_word(text[word - 1])) --word;
      const std::string_view name = text.substr(word, i - word);
      std::string_view rest = text.substr(i + 1);
      constexpr std::string_view kRegistry = "\"EPSG\",";
      if ((name == "AUTHORITY" || name == "ID") && rest.starts_with(kRegistry) &&
          depth < best_depth) {
        rest.remove_prefix(kRegistry.size());
        rest.remove_prefix(std::min(rest.find_first_not_of(" \""), rest.size()));
        int number = 0;
        const auto parsed = std::from_chars(rest.data(), rest.data() + rest.size(), number);
        if (parsed.ec == std::errc() && number > 0) {
          best = number;
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
  if (const std::size_t quote = text.find('"'); quote != text.npos) {
    keys.name = trimmed(text.substr(quote + 1, text.find('"', quote + 1) - quote - 1));
  }
  return keys;
}

}  // namespace delray::files
