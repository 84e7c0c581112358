// One tile: its points, those of others that it knows, and whom it must tell of its own.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "delaunay/tiles.h"
#include "delaunay/tiles/box_tree.h"
#include "delaunay/tiles/walls.h"
#include "geometry/box.h"

namespace delray::delaunay {

// What all other tiles are told of a tile from the start. With the extreme points nobody's hull
// sees half of the world.
struct TileSummary {
  geometry::Box3d box;  // tight; empty without points; z is 0 in 2D
  RowPoint extremes[6];
  std::uint64_t extreme_count = 0;
};

// Tiles by number, and where their boxes are.
struct TileBoxes {
  explicit TileBoxes(std::span<const TileSummary> summaries);

  BoxTree<glm::dvec2> plane;
  BoxTree<glm::dvec3> space;
};

// A point for a tile.
struct TileMessage {
  std::uint64_t tile = 0;
  std::uint32_t point = 0;  // its place among the known ones of the sender
  auto operator<=>(const TileMessage&) const = default;
};

// Triangulates the points that it knows and finds simplices that points of other tiles could be in
// conflict with: whose closed circumscribed ball (for facets of the hull, the closed half-space
// beyond) touches their boxes. Those tiles are told of its own vertices of such a simplex. When
// nobody has anything new to tell, the stars of all own vertices are final.
//
// Proof: let a point conflict with a simplex of own vertex v. Shrink the ball towards v until one
// point q of all is left on it. The owner of q was told of v, as the ball touches its box; the ball
// through v and q is empty, so the owner has the edge vq, in a simplex whose ball holds v and so
// touches this tile's box: it has told this tile of q.
//
// Simplices that touch no other tile's box are settled from the start, most of them as a rule: they
// are given away after the first look, with their vertices inside, and what the halo changes is the
// rest (walls.h).
class HaloTile {
 public:
  // `own` by ascending rows.
  HaloTile(int tile, int dim, std::vector<RowPoint> own);

  TileSummary summary() const;
  // Takes the points in that it does not know.
  void add_halo(std::span<const RowPoint> points);
  // Triangulates unless it knows nothing new.
  void triangulate(const Options& options);
  // The own points that other tiles must be told of and have not been; ascending.
  std::vector<TileMessage> find_messages(const TileBoxes& boxes,
                                         std::span<const TileSummary> tiles);
  const RowPoint& point(std::uint32_t known) const { return known_[known]; }
  // Gives the simplices away that can change no more, and forgets the points that only they need.
  // What find_messages() gave numbers other points then. For after find_messages().
  void settle(TiledTriangulation& result);
  // Appends the simplices that are this tile's and were not given away, and its statistics.
  void collect(const Options& options, TiledTriangulation& result);

 private:
  template <int D>
  std::vector<TileMessage> messages_of_simplices(const BoxTree<glm::vec<D, double>>& boxes);
  // Of equal own points the one with the lowest row, which represents them.
  std::vector<std::uint32_t> distinct_own() const;
  bool is_own(std::uint32_t known) const { return known < own_; }
  bool lowest_is_own(std::span<const std::uint32_t> rows) const;
  void give(std::span<const std::uint32_t> rows, TiledTriangulation& result);
  void give_settled(TiledTriangulation& result);

  int tile_, dim_;
  std::vector<RowPoint> known_;  // own points first
  std::uint32_t own_;
  geometry::Box3d box_;  // of its own points; z is 0 in 2D
  std::unordered_set<std::uint64_t> halo_rows_;
  bool changed_ = true, settled_ = false;
  Triangulation triangulation_;
  std::vector<std::uint32_t> mates_;  // of its facets
  Walls walls_;
  Walls::Outside outside_;
  // Which simplices, and which facets of outside_.hull, other tiles must know of.
  std::vector<std::uint8_t> simplex_concerns_, facet_concerns_;
  std::unordered_set<std::uint64_t> told_;  // tile << 32 | point
  TileStatistics statistics_;
};

}  // namespace delray::delaunay
