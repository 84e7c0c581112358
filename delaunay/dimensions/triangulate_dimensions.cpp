// Distinct points are inserted in random rounds of doubling size, each in the order of a tree that
// halves them by one axis after the other, so that walks are short (Amenta, Choi and Rote 2003).
#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "delaunay/dimensions.h"
#include "delaunay/dimensions/cells.h"
#include "delaunay/dimensions/places.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;

template <int D>
void halve(const std::vector<PlaceNd<D>>& places, std::span<std::uint32_t> rows, unsigned axis) {
  if (rows.size() <= 4) return;
  const std::size_t middle = rows.size() / 2;
  std::ranges::nth_element(rows, rows.begin() + static_cast<std::ptrdiff_t>(middle), {},
                           [&](std::uint32_t row) { return places[row][axis]; });
  halve<D>(places, rows.first(middle), (axis + 1) % D);
  halve<D>(places, rows.subspan(middle), (axis + 1) % D);
}

template <int D>
void order_rounds(const std::vector<PlaceNd<D>>& places, std::vector<std::uint32_t>& rows,
                  std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
  for (std::size_t last = rows.size(); last > 0; last /= 2) {
    halve<D>(places, std::span(rows).subspan(last / 2, last - last / 2), 0);
  }
}

template <int D>
Triangulation triangulate_in(const PointView<double>& points, std::uint64_t seed,
                             parallel::Progress* progress) {
  const std::vector<PlaceNd<D>> places = internal::places_of<D>(points);
  std::vector<std::uint32_t> rows = internal::distinct_rows<D>(places);
  Triangulation result;
  result.dim = D;
  result.distinct = rows.size();
  if (progress != nullptr) progress->advance(points.size() - rows.size());
  order_rounds<D>(places, rows, seed);
  if (!internal::bring_spanning_to_front<D>(places, rows)) return result;
  typename internal::Cells<D>::Corners first;
  std::copy_n(rows.begin(), D + 1, first.begin());
  internal::Cells<D> cells(places, first);
  if (progress != nullptr) progress->advance(first.size());
  for (std::size_t i = D + 1; i < rows.size(); ++i) {
    if (!cells.insert(rows[i])) {
      throw std::invalid_argument("more than 2^28 simplices in " + std::to_string(D) +
                                  " dimensions, after " + std::to_string(i) + " points");
    }
    if (progress != nullptr) progress->advance();
  }
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (cells.is_dead(cell)) continue;
    if (cells.is_ghost(cell)) {
      ++result.hull_facets;
    } else {
      result.vertices.insert(result.vertices.end(), cells.corners(cell).begin(),
                             cells.corners(cell).end());
    }
  }
  return result;
}

}  // namespace

Triangulation triangulate_dimensions(PointView<double> points, int dim, std::uint64_t seed,
                                     parallel::Progress* progress) {
  switch (dim) {
    case 2:
      return triangulate_in<2>(points, seed, progress);
    case 3:
      return triangulate_in<3>(points, seed, progress);
    case 4:
      return triangulate_in<4>(points, seed, progress);
    case 5:
      return triangulate_in<5>(points, seed, progress);
    case 6:
      return triangulate_in<6>(points, seed, progress);
    default:
      throw std::invalid_argument("the dimension is from 2 to " + std::to_string(kMostDimensions) +
                                  ", not " + std::to_string(dim));
  }
}

}  // namespace delray::delaunay
