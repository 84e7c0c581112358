// A visibility walk finds a cell in conflict: the one that holds the point, or the ghost that it
// leaves the hull into. Cells in conflict are connected; each facet of their border is joined to
// the point, and the new cells find each other by turning around the ridges of the border inside
// the hole.
#include "delaunay/dimensions/cells.h"

#include <algorithm>
#include <utility>

namespace delray::delaunay::internal {

template <int D>
Cells<D>::Cells(const std::vector<PlaceNd<D>>& points, Corners first) : points_(points) {
  std::array<const PlaceNd<D>*, D + 1> at;
  for (unsigned k = 0; k <= D; ++k) at[k] = &points[first[k]];
  if (orientation_nd<D>(at) < 0) std::swap(first[0], first[1]);
  corners_.resize(D + 2);
  across_.resize(D + 2);
  marks_.resize(D + 2);
  corners_[0] = first;
  for (unsigned f = 0; f <= D; ++f) {
    // Two corners swapped turn the orientation that the infinite vertex would have.
    Corners& ghost = corners_[f + 1];
    ghost = first;
    ghost[f] = kInfiniteVertex;
    const unsigned a = f == 0 ? 1 : 0, b = f <= 1 ? 2 : 1;
    std::swap(ghost[a], ghost[b]);
    link(0, f, f + 1, f);
  }
  // Ghosts f and g share what has neither corner.
  for (unsigned f = 0; f <= D; ++f) {
    for (unsigned g = 0; g < f; ++g) {
      const auto place = [&](unsigned ghost, VertexNumber vertex) {
        const Corners& corners = corners_[ghost + 1];
        return static_cast<unsigned>(std::ranges::find(corners, vertex) - corners.begin());
      };
      link(f + 1, place(f, first[g]), g + 1, place(g, first[f]));
    }
  }
}

template <int D>
bool Cells<D>::is_ghost(std::uint32_t cell) const {
  return std::ranges::find(corners_[cell], kInfiniteVertex) != corners_[cell].end();
}

template <int D>
std::array<const PlaceNd<D>*, D + 1> Cells<D>::places(std::uint32_t cell) const {
  std::array<const PlaceNd<D>*, D + 1> at;
  for (unsigned k = 0; k <= D; ++k) {
    const VertexNumber vertex = corners_[cell][k];
    at[k] = vertex == kInfiniteVertex ? nullptr : &points_[vertex];
  }
  return at;
}

// A ghost as in predicates/conflict.h: in the hyperplane of its facet the cell inside decides.
template <int D>
bool Cells<D>::conflicts(std::uint32_t cell, const PlaceNd<D>& q) const {
  auto at = places(cell);
  const auto infinite = std::ranges::find(at, nullptr);
  if (infinite == at.end()) return conflict_nd<D>(at, q);
  *infinite = &q;
  if (const int side = orientation_nd<D>(at); side != 0) return side > 0;
  return conflict_nd<D>(places(across_[cell][static_cast<unsigned>(infinite - at.begin())] / 8), q);
}

// Facets are tried from a random one on: where a walk could go round in circles, it does not
// forever.
template <int D>
std::uint32_t Cells<D>::locate(const PlaceNd<D>& q) {
  std::uint32_t cell = last_;
  unsigned entry = D + 1;
  while (true) {
    const auto at = places(cell);
    const unsigned start = next_random(random_) % (D + 1);
    unsigned exit = D + 1;
    for (unsigned i = 0; i <= D && exit > D; ++i) {
      const unsigned k = (start + i) % (D + 1);
      if (k == entry) continue;
      auto moved = at;
      moved[k] = &q;
      if (orientation_nd<D>(moved) < 0) exit = k;
    }
    if (exit > D) return cell;
    const Facet facet = across_[cell][exit];
    cell = facet / 8;
    entry = facet % 8;
    if (corners_[cell][entry] == kInfiniteVertex) return cell;
  }
}

template <int D>
void Cells<D>::dig(std::uint32_t start, const PlaceNd<D>& q) {
  const std::uint64_t inside = 2 * ++insertions_, outside = inside + 1;
  removed_.assign({start});
  border_.clear();
  marks_[start] = inside;
  for (std::size_t i = 0; i < removed_.size(); ++i) {
    const std::uint32_t cell = removed_[i];
    for (unsigned k = 0; k <= D; ++k) {
      const std::uint32_t next = across_[cell][k] / 8;
      if (marks_[next] == inside) continue;
      if (marks_[next] != outside) {
        if (conflicts(next, q)) {
          marks_[next] = inside;
          removed_.push_back(next);
          continue;
        }
        marks_[next] = outside;
      }
      border_.push_back({cell, k});
    }
  }
}

template <int D>
std::uint32_t Cells<D>::create() {
  if (!free_.empty()) {
    const std::uint32_t cell = free_.back();
    free_.pop_back();
    return cell;
  }
  corners_.emplace_back();
  across_.emplace_back();
  marks_.push_back(0);
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

template <int D>
void Cells<D>::link_around(std::uint32_t made, std::uint32_t cell, unsigned k, unsigned j) {
  // The ridge has neither corner `kept` nor corner `left` of the cell; the way leaves by the facet
  // opposite to `left`.
  unsigned kept = k, left = j;
  while ((across_[cell][left] & kMade) == 0) {
    const Facet facet = across_[cell][left];
    const VertexNumber pivot = corners_[cell][kept];
    cell = facet / 8;
    kept = facet % 8;
    left = static_cast<unsigned>(std::ranges::find(corners_[cell], pivot) - corners_[cell].begin());
  }
  link(made, j, across_[cell][left] & ~kMade, kept);
}

template <int D>
bool Cells<D>::insert(VertexNumber vertex) {
  const PlaceNd<D>& q = points_[vertex];
  dig(locate(q), q);
  if (corners_.size() + border_.size() > kMostCells) return false;
  std::vector<std::uint32_t> made(border_.size());
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const auto [cell, k] = border_[i];
    const std::uint32_t t = made[i] = create();
    corners_[t] = corners_[cell];
    corners_[t][k] = vertex;
    const Facet outer = across_[cell][k];
    link(t, k, outer / 8, outer % 8);
    across_[cell][k] = kMade | t;
    if (!is_ghost(t)) last_ = t;
  }
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const auto [cell, k] = border_[i];
    for (unsigned j = 0; j <= D; ++j) {
      if (j != k) link_around(made[i], cell, k, j);
    }
  }
  for (const std::uint32_t cell : removed_) {
    corners_[cell][0] = kDeadVertex;
    free_.push_back(cell);
  }
  return true;
}

template class Cells<2>;
template class Cells<3>;
template class Cells<4>;
template class Cells<5>;
template class Cells<6>;

}  // namespace delray::delaunay::internal
