// Natural neighbours in the plane, of the triangles whose circumcircles hold a place.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/interpolate.h"

namespace delray::delaunay::internal {

// A triangle whose circumcircle holds the place.
struct CavityTriangle {
  std::array<std::uint32_t, 3> rows;
  std::array<glm::dvec2, 3> at;  // counterclockwise
  std::uint8_t hull = 0;         // bit k: nothing lies beyond the edge opposite to corner k
};

// A vertex and where it is.
struct PlacedVertex {
  std::uint32_t row;
  glm::dvec3 at;
};

// Of a place on the edge between two vertices: what it is nearer to counts more.
std::vector<NaturalNeighbour> shares_of_length(const PlacedVertex& a, const PlacedVertex& b,
                                               const glm::dvec3& q);

// The shares of all corners, by ascending rows, but on an edge of the hull those of its ends. Puts
// the triangles into an order that depends on nothing but them, so that shares are the same to the
// bit whichever way they were found; what counts of rows is their order. O(k log k).
//
// REQUIRES: all triangles of a Delaunay triangulation that hold q strictly in their circles, which
// is in one of them and no vertex.
std::vector<NaturalNeighbour> shares_in_plane(std::vector<CavityTriangle>& cavity,
                                              const glm::dvec2& q);

}  // namespace delray::delaunay::internal
