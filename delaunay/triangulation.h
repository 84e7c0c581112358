// A Delaunay triangulation as rows of points, and its identity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace delray::delaunay {

// The finite simplices of a Delaunay triangulation. Vertices are rows of the input, from 0; of
// equal points the lowest row represents.
struct Triangulation {
  int dim = 2;                          // 2: triangles, 3: tetrahedra, up to 6
  std::vector<std::uint32_t> vertices;  // dim + 1 per simplex, positively oriented
  std::uint64_t distinct = 0;           // distinct points of the input
  std::uint64_t hull_facets = 0;        // of the convex hull: edges (2D), triangles (3D), ...

  std::size_t size() const { return vertices.size() / (static_cast<std::size_t>(dim) + 1); }
};

// Identity of a set of simplices: the sum modulo 2^128 of the XXH3 128-bit hashes of
// the simplices, each hashed as its vertices in ascending order as little-endian uint64.
struct Hash128 {
  std::uint64_t high = 0, low = 0;
  bool operator==(const Hash128&) const = default;
};
Hash128 operator+(const Hash128& a, const Hash128& b);
std::string to_string(const Hash128& hash);  // 32 lower-case hex digits, high half first

// Parallel, without sorting. O(simplices).
Hash128 hash(const Triangulation& triangulation);
// Of simplices that are given by dim + 1 rows each; hashes of parts add up to that of the whole.
// REQUIRES: dim is from 2 to 6.
Hash128 hash(int dim, std::span<const std::uint64_t> vertices);

}  // namespace delray::delaunay
