// The table of attributes, each with a number or a code.
#include "apps/input/point_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "apps/input/inliers.h"
#include "image/srgb.h"
#include "scenes/colour_map.h"

namespace delray::apps {
namespace {

using Cloud = delaunay::PointCloud;
using Scale = std::optional<scenes::ColourScale>;

glm::vec4 own_colour(const Cloud& points, std::size_t i, const AttributeValues&) {
  const glm::u8vec4& c = points.colours[i];
  return {image::decode_srgb(c.r), image::decode_srgb(c.g), image::decode_srgb(c.b), 1.0F};
}

glm::vec4 intensity_colour(const Cloud& points, std::size_t i, const AttributeValues& all) {
  const auto [low, high] = all.range;
  const float t =
      std::clamp((points.intensity[i] - low) / std::max(high - low, 1e-30F), 0.0F, 1.0F);
  return {scenes::brightness(t), 1.0F};
}

// The codes that occur, ascending, with their names and colours.
template <class Name, class Colour>
Scale classes_of(const AttributeValues& all, const char* title, Name&& name, Colour&& colour) {
  scenes::ColourScale scale;
  scale.title = title;
  for (unsigned code = 0; code < all.occurs.size(); ++code)
    if (all.occurs[code]) scale.classes.push_back({name(code), colour(code)});
  return scale;
}

// After ASPRS, LAS Specification 1.4 R15, table 17.
std::string class_name(unsigned code) {
  constexpr std::array kNames = {
      "never classified",  "unclassified",    "ground",         "low vegetation",
      "medium vegetation", "high vegetation", "building",       "low noise",
      "key point",         "water",           "rail",           "road",
      "overlap",           "wire guard",      "wire conductor", "tower",
      "connector",         "bridge deck",     "high noise"};
  return fmt::format("{}{}{}", code, code < kNames.size() ? " " : "",
                     code < kNames.size() ? kNames[code] : "");
}

std::string return_name(unsigned returns) {
  return fmt::format("{} of {}", returns & 15U, returns >> 4);
}

// Blue the only one, from green to red the first to the last of several.
glm::vec3 return_colour(unsigned returns) {
  const unsigned number = returns & 15U, count = returns >> 4;
  const scenes::ColourMap& map = scenes::colour_map("turbo");
  if (count <= 1) return map.colour(0.15F);
  const float share =
      number <= 1 ? 0.0F : static_cast<float>(number - 1) / static_cast<float>(count - 1);
  return map.colour(0.4F + 0.5F * std::min(share, 1.0F));
}

const std::array kAttributes = {
    PointAttribute{"rgb", "colours", [](const Cloud& points) { return !points.colours.empty(); },
                   nullptr, nullptr, own_colour, [](const AttributeValues&) { return Scale(); },
                   [](const Cloud& points, std::size_t i) {
                     const glm::u8vec4& c = points.colours[i];
                     return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
                   }},
    PointAttribute{"intensity", "intensity",
                   [](const Cloud& points) { return !points.intensity.empty(); },
                   [](const Cloud& points, std::size_t i) { return points.intensity[i]; }, nullptr,
                   intensity_colour,
                   [](const AttributeValues& all) -> Scale {
                     return scenes::ColourScale{"intensity",
                                                all.range.first * all.unit,
                                                all.range.second * all.unit,
                                                scenes::brightness,
                                                {}};
                   },
                   [](const Cloud& points, std::size_t i) {
                     return fmt::format("{:.6g}", points.intensity[i] * points.intensity_unit);
                   }},
    PointAttribute{
        "classification", "classification",
        [](const Cloud& points) { return !points.classification.empty(); }, nullptr,
        [](const Cloud& points, std::size_t i) { return points.classification[i]; },
        [](const Cloud& points, std::size_t i, const AttributeValues&) {
          return glm::vec4(scenes::classification_colour(points.classification[i]), 1.0F);
        },
        [](const AttributeValues& all) {
          return classes_of(all, "class", class_name, scenes::classification_colour);
        },
        [](const Cloud& points, std::size_t i) { return class_name(points.classification[i]); }},
    PointAttribute{
        "returns", "return numbers", [](const Cloud& points) { return !points.returns.empty(); },
        nullptr, [](const Cloud& points, std::size_t i) { return points.returns[i]; },
        [](const Cloud& points, std::size_t i, const AttributeValues&) {
          return glm::vec4(return_colour(points.returns[i]), 1.0F);
        },
        [](const AttributeValues& all) {
          return classes_of(all, "return", return_name, return_colour);
        },
        [](const Cloud& points, std::size_t i) { return return_name(points.returns[i]); }},
};

}  // namespace

std::span<const PointAttribute> point_attributes() { return kAttributes; }

const PointAttribute* find_point_attribute(std::string_view name) {
  const auto found = std::ranges::find(kAttributes, name, &PointAttribute::name);
  return found == kAttributes.end() ? nullptr : &*found;
}

AttributeValues attribute_values(const PointAttribute& attribute, const Cloud& points) {
  AttributeValues values;
  values.unit = points.intensity_unit;
  if (attribute.number != nullptr) {
    values.range =
        usual_range(points.size(), [&](std::size_t i) { return attribute.number(points, i); });
  }
  for (std::size_t i = 0; attribute.code != nullptr && i < points.size(); ++i)
    values.occurs[attribute.code(points, i)] = true;
  return values;
}

}  // namespace delray::apps
