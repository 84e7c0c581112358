// The triangulation of what a region knows, and what of it can change no more.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/mesh/array.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/region.h"
#include "delaunay/tiles/tile_boxes.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Simplices that can change no more.
struct FinalSimplices {
  Array<RowPoint> points;          // if simplices were asked for
  Array<std::uint32_t> simplices;  // likewise: dim + 1 places in `points` each
  std::uint64_t count = 0;         // of simplices
  std::uint64_t hull_facets = 0;
  Hash128 hash = {};  // by the rows of points, if it was asked for
};

// What is wanted of them.
struct FinalsWish {
  bool simplices = true;  // and not only their number
  bool hash = true;
};

// A point for a tile.
struct TileMessage {
  std::uint64_t tile = 0;
  RowPoint point;
};

// Points without walls take little more than triangulating them: only balls along the border are
// looked at. Memory: 80 bytes a point in 2D and 300 in 3D while triangulating, besides the points.
template <int D>
class RegionMesh {
 public:
  // Triangulates. The threads are those of the options, in an arena of its own or the caller's.
  RegionMesh(Region&& region, const Options& options);

  // Distinct points, those of the halo included.
  std::uint64_t distinct() const { return distinct_; }
  // Simplices that the triangulation has, those behind walls included.
  std::uint64_t simplices() const { return simplices_; }

  // Finds which simplices and facets of the hull others could change. Before the next three.
  void find_open(const OtherTiles& others);
  // For each open simplex with an own vertex and each other tile whose box its ball touches, its
  // own vertices, and likewise of facets of the hull. In no order, some several times.
  //
  // Proof that it is enough: let a point conflict with a simplex of own vertex v. Shrink the ball
  // towards v until one point q of all is left on it. The owner of q was told of v, as the ball
  // touches its box; the ball through v and q is empty, so the owner has the edge vq, in a simplex
  // whose ball holds v and so touches a box of this region: it has told this region of q.
  //
  // If all own points lie on one line or plane anything may be a neighbour, and each is for all.
  std::vector<TileMessage> find_messages(const OtherTiles& others) const;
  // What is not open, without what was given away before. Ends the mesh; rest() before it.
  FinalSimplices take_settled(const FinalsWish& wish);
  // What is open, with all of the halo, and the walls around it.
  Region rest() const;

  // The simplices whose vertex with the lowest row is an own one, without what was given away
  // before. Ends the mesh.
  FinalSimplices take_own(const FinalsWish& wish);

 private:
  using Point = glm::vec<D, double>;
  using Facet = std::array<VertexNumber, D>;
  using Corners = std::array<VertexNumber, D + 1>;
  // Of a slot: no simplex or one behind walls; one that nothing is known of yet, which is settled
  // in the end; one on its way from there; one that is open.
  enum State : std::uint8_t { kNone, kSettled, kTested, kOpen };
  struct HullFacet {
    Facet corners;
    SimplexNumber simplex;  // that has it, or kNoSimplex for a wall with nothing beyond
    bool open = true;
  };
  static constexpr SimplexNumber kNoSimplex = 0xffffffffU;

  void find_outside(const std::vector<Facet>& walls);
  std::vector<SimplexNumber> border() const;
  bool is_open(SimplexNumber simplex, const OtherTiles& others,
               const geometry::Box<Point>& box) const;
  void spread_open(const OtherTiles& others, const geometry::Box<Point>& box);
  Corners corners(SimplexNumber simplex) const;
  Facet facet(SimplexNumber simplex, unsigned opposite) const;
  bool is_flat() const { return simplices_ == 0 && !has_walls_; }
  bool is_own(VertexNumber vertex) const { return is_own_.empty() || is_own_[vertex] != 0; }
  template <std::size_t N>
  bool has_own(const std::array<VertexNumber, N>& vertices) const;
  template <std::size_t N>
  bool all_own(const std::array<VertexNumber, N>& vertices) const;
  template <std::size_t N>
  bool lowest_is_own(const std::array<VertexNumber, N>& vertices) const;
  template <std::size_t N>
  std::array<Point, N> positions(const std::array<VertexNumber, N>& vertices) const;
  RowPoint point(VertexNumber vertex) const { return known_[place_of(vertex)]; }
  std::size_t place_of(VertexNumber vertex) const {
    return rows_.size() == 0 ? vertex : rows_[vertex];
  }
  template <class Wanted>
  FinalSimplices take(const Wanted& wanted, const FinalsWish& wish);
  Region flat_rest() const;

  Options options_;
  Mesh<D> mesh_;
  std::vector<RowPoint> known_;       // its own points first
  std::size_t known_own_ = 0;         // how many these are
  std::size_t vertices_ = 0;          // of the mesh
  Array<std::uint32_t> rows_;         // of vertices the place in known_; empty if it is the number
  std::vector<std::uint8_t> is_own_;  // of vertices; empty if all are
  std::uint64_t distinct_ = 0, simplices_ = 0;
  bool has_walls_ = false;
  std::vector<std::uint8_t> states_;  // of the mesh's slots
  std::vector<HullFacet> hull_;
};

extern template class RegionMesh<2>;
extern template class RegionMesh<3>;

}  // namespace delray::delaunay
