// The vertices of a PLY as points.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "delaunay/files/ply.h"
#include "delaunay/files/quantity.h"
#include "delaunay/points.h"

namespace delray::delaunay {

// Where the quantities are: columns[q] is a property of the element, or -1.
using PlyColumns = std::array<int, kQuantities>;
PlyColumns find_ply_columns(const PlyElement& element);

// A cloud under construction: rows may be set from several threads. Its intensity is not above 0 to
// 1 where the property is a whole number, else as in the file, but never below 0.
class PlyVertices {
 public:
  PlyVertices(const PlyElement& element, const PlyColumns& columns, std::size_t rows);

  // False if a coordinate is not finite.
  bool set(std::size_t i, const std::array<double, kQuantities>& values);

  PointCloud cloud;

 private:
  PlyColumns columns_;
  std::array<double, kQuantities> range_{};
};

// Reads rows without lists, from binary ones behind each other, into `vertices`, in parallel.
// Returns the first that is not finite, or how many there are.
std::size_t read_ply_rows(const PlyElement& element, PlyEncoding encoding,
                          const PlyColumns& columns, std::string_view rows, PlyVertices& vertices);

}  // namespace delray::delaunay
