// PLY (Turk 1994): ASCII and binary of either byte order, any properties in any order.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "delaunay/files/ply_vertices.h"
#include "delaunay/files/point_readers.h"

namespace delray::delaunay {
namespace {

std::string at_vertex(std::size_t i) { return "vertex " + std::to_string(i); }

void read_ascii(const Input& input, const PlyElement& element, const PlyColumns& columns,
                TextPlace begin, PlyVertices& vertices) {
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
                            const PlyColumns& columns, std::size_t byte, PlyVertices& vertices) {
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
                 const PlyColumns& columns, std::size_t byte, PlyVertices& vertices) {
  const std::string_view rows = input.content.substr(byte, element.count * element.smallest_row());
  const std::size_t bad = read_ply_rows(element, header.encoding, columns, rows, vertices);
  if (bad != element.count) fail(input, at_vertex(bad), "not a finite number");
}

void normalise(PointCloud& cloud) {
  float top = 1;
  for (const float value : cloud.intensity) top = std::max(top, value);
  for (float& value : cloud.intensity) value /= top;
  cloud.intensity_unit *= top;
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
  const PlyColumns columns = find_ply_columns(element);
  if (columns[kX] < 0 || columns[kY] < 0) fail(input, "", "the vertices have no x or no y");
  const TextPlace begin = ply_element_start(input, header, number);
  input.require_points(element.count);
  PlyVertices vertices(element, columns, element.count);
  if (header.encoding == PlyEncoding::ascii) {
    read_ascii(input, element, columns, begin, vertices);
  } else if (element.has_lists()) {
    read_binary_with_lists(input, header, element, columns, begin.byte, vertices);
  } else {
    read_binary(input, header, element, columns, begin.byte, vertices);
  }
  normalise(vertices.cloud);
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
