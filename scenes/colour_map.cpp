// Colour maps as stops at equal steps, interpolated in sRGB codes, which follow perception more
// closely than light does.
#include "scenes/colour_map.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "image/srgb.h"

namespace delray::scenes {
namespace {

// A colour of sRGB codes at an equal share of the range.
struct Stop {
  std::uint8_t r, g, b;
};

glm::vec3 linear(const Stop& stop) {
  return {image::decode_srgb(stop.r), image::decode_srgb(stop.g), image::decode_srgb(stop.b)};
}

// Straight between neighbouring stops, in codes: maps are chosen for even steps of what is seen,
// which codes follow more closely than light does.
glm::vec3 between(std::span<const Stop> stops, float x) {
  if (!(x > 0)) return linear(stops.front());
  const float at = std::min(x, 1.0F) * static_cast<float>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const float t = at - static_cast<float>(i);
  const Stop &a = stops[i], &b = stops[i + 1];
  const auto channel = [t](std::uint8_t low, std::uint8_t high) {
    const float code =
        static_cast<float>(low) + t * (static_cast<float>(high) - static_cast<float>(low));
    return image::decode_srgb_value(code / 255.0F);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

// Low land to snow.
constexpr std::array kTerrain = {Stop{44, 92, 72},    Stop{78, 128, 70},   Stop{138, 158, 84},
                                 Stop{192, 178, 112}, Stop{176, 136, 92},  Stop{140, 102, 78},
                                 Stop{158, 138, 126}, Stop{206, 200, 196}, Stop{248, 248, 250}};
// After viridis (Smith, van der Walt 2015), turbo (Mikhailov 2019) and the colours of a black body,
// each at equal steps.
constexpr std::array kViridis = {Stop{68, 1, 84},    Stop{72, 40, 120},  Stop{62, 74, 137},
                                 Stop{49, 104, 142}, Stop{38, 130, 142}, Stop{31, 158, 137},
                                 Stop{53, 183, 121}, Stop{110, 206, 88}, Stop{181, 222, 43},
                                 Stop{253, 231, 37}};
constexpr std::array kTurbo = {Stop{48, 18, 59},   Stop{69, 89, 203},  Stop{66, 143, 254},
                               Stop{27, 199, 219}, Stop{36, 236, 166}, Stop{113, 254, 95},
                               Stop{180, 247, 54}, Stop{232, 213, 58}, Stop{254, 161, 49},
                               Stop{242, 93, 19},  Stop{202, 42, 4},   Stop{122, 4, 3}};
constexpr std::array kGrey = {Stop{8, 8, 8}, Stop{250, 250, 250}};
constexpr std::array kHeat = {Stop{10, 0, 0},     Stop{110, 10, 6},   Stop{190, 40, 8},
                              Stop{236, 104, 16}, Stop{252, 178, 56}, Stop{255, 234, 140},
                              Stop{255, 255, 244}};

constexpr std::array kMaps = {
    ColourMap{"terrain", "green lowland to white peaks",
              [](float x) { return between(kTerrain, x); }},
    ColourMap{"viridis", "dark blue to yellow, even in brightness",
              [](float x) { return between(kViridis, x); }},
    ColourMap{"turbo", "the rainbow, smoothed", [](float x) { return between(kTurbo, x); }},
    ColourMap{"grey", "black to white", [](float x) { return between(kGrey, x); }},
    ColourMap{"heat", "black, red, yellow, white", [](float x) { return between(kHeat, x); }}};

constexpr std::array kClasses = {
    Stop{150, 150, 150}, Stop{180, 180, 180}, Stop{166, 124, 82},  Stop{150, 190, 90},
    Stop{88, 160, 70},   Stop{36, 116, 52},   Stop{204, 84, 68},   Stop{120, 60, 120},
    Stop{240, 200, 60},  Stop{60, 130, 200},  Stop{120, 110, 100}, Stop{100, 100, 110},
    Stop{220, 220, 150}, Stop{230, 150, 40},  Stop{240, 120, 60},  Stop{90, 80, 160},
    Stop{200, 160, 220}, Stop{170, 170, 120}, Stop{220, 60, 120}};

}  // namespace

std::span<const ColourMap> colour_maps() { return kMaps; }

const ColourMap& colour_map(std::string_view name) {
  std::string names;
  for (const ColourMap& map : kMaps) {
    if (name == map.name) return map;
    names += std::string(" ") + map.name;
  }
  throw std::invalid_argument("no colour map is called '" + std::string(name) + "'; maps:" + names);
}

glm::vec3 brightness(float x) { return glm::vec3(x); }

glm::vec3 classification_colour(unsigned code) {
  if (code < kClasses.size()) return linear(kClasses[code]);
  // Steps of the golden ratio round the rainbow never come close to the last few.
  const float turns = 0.618034F * static_cast<float>(code % 256);
  return between(kTurbo, turns - static_cast<float>(static_cast<int>(turns)));
}

}  // namespace delray::scenes
