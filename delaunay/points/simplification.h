// A terrain's triangulation that grows until all places are within a bound of it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <queue>
#include <utility>
#include <vector>

#include "delaunay/mesh/access.h"
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
// bound. Whether a place is beyond it is an exact predicate, so rounding may affect the order of
// insertions but never the bound; errors that overflow count as infinite.
class Simplification {
 public:
  Simplification(Places places, double max_error, parallel::Progress* progress)
      : places_(std::move(places)),
        max_error_(max_error),
        progress_(progress),
        is_kept_(places_.points.size(), 0),
        next_(places_.points.size(), kNoPlace) {}

  // REQUIRES: corners of the hull, at least three, in an order that is good for insertion.
  void start(const std::vector<std::uint32_t>& corners);
  // Inserts one place after the other, the farthest of all, until the bound holds.
  void refine();
  // Inserts places of many triangles at a time, by the threads of the caller's arena, until the
  // bound holds; which ones does not depend on how many these are.
  void refine_in_rounds();
  SimplifiedTerrain result() const;

 private:
  // A triangle's point that is farthest from it, of those beyond the bound.
  struct Candidate {
    double error = 0;
    std::uint32_t place = kNoPlace;
    bool operator==(const Candidate&) const = default;
  };
  struct Entry {
    Candidate candidate;
    SimplexNumber triangle;
    bool operator<(const Entry& other) const {
      return candidate.error != other.candidate.error ? candidate.error < other.candidate.error
                                                      : candidate.place > other.candidate.place;
    }
  };

  struct Insertion;  // of a round: refine_in_rounds.cpp

  void insert(std::uint32_t place, SimplexNumber triangle);
  void reserve(std::size_t triangles);
  void own(SimplexNumber triangle, std::uint32_t place) {
    next_[place] = first_[triangle];
    first_[triangle] = place;
  }
  void take_places(SimplexNumber triangle, std::uint32_t but, std::vector<std::uint32_t>& taken);
  // Places in the triangles around a new vertex, of which `star` are its corners counterclockwise.
  void share_out(std::uint32_t place, const std::vector<CornerNumber>& star,
                 const std::vector<std::uint32_t>& orphans);
  void find_star(std::uint32_t place, SimplexNumber triangle,
                 std::vector<CornerNumber>& star) const;
  void find_candidate(SimplexNumber triangle);
  void fill_star(Insertion& insertion);
  void reserve_round(std::vector<Insertion>& insertions, std::vector<SimplexNumber>& free);
  glm::dvec3 at(std::uint32_t place) const {
    return {places_.points[place], places_.heights[place]};
  }
  double error(SimplexNumber triangle, std::uint32_t place) const;
  bool is_beyond(SimplexNumber triangle, std::uint32_t place) const;

  Places places_;
  double max_error_;
  parallel::Progress* progress_;
  std::vector<std::uint8_t> is_kept_;
  Mesh<2> mesh_;
  SoleAccess access_{4};
  std::vector<CornerNumber> suspects_;
  // The places in a triangle, its boundary included, that are not kept: a list for each triangle.
  std::vector<std::uint32_t> first_, next_;
  std::vector<Candidate> candidates_;  // per triangle
  std::priority_queue<Entry> queue_;   // with entries that no longer count
  std::vector<CornerNumber> star_;
  std::vector<std::uint32_t> orphans_;
};

}  // namespace delray::delaunay::internal
