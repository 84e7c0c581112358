// PLY (Turk 1994): ASCII and binary of either byte order, any properties in any order.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "delaunay/files/ply.h"
#include "delaunay/files/point_readers.h"
#include "delaunay/files/quantity.h"

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

// Where the quantities are: property[q] is a property of the element, or -1.
using Columns = std::array<int, kQuantities>;

Columns find_columns(const PlyElement& element) {
  Columns columns;
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

std::uint8_t to_byte(double value) {
  return value > 0 ? static_cast<std::uint8_t>(std::round(std::min(value, 255.0))) : 0;
}

// A cloud under construction: rows may be set from several threads.
class Vertices {
 public:
  Vertices(const PlyElement& element, const Columns& columns) : columns_(columns) {
    cloud.has_z = columns[kZ] >= 0;
    cloud.positions.resize(element.count);
    const bool coloured = columns[kRed] >= 0 && columns[kGreen] >= 0 && columns[kBlue] >= 0;
    if (coloured) cloud.colours.resize(element.count);
    if (columns[kIntensity] >= 0) cloud.intensity.resize(element.count);
    if (columns[kClass] >= 0) cloud.classification.resize(element.count);
    for (int q = 0; q < kQuantities; ++q) {
      if (columns[q] >= 0) range_[q] = full_range(element.properties[columns[q]].type);
    }
  }

  // False if a coordinate is not finite.
  bool set(std::size_t i, const std::array<double, kQuantities>& values) {
    cloud.positions[i] = {values[kX], values[kY], values[kZ]};
    if (!cloud.colours.empty()) {
      const auto channel = [&](Quantity q) { return to_byte(values[q] / range_[q] * 255); };
      const std::uint8_t alpha = columns_[kAlpha] >= 0 ? channel(kAlpha) : 255;
      cloud.colours[i] = {channel(kRed), channel(kGreen), channel(kBlue), alpha};
    }
    if (!cloud.intensity.empty()) {
      cloud.intensity[i] = static_cast<float>(values[kIntensity] / range_[kIntensity]);
    }
    if (!cloud.classification.empty()) cloud.classification[i] = to_byte(values[kClass]);
    return std::isfinite(values[kX]) && std::isfinite(values[kY]) && std::isfinite(values[kZ]);
  }

  PointCloud cloud;

 private:
  Columns columns_;
  std::array<double, kQuantities> range_{};
};

std::string at_vertex(std::size_t i) { return "vertex " + std::to_string(i); }

void read_ascii(const Input& input, const PlyElement& element, const Columns& columns,
                TextPlace begin, Vertices& vertices) {
  std::vector<int> quantity_of(element.properties.size(), -1);
  for (int q = 0; q < kQuantities; ++q) {
    if (columns[q] >= 0) quantity_of[columns[q]] = q;
  }
  const RowIndex rows = index_rows(input, begin, element.count, is_data_row);
  for_each_row(input, rows, is_data_row, [&](std::size_t i, Fields& fields) {
    std::array<double, kQuantities> values{};
    for (std::size_t j = 0; j < element.properties.size(); ++j) {
      std::string_view skipped;
      if (quantity_of[j] >= 0) {
        values[quantity_of[j]] = fields.number();
      } else if (element.properties[j].count_type) {
        const std::int64_t length = fields.integer();
        for (std::int64_t k = 0; k < length; ++k) {
          if (!fields.next(skipped)) fields.fail("the list ends too early");
        }
      } else if (!fields.next(skipped)) {
        fields.fail("the line ends too early");
      }
    }
    vertices.set(i, values);
  });
}

void read_binary_with_lists(const Input& input, const PlyHeader& header, const PlyElement& element,
                            const Columns& columns, std::size_t byte, Vertices& vertices) {
  std::vector<PlyValues> row(element.properties.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    byte = read_ply_row(input, header.encoding, element, byte, row);
    std::array<double, kQuantities> values{};
    for (int q = 0; q < kQuantities; ++q) {
      const int j = columns[q];
      if (j >= 0) values[q] = ply_value(row[j].data, element.properties[j].type, header.encoding);
    }
    if (!vertices.set(i, values)) fail(input, at_vertex(i), "not a finite number");
  }
}

void read_binary(const Input& input, const PlyHeader& header, const PlyElement& element,
                 const Columns& columns, std::size_t byte, Vertices& vertices) {
  struct Source {
    int quantity;
    std::size_t offset;
    PlyType type;
  };
  std::vector<Source> sources;
  std::size_t offset = 0;
  for (std::size_t j = 0; j < element.properties.size(); ++j) {
    const auto quantity = std::ranges::find(columns, static_cast<int>(j)) - columns.begin();
    const PlyType type = element.properties[j].type;
    if (quantity < kQuantities) sources.push_back({static_cast<int>(quantity), offset, type});
    offset += ply_size(type);
  }
  const std::size_t stride = offset;
  constexpr std::size_t kGrain = 16384;  // about 0.2 ms
  const std::size_t none = element.count;
  const std::size_t bad = parallel::parallel_reduce(
      0, element.count, kGrain, none,
      [&](std::size_t first, std::size_t last) {
        std::size_t first_bad = none;
        for (std::size_t i = first; i < last; ++i) {
          const char* row = input.content.data() + byte + i * stride;
          std::array<double, kQuantities> values{};
          for (const Source& source : sources) {
            values[source.quantity] = ply_value(row + source.offset, source.type, header.encoding);
          }
          if (!vertices.set(i, values)) first_bad = std::min(first_bad, i);
        }
        return first_bad;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (bad != none) fail(input, at_vertex(bad), "not a finite number");
}

void normalise(std::vector<float>& intensity) {
  float top = 1;
  for (float& value : intensity) {
    value = std::isfinite(value) ? std::max(value, 0.0F) : 0;
    top = std::max(top, value);
  }
  for (float& value : intensity) value /= top;
}

std::size_t find_element(const Input& input, const PlyHeader& header, std::string_view name) {
  const auto found = std::ranges::find(header.elements, name, &PlyElement::name);
  if (found == header.elements.end()) {
    fail(input, "", "the header has no element \"" + std::string(name) + "\"");
  }
  return static_cast<std::size_t>(found - header.elements.begin());
}

PointCloud read_vertices(const Input& input, const PlyHeader& header) {
  const std::size_t number = find_element(input, header, "vertex");
  const PlyElement& element = header.elements[number];
  const Columns columns = find_columns(element);
  if (columns[kX] < 0 || columns[kY] < 0) fail(input, "", "the vertices have no x or no y");
  const TextPlace begin = ply_element_start(input, header, number);
  input.require_points(element.count);
  Vertices vertices(element, columns);
  if (header.encoding == PlyEncoding::ascii) {
    read_ascii(input, element, columns, begin, vertices);
  } else if (element.has_lists()) {
    read_binary_with_lists(input, header, element, columns, begin.byte, vertices);
  } else {
    read_binary(input, header, element, columns, begin.byte, vertices);
  }
  normalise(vertices.cloud.intensity);
  const auto edges = std::ranges::find(header.elements, "edge", &PlyElement::name);
  if (edges != header.elements.end() && edges->count > 0) {
    vertices.cloud.warnings.push_back(edges_left_out(edges->count));
  }
  return std::move(vertices.cloud);
}

std::uint32_t to_vertex(const Input& input, std::size_t face, double value, std::size_t vertices) {
  const bool known = value >= 0 && value < static_cast<double>(vertices);
  if (!known || value != std::floor(value)) {
    fail(input, "face " + std::to_string(face), "refers to a vertex that is not there");
  }
  return static_cast<std::uint32_t>(value);
}

void check_triangle(const Input& input, std::size_t face, std::size_t corners) {
  if (corners != 3) {
    fail(input, "face " + std::to_string(face),
         "has " + std::to_string(corners) + " corners; a triangle is expected");
  }
}

std::vector<std::uint32_t> read_ascii_faces(const Input& input, const PlyElement& element,
                                            std::size_t list, TextPlace begin,
                                            std::size_t vertices) {
  input.require_memory(element.count * 3 * sizeof(std::uint32_t));
  std::vector<std::uint32_t> result(element.count * 3);
  const RowIndex rows = index_rows(input, begin, element.count, is_data_row);
  for_each_row(input, rows, is_data_row, [&](std::size_t i, Fields& fields) {
    for (std::size_t j = 0; j <= list; ++j) {
      const bool is_list = element.properties[j].count_type.has_value();
      const std::int64_t length = is_list ? fields.integer() : 1;
      if (j == list) check_triangle(input, i, static_cast<std::size_t>(length));
      for (std::int64_t k = 0; k < length; ++k) {
        const double value = fields.number();
        if (j == list) result[i * 3 + k] = to_vertex(input, i, value, vertices);
      }
    }
  });
  return result;
}

std::vector<std::uint32_t> read_binary_faces(const Input& input, const PlyHeader& header,
                                             const PlyElement& element, std::size_t list,
                                             std::size_t byte, std::size_t vertices) {
  std::vector<std::uint32_t> result;
  input.require_memory(element.count * 3 * sizeof result[0]);
  result.reserve(element.count * 3);
  std::vector<PlyValues> row(element.properties.size());
  const PlyType type = element.properties[list].type;
  for (std::size_t i = 0; i < element.count; ++i) {
    byte = read_ply_row(input, header.encoding, element, byte, row);
    check_triangle(input, i, row[list].count);
    for (std::size_t k = 0; k < 3; ++k) {
      const char* data = row[list].data + k * ply_size(type);
      result.push_back(to_vertex(input, i, ply_value(data, type, header.encoding), vertices));
    }
  }
  return result;
}

}  // namespace

PointCloud read_ply_points(const Input& input) {
  return read_vertices(input, parse_ply_header(input));
}

PointMesh read_ply_mesh(const Input& input) {
  const PlyHeader header = parse_ply_header(input);
  PointMesh mesh;
  mesh.points = read_vertices(input, header);
  const std::size_t number = find_element(input, header, "face");
  const PlyElement& element = header.elements[number];
  const auto list = std::ranges::find_if(element.properties, [](const PlyProperty& property) {
    const bool indices = property.name == "vertex_indices" || property.name == "vertex_index";
    return indices && property.count_type;
  });
  if (list == element.properties.end()) fail(input, "", "the faces have no vertex_indices");
  const auto column = static_cast<std::size_t>(list - element.properties.begin());
  const TextPlace begin = ply_element_start(input, header, number);
  mesh.triangulation.vertices =
      header.encoding == PlyEncoding::ascii
          ? read_ascii_faces(input, element, column, begin, mesh.points.size())
          : read_binary_faces(input, header, element, column, begin.byte, mesh.points.size());
  return mesh;
}

}  // namespace delray::delaunay
