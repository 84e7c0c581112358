// The cavity of a point as a list of simplices, and the star that fills it (Bowyer 1981, Watson
// 1981).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// The simplices in conflict with a point, and their corners opposite to facets beyond which no
// simplex is.
template <int D>
struct Hole {
  std::vector<SimplexNumber> removed;
  std::vector<CornerNumber> border;

  void clear() {
    removed.clear();
    border.clear();
  }
  // The simplices of the star that takes the place of the hole.
  std::size_t star() const { return border.size(); }
};

// Finds holes; keeps its memory from one to the next.
template <int D>
class HoleFinder {
 public:
  // From a simplex in conflict with the point over all facets of simplices in conflict. look(t),
  // called once for each other simplex that is met, says whether it is in conflict, or nothing to
  // end the search, which then returns false. O(simplices met, squared, with a small constant).
  template <class Look>
  bool find(const Mesh<D>& mesh, SimplexNumber start, Hole<D>& hole, Look&& look) {
    hole.clear();
    hole.removed.push_back(start);
    known_.assign(1, {start, true});
    for (std::size_t i = 0; i < hole.removed.size(); ++i) {
      for (unsigned k = 0; k <= D; ++k) {
        const CornerNumber corner = corner_of(hole.removed[i], k);
        const SimplexNumber next = simplex_of(mesh.neighbour(corner));
        const auto place = std::ranges::lower_bound(known_, next, {}, &Known::simplex);
        bool is_inside = false;
        if (place != known_.end() && place->simplex == next) {
          is_inside = place->is_inside;
        } else {
          const std::optional<bool> found = look(next);
          if (!found) return false;
          is_inside = *found;
          known_.insert(place, {next, is_inside});
          if (is_inside) hole.removed.push_back(next);
        }
        if (!is_inside) hole.border.push_back(corner);
      }
    }
    return true;
  }

 private:
  struct Known {
    SimplexNumber simplex;
    bool is_inside;
  };
  std::vector<Known> known_;  // ascending
};

// Fills holes; keeps its memory from one to the next.
template <int D>
class StarFiller {
 public:
  // Writes the star of `vertex` into the slots, as many as its simplices; those of the hole may be
  // among them. Reads nothing but the hole and writes nothing but the slots and the other sides of
  // the border's facets. O(star log star).
  void fill(Mesh<D>& mesh, const Hole<D>& hole, VertexNumber vertex,
            std::span<const SimplexNumber> slots) {
    made_.clear();
    for (const CornerNumber corner : hole.border) {
      Made made;
      const SimplexNumber t = simplex_of(corner);
      made.place = corner & 3U;
      for (unsigned k = 0; k <= D; ++k) {
        made.corners[k] = k == made.place ? vertex : mesh.vertex(corner_of(t, k));
      }
      made.outer = mesh.neighbour(corner);
      made_.push_back(made);
    }
    ridges_.clear();
    for (std::size_t i = 0; i < made_.size(); ++i) {
      for (unsigned k = 0; k <= D; ++k) {
        mesh.set_vertex(corner_of(slots[i], k), made_[i].corners[k]);
        if (k != made_[i].place) ridges_.push_back(ridge(made_[i], slots[i], k));
      }
      mesh.link(corner_of(slots[i], made_[i].place), made_[i].outer);
    }
    std::ranges::sort(ridges_);
    for (std::size_t i = 0; i + 1 < ridges_.size(); i += 2) {
      mesh.link(ridges_[i].second, ridges_[i + 1].second);
    }
  }

 private:
  struct Made {
    std::array<VertexNumber, D + 1> corners;
    unsigned place;  // of the new vertex
    CornerNumber outer;
  };
  // The vertices of a ridge but for the new one, ascending; then the corner opposite to it.
  using Ridge = std::pair<std::array<VertexNumber, D - 1>, CornerNumber>;

  static Ridge ridge(const Made& made, SimplexNumber slot, unsigned k) {
    Ridge result{{}, corner_of(slot, k)};
    for (unsigned j = 0, i = 0; j <= D; ++j) {
      if (j != k && j != made.place) result.first[i++] = made.corners[j];
    }
    std::ranges::sort(result.first);
    return result;
  }

  std::vector<Made> made_;
  std::vector<Ridge> ridges_;
};

}  // namespace delray::delaunay::internal
