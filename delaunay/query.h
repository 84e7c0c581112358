// Queries of a finished triangulation: where a point lies, what is nearest to it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "delaunay/adjacency.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Keeps the adjacency of the triangulation, and refers to it and to its points, which must outlive
// it. Any number of threads may query at a time. Points of a query have z 0, or any, in 2D.
// Queries throw std::invalid_argument where a coordinate is not finite.
class Query {
 public:
  static constexpr std::uint32_t kNone = Adjacency::kNone;

  // O(n) expected, parallel. Throws std::invalid_argument for vertices that are no rows of points.
  // REQUIRES: a Delaunay triangulation of the points, all finite.
  Query(PointView<double> points, const Triangulation& triangulation);

  // A simplex that contains q, its boundary included, or kNone outside the hull; exact. Walks from
  // the nearest of n^(1/3) vertices (Muecke, Saias, Zhu 1999): O(n^(1/3)) expected for evenly
  // spread points.
  std::uint32_t locate(const glm::dvec3& q) const;
  // As above, walking from a simplex that is thought to be near, such as the previous result.
  // Throws std::invalid_argument for a simplex that does not exist; kNone: none is.
  std::uint32_t locate(const glm::dvec3& q, std::uint32_t near) const;

  // The vertex nearest to q by squared distances as doubles give them, or kNone if there are no
  // points. By steps from vertex to vertex from the simplex of q or the edge of the hull near it.
  // O(n) without simplices.
  std::uint32_t nearest(const glm::dvec3& q) const;

  const PointView<double>& points() const { return points_; }
  const Triangulation& triangulation() const { return triangulation_; }
  const Adjacency& adjacency() const { return adjacency_; }
  glm::dvec3 position(std::uint32_t row) const;  // z is 0 in 2D

 private:
  struct Stop {
    std::uint32_t simplex;  // where the walk ended
    bool inside;
  };
  Stop walk(const glm::dvec3& q, std::uint32_t start) const;
  std::uint32_t start_near(const glm::dvec3& q) const;

  PointView<double> points_;
  const Triangulation& triangulation_;
  Adjacency adjacency_;
};

}  // namespace delray::delaunay
