// One triangulation made by many ranks, each of which holds a part of the points.
//
// Space is cut into tiles of about as many points. Each tile triangulates its points and those of
// other tiles that may share a simplex with them, its halo; then the star of every one of its
// points, the simplices around it, is as in the whole triangulation (Funke and Sanders 2017;
// Caraffa et al. 2019).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {

// A point and its row of the whole input.
struct RowPoint {
  glm::dvec3 position;  // z is carried along in 2D
  std::uint64_t row = 0;
};

// How points are cut into tiles, and how each is triangulated.
struct TileOptions {
  int tiles = 0;                       // at least one; 0: one for each rank
  std::string partition = "kd-split";  // of loadbalance::partitioners()
  Options triangulate = {};            // of each tile; its `dim` is that of all
};

// What a tile took.
struct TileStatistics {
  std::uint64_t points = 0;         // its own, equal ones included
  std::uint64_t halo = 0;           // those of other tiles that it was told of
  std::uint64_t sent = 0;           // its own that it told others of, once for each
  std::uint64_t simplices = 0;      // that its triangulations have, all rounds together
  std::uint64_t own_simplices = 0;  // of which it is the one that counts them
};

// A rank's part: the simplices whose lowest row is a point of one of its tiles.
struct TiledTriangulation {
  int dim = 2;
  std::vector<std::uint64_t> vertices;  // dim + 1 rows a simplex, positively oriented
  std::uint64_t distinct = 0;           // distinct points; the sum over ranks is that of all
  std::uint64_t hull_facets = 0;        // likewise
  std::vector<TileStatistics> tiles;    // of this rank's tiles
  TileStatistics shared;                // of what they leave together, if there are several
  int rounds = 0;                       // of telling other tiles of points
};

// Collective: the simplices of all ranks together are those that triangulate() gives for the points
// of all ranks, each on one rank. Points may lie on any rank, in any order; rows are distinct.
//
// A rank takes memory for its points, for their halos and for one tile's triangulation at a time,
// and O(tiles) besides. Points that all lie on one circle or sphere are in each other's halos, all
// of them.
//
// Errors: std::invalid_argument on all ranks for options that cannot be, and on the rank that has
// it for a coordinate that is not finite; those of triangulate().
TiledTriangulation triangulate_tiles(comm::Communicator& communicator,
                                     std::span<const RowPoint> points, const TileOptions& options);

}  // namespace delray::delaunay
