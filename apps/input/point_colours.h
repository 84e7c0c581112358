// Attributes of points, as texts and as the colours that they give them, for all at once or in
// parts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "delaunay/points.h"
#include "scenes/scene.h"

namespace delray::apps {

// What colours of some points need to know of all.
struct AttributeValues {
  std::pair<float, float> range{0, 1};  // between which a number runs: usual_range
  std::array<bool, 256> occurs{};       // codes that there are
  float unit = 1;                       // of the file, that numbers are in
};

// An attribute that colours tell. Point i is one of a cloud that has it.
struct PointAttribute {
  std::string_view name;  // as of --color-by
  const char* what;       // that points without it do not have: "colours"
  bool (*exists)(const delaunay::PointCloud& points);
  float (*number)(const delaunay::PointCloud& points, std::size_t i);       // null: none
  std::uint8_t (*code)(const delaunay::PointCloud& points, std::size_t i);  // null: none
  // Linear.
  glm::vec4 (*colour)(const delaunay::PointCloud& points, std::size_t i,
                      const AttributeValues& all);
  std::optional<scenes::ColourScale> (*scale)(const AttributeValues& all);
  std::string (*text)(const delaunay::PointCloud& points, std::size_t i);  // as people read it
};

std::span<const PointAttribute> point_attributes();

// Null for a name of anything else.
const PointAttribute* find_point_attribute(std::string_view name);

// Of all points.
AttributeValues attribute_values(const PointAttribute& attribute,
                                 const delaunay::PointCloud& points);

}  // namespace delray::apps
