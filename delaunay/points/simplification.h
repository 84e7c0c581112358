// A terrain's triangulation that grows until all places are within a bound of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "delaunay/mesh/access.h"
#include "delaunay/mesh/array.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/simplify_terrain.h"

namespace delray::delaunay::internal {

constexpr std::uint32_t kNoPlace = 0xffffffffU;

// Distinct places, along a Hilbert curve.
struct Places {
  std::vector<glm::dvec2> points;
  std::vector<double> heights;
  std::vector<std::uint32_t> rows;  // of several rows at a place the lowest
};

// Each triangle keeps a list of the places in it and a candidate, the farthest one beyond the
// bound. Loops over many places go to the threads of the caller's arena. Whether a place is beyond
// it is an exact predicate, so rounding may affect the order of insertions but never the bound;
// errors that overflow count as infinite.
class Simplification {
 public:
  Simplification(Places places, double max_error, parallel::Progress* progress)
      : places_(std::move(places)),
        max_error_(max_error),
        progress_(progress),
        is_kept_(places_.points.size(), 0),
        mesh_(std::min<std::size_t>(4 * places_.points.size(), kMaximumSimplices)),
        next_(places_.points.size(), kNoPlace),
        first_(mesh_.size()),
        candidates_(mesh_.size()) {}

  // REQUIRES: corners of the hull, at least three, in an order that is good for insertion.
  void start(const std::vector<std::uint32_t>& corners);
  // Inserts one place after the other, the farthest of all, until the bound holds.
  void refine() { refine(kEverything, kMaximumSimplices); }
  // Inserts places in many parts of the terrain at a time, by the threads of the caller's arena,
  // until the bound holds; which ones does not depend on how many these are.
  void refine_in_parts();
  SimplifiedTerrain result() const;

 private:
  // A triangle's point that is farthest from it, of those beyond the bound.
  struct Candidate {
    double error = 0;
    std::uint32_t place = kNoPlace;
    bool operator==(const Candidate&) const = default;
    bool is_better_than(const Candidate& other) const {
      if (place == kNoPlace || other.place == kNoPlace) return other.place == kNoPlace;
      return error != other.error ? error > other.error : place < other.place;
    }
  };
  struct Entry {
    Candidate candidate;
    SimplexNumber triangle;
    bool operator<(const Entry& other) const { return other.candidate.is_better_than(candidate); }
  };
  // Places of one triangle, linked by next_, and its candidate among them.
  struct Run {
    SimplexNumber triangle;
    Candidate candidate;
    std::uint32_t first, last;
  };
  class Parts;  // refine_in_parts.cpp

  static constexpr double kEverything = -1;  // below all errors

  // Inserts the farthest place of all while its error is above `least` and so many triangles are
  // not yet there.
  void refine(double least, std::size_t triangles);
  void insert(std::uint32_t place, SimplexNumber triangle);
  // Of a triangle that nothing is known of.
  void start_lists(SimplexNumber triangle) {
    first_[triangle] = kNoPlace;
    candidates_[triangle] = {};
  }
  void take_places(SimplexNumber triangle, std::uint32_t but, std::vector<std::uint32_t>& taken);
  void add(std::vector<Run>& runs, SimplexNumber triangle, std::uint32_t place);
  void keep(const std::vector<Run>& runs);
  // add_places(first, last, runs) finds the triangles of the places [first, last) of n; blocks do
  // not depend on threads.
  template <class AddPlaces>
  void share_out_blocks(std::size_t n, AddPlaces&& add_places);
  // Places in the triangles around a new vertex, of which `star` are its corners counterclockwise.
  void share_out(std::uint32_t place, const std::vector<CornerNumber>& star,
                 const std::vector<std::uint32_t>& orphans, std::vector<Run>& runs);
  void find_star(std::uint32_t place, SimplexNumber triangle,
                 std::vector<CornerNumber>& star) const;
  // The candidates with an error above `least`.
  std::vector<Entry> candidates_above(double least) const;
  std::vector<std::uint32_t> rows_of_triangles() const;
  glm::dvec3 at(std::uint32_t place) const {
    return {places_.points[place], places_.heights[place]};
  }
  double error(SimplexNumber triangle, std::uint32_t place) const;
  bool is_beyond(SimplexNumber triangle, std::uint32_t place) const;

  Places places_;
  double max_error_;
  parallel::Progress* progress_;
  std::vector<std::uint8_t> is_kept_;
  // All places have two triangles each at most, ghosts among them; the other slots may be free ones
  // of parts. What is not used of so much memory is not touched either.
  Mesh<2> mesh_;
  SoleAccess access_{4};
  std::vector<CornerNumber> suspects_;
  // The places in a triangle, its boundary included, that are not kept: a list for each triangle.
  std::vector<std::uint32_t> next_;
  Array<std::uint32_t> first_;
  Array<Candidate> candidates_;  // per triangle
  std::vector<CornerNumber> star_;
  std::vector<std::uint32_t> orphans_;
  std::vector<Run> runs_;
};

}  // namespace delray::delaunay::internal
