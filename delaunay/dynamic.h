// A Delaunay triangulation whose points come and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Points of the plane (D = 2) or of space (3). Each inserted point gets the next row number, from
// 0; rows of removed points are not used again. At any moment the simplices are those that
// triangulate() gives for the live points, whatever came and went before.
template <int D>
class DynamicTriangulation {
 public:
  using Point = glm::vec<D, double, glm::defaultp>;

  DynamicTriangulation();
  ~DynamicTriangulation();
  DynamicTriangulation(DynamicTriangulation&& other) noexcept;
  DynamicTriangulation& operator=(DynamicTriangulation&& other) noexcept;

  // Returns the row. Expected O(n^(1/3)) for evenly spread points, and O(1) for a point near the
  // one before. -0 equals 0.
  //
  // Errors: std::invalid_argument for a coordinate that is not finite, or beyond 2^29 points (2D)
  // or 2^27 (3D).
  std::uint32_t insert(const Point& point);
  // Inserts a batch, in an order of its own that is fast; returns the row of the first, the others
  // follow. The first D coordinates count. Errors: as above; then nothing is inserted.
  std::uint32_t insert(PointView<double> points);

  // Removes the point of a row. Beside the location O(d^2) for a vertex of d neighbours in 2D; in
  // 3D the cost of a triangulation of these. Returns false if the row was not live.
  bool remove(std::uint32_t row);

  std::size_t size() const;  // live rows
  bool is_live(std::uint32_t row) const;

  // The simplices of the live points; vertices are rows, of equal points the lowest live one.
  // O(simplices).
  Triangulation triangulation() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class DynamicTriangulation<2>;
extern template class DynamicTriangulation<3>;

}  // namespace delray::delaunay
