// Finding the simplex that a point lies in by walking there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates/orientation.h"

namespace delray::delaunay {

// Where a point lies. In the plane: a finite triangle contains it, its boundary included; a ghost
// means that the point is strictly beyond the ghost's edge of the hull.
struct Place {
  SimplexNumber simplex;
  VertexNumber equal;  // the vertex with the same coordinates, or kInfiniteVertex
};

// Walks from `start` (live, finite or ghost) towards q: leaves a triangle by an edge that has q
// strictly on its other side, never by the one it came through, tried in random order, since a
// fixed order can go round in circles (Devillers, Pion, Teillaud 2002). `random` is the state of
// the choices and must not be 0. O(sqrt n) expected from anywhere, O(1) from nearby.
Place walk(const Mesh<2>& mesh, std::span<const glm::dvec2> points, SimplexNumber start,
           const glm::dvec2& q, std::uint32_t& random);

// Walks in space, and among the ghosts too, which `orientation` spreads over what is outside: the
// simplex contains q, its boundary included, in that sense. O(n^(1/3)) expected from anywhere.
// REQUIRES: the mesh is Delaunay (then no such walk goes round in circles; Edelsbrunner 1990).
Place walk(const Mesh<3>& mesh, const Orientation<3>& orientation, SimplexNumber start,
           const glm::dvec3& q, std::uint32_t& random);

}  // namespace delray::delaunay
