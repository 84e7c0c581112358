// An order of triangles and vertices in which neighbours are close together.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Triangles in the runs that are compared.
inline constexpr std::uint64_t kTrianglesOfRun = 128;

// Sums over runs of triangles: the sides of a run's box, and the side of a square with its area.
struct RunSizes {
  double box = 0, square = 0;

  RunSizes operator+(const RunSizes& b) const { return {box + b.box, square + b.square}; }
};

// Of all runs of a mesh. O(triangles), parallel.
RunSizes sizes_of_runs(const Mesh& mesh);
// Whether order_for_locality leaves a mesh of such runs as it is without trying another order.
bool are_compact(const RunSizes& sizes);

// Orders triangles so that those that follow each other, by clusters of 128 and by vectors of 16,
// have small boxes: halved again and again along the longest side of the box of their centres (the
// k-d tree of Bentley 1975). Numbers vertices in the order in which triangles use them. Unless runs
// of triangles are about as compact as they are: renderers take runs of triangles together. Meshes
// of few triangles stay as they are. O(triangles log triangles).
//
// REQUIRES: indices are in range.
void order_for_locality(Mesh& mesh);

// Vertex i becomes what vertex old_number[i] was, with all attributes; triangles stay. Parallel.
void renumber_vertices(const std::vector<std::uint32_t>& old_number, Mesh& mesh);

}  // namespace delray::scenes::internal
