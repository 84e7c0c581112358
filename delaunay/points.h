// Points as they are read, and as algorithms see them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace delray::delaunay {

// Points of a file, in the order of its rows. Row i of an attribute belongs to positions[i]; an
// attribute that the file does not have is empty.
struct PointCloud {
  bool has_z = false;                        // otherwise every z is 0
  std::vector<glm::dvec3> positions;         // exactly as written in the file
  std::vector<glm::u8vec4> colours;          // sRGB
  std::vector<float> intensity;              // 0 .. 1
  float intensity_unit = 1;                  // that 1 stands for in the file; 1: files differ
  std::vector<std::uint8_t> classification;  // LAS classes
  std::vector<std::uint8_t> returns;         // of LAS: the return's number | how many << 4
  bool geographic = false;                   // x and y are longitude and latitude in degrees
  std::vector<std::string> warnings;         // what the file has and the points have not

  std::size_t size() const { return positions.size(); }
};

// Read-only view of n points whose coordinates lie `stride` bytes apart: coordinate k of point i is
// the Scalar at data + i * stride + k * sizeof(Scalar).
template <class Scalar>
struct PointView {
  const std::byte* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;

  std::size_t size() const { return count; }
  // Coordinate k of point i. REQUIRES: i < count.
  Scalar operator()(std::size_t i, int k) const {
    return reinterpret_cast<const Scalar*>(data + i * stride)[k];
  }
};

// The points of a container of GLM vectors or std::arrays. The container must outlive the view.
template <class Point>
auto view(const std::vector<Point>& points) {
  using Scalar = typename Point::value_type;
  return PointView<Scalar>{reinterpret_cast<const std::byte*>(points.data()), points.size(),
                           sizeof(Point)};
}

}  // namespace delray::delaunay
