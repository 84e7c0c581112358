// The names that properties of vertices have in PLY files, and their values as quantities of
// points.
#include "delaunay/files/ply_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

struct PropertyName {
  std::string_view name;
  Quantity quantity;
};
constexpr std::array kPropertyNames = {
    PropertyName{"x", kX},
    PropertyName{"y", kY},
    PropertyName{"z", kZ},
    PropertyName{"red", kRed},
    PropertyName{"r", kRed},
    PropertyName{"diffuse_red", kRed},
    PropertyName{"green", kGreen},
    PropertyName{"g", kGreen},
    PropertyName{"diffuse_green", kGreen},
    PropertyName{"blue", kBlue},
    PropertyName{"b", kBlue},
    PropertyName{"diffuse_blue", kBlue},
    PropertyName{"alpha", kAlpha},
    PropertyName{"intensity", kIntensity},
    PropertyName{"scalar_intensity", kIntensity},
    PropertyName{"scalar_Intensity", kIntensity},
    PropertyName{"classification", kClass},
    PropertyName{"scalar_classification", kClass},
    PropertyName{"scalar_Classification", kClass},
};

// The value of a property at its full range: 1 for floating point.
double full_range(PlyType type) {
  switch (type) {
    case PlyType::int8:
      return std::numeric_limits<std::int8_t>::max();
    case PlyType::uint8:
      return std::numeric_limits<std::uint8_t>::max();
    case PlyType::int16:
      return std::numeric_limits<std::int16_t>::max();
    case PlyType::uint16:
      return std::numeric_limits<std::uint16_t>::max();
    case PlyType::int32:
      return std::numeric_limits<std::int32_t>::max();
    case PlyType::uint32:
      return std::numeric_limits<std::uint32_t>::max();
    default:
      return 1;
  }
}

std::uint8_t to_byte_of(double value) {
  return value > 0 ? static_cast<std::uint8_t>(std::round(std::min(value, 255.0))) : 0;
}

}  // namespace

PlyColumns find_ply_columns(const PlyElement& element) {
  PlyColumns columns;
  columns.fill(-1);
  for (std::size_t j = 0; j < element.properties.size(); ++j) {
    if (element.properties[j].count_type) continue;
    for (const auto& [name, quantity] : kPropertyNames) {
      const bool first = columns[quantity] < 0;
      if (first && name == element.properties[j].name) columns[quantity] = static_cast<int>(j);
    }
  }
  return columns;
}

PlyVertices::PlyVertices(const PlyElement& element, const PlyColumns& columns, std::size_t rows)
    : columns_(columns) {
  cloud.has_z = columns[kZ] >= 0;
  cloud.positions.resize(rows);
  const bool coloured = columns[kRed] >= 0 && columns[kGreen] >= 0 && columns[kBlue] >= 0;
  if (coloured) cloud.colours.resize(rows);
  if (columns[kIntensity] >= 0) cloud.intensity.resize(rows);
  if (columns[kClass] >= 0) cloud.classification.resize(rows);
  for (int q = 0; q < kQuantities; ++q) {
    if (columns[q] >= 0) range_[q] = full_range(element.properties[columns[q]].type);
  }
  if (columns[kIntensity] >= 0) cloud.intensity_unit = static_cast<float>(range_[kIntensity]);
}

bool PlyVertices::set(std::size_t i, const std::array<double, kQuantities>& values) {
  cloud.positions[i] = {values[kX], values[kY], values[kZ]};
  if (!cloud.colours.empty()) {
    const auto channel = [&](Quantity q) { return to_byte_of(values[q] / range_[q] * 255); };
    const std::uint8_t alpha = columns_[kAlpha] >= 0 ? channel(kAlpha) : 255;
    cloud.colours[i] = {channel(kRed), channel(kGreen), channel(kBlue), alpha};
  }
  if (!cloud.intensity.empty()) {
    const auto intensity = static_cast<float>(values[kIntensity] / range_[kIntensity]);
    cloud.intensity[i] = std::isfinite(intensity) ? std::max(intensity, 0.0F) : 0;
  }
  if (!cloud.classification.empty()) cloud.classification[i] = to_byte_of(values[kClass]);
  return std::isfinite(values[kX]) && std::isfinite(values[kY]) && std::isfinite(values[kZ]);
}

std::size_t read_ply_rows(const PlyElement& element, PlyEncoding encoding,
                          const PlyColumns& columns, std::string_view rows, PlyVertices& vertices) {
  struct Source {
    int quantity;
    std::size_t offset;
    PlyType type;
  };
  std::vector<Source> sources;
  std::size_t stride = 0;
  for (std::size_t j = 0; j < element.properties.size(); ++j) {
    const auto quantity = std::ranges::find(columns, static_cast<int>(j)) - columns.begin();
    const PlyType type = element.properties[j].type;
    if (quantity < kQuantities) sources.push_back({static_cast<int>(quantity), stride, type});
    stride += ply_size(type);
  }
  constexpr std::size_t kGrain = 16384;  // about 0.2 ms
  const std::size_t none = rows.size() / stride;
  return parallel::parallel_reduce(
      0, none, kGrain, none,
      [&](std::size_t first, std::size_t last) {
        std::size_t first_bad = none;
        for (std::size_t i = first; i < last; ++i) {
          const char* row = rows.data() + i * stride;
          std::array<double, kQuantities> values{};
          for (const Source& source : sources) {
            values[source.quantity] = ply_value(row + source.offset, source.type, encoding);
          }
          if (!vertices.set(i, values)) first_bad = std::min(first_bad, i);
        }
        return first_bad;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

}  // namespace delray::delaunay
