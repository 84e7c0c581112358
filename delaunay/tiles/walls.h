// The facets between the part of a tile's triangulation that nothing outside can change any more,
// which is given away, and the rest.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

// The rest is made anew when points arrive, of its own vertices alone: the whole triangulation
// restricted to it is a part of their triangulation, as its simplices have no point in conflict
// with them. What that makes of the part that was given away lies behind the walls.
class Walls {
 public:
  explicit Walls(int dim) : dim_(dim) {}

  bool empty() const { return walls_.empty(); }
  // `corners` as hull_facets() would give them if only the settled part were there.
  void add(std::span<const std::uint32_t> corners);
  // `numbers` has the new number of each vertex; those of walls ascend as the old ones.
  void renumber(std::span<const std::uint32_t> numbers);
  // Marks the vertices of all walls.
  void mark_vertices(std::vector<std::uint8_t>& marks) const;

  struct Outside {
    std::vector<std::uint8_t> simplices;  // whether each lies outside
    // The hull of all: facets of simplices outside beyond which there is nothing, and walls with
    // nothing outside; dim vertices each, as hull_facets() gives them.
    std::vector<std::uint32_t> hull;
  };
  // What of a triangulation lies outside of the walls, all of it if there are none. `mates` as
  // match_facets() gives them. O(n) expected.
  Outside find_outside(const Triangulation& triangulation,
                       std::span<const std::uint32_t> mates) const;

 private:
  struct Wall {
    std::array<std::uint32_t, 3> corners{};  // ascending; in 2D the last one is not used
    bool odd = false;                        // whether sorting them turned the facet round
    auto operator<=>(const Wall&) const = default;
  };
  Wall wall_of(std::span<const std::uint32_t> corners) const;

  int dim_;
  std::vector<Wall> walls_;
};

}  // namespace delray::delaunay
