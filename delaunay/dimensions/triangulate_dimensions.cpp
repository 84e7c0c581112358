// Distinct points are inserted in random rounds of doubling size, each in the order of a tree that
// halves them by one axis after the other, so that walks are short (Amenta, Choi and Rote 2003).
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "delaunay/dimensions.h"
#include "delaunay/dimensions/cells.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;
using Fraction = boost::multiprecision::cpp_rational;

template <int D>
std::vector<PlaceNd<D>> places_of(const PointView<double>& points) {
  std::vector<PlaceNd<D>> places(points.size());
  for (std::size_t row = 0; row < places.size(); ++row) {
    for (int k = 0; k < D; ++k) {
      const double x = points(row, k);
      if (!std::isfinite(x)) {
        throw std::invalid_argument("row " + std::to_string(row) +
                                    " has a coordinate that is not finite");
      }
      places[row][static_cast<std::size_t>(k)] = x + 0.0;
    }
  }
  return places;
}

// The lowest row of each place.
template <int D>
std::vector<std::uint32_t> distinct_rows(const std::vector<PlaceNd<D>>& places) {
  std::vector<std::uint32_t> rows(places.size());
  std::iota(rows.begin(), rows.end(), 0U);
  std::ranges::sort(rows, [&](std::uint32_t a, std::uint32_t b) {
    return places[a] != places[b] ? places[a] < places[b] : a < b;
  });
  const auto same = [&](std::uint32_t a, std::uint32_t b) { return places[a] == places[b]; };
  rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
  return rows;
}

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

// Vectors that are independent, reduced by those before them.
template <int D>
class Basis {
 public:
  bool add(const PlaceNd<D>& from, const PlaceNd<D>& to) {
    std::array<Fraction, D> vector;
    for (std::size_t k = 0; k < D; ++k) vector[k] = Fraction(to[k]) - Fraction(from[k]);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Fraction factor = vector[pivots_[i]];
      if (factor == 0) continue;
      for (std::size_t k = 0; k < D; ++k) vector[k] -= factor * rows_[i][k];
    }
    const auto pivot =
        std::ranges::find_if(vector, [](const Fraction& x) { return x != 0; }) - vector.begin();
    if (pivot == D) return false;
    const Fraction scale = vector[static_cast<std::size_t>(pivot)];
    for (Fraction& x : vector) x /= scale;
    rows_.push_back(vector);
    pivots_.push_back(static_cast<std::size_t>(pivot));
    return true;
  }

 private:
  std::vector<std::array<Fraction, D>> rows_;
  std::vector<std::size_t> pivots_;
};

// The first in order that span the space; they come to the front. Nothing if there are none.
template <int D>
bool bring_first_to_front(const std::vector<PlaceNd<D>>& places, std::vector<std::uint32_t>& rows) {
  Basis<D> basis;
  std::size_t found = 1;
  for (std::size_t i = 1; i < rows.size() && found <= D; ++i) {
    if (basis.add(places[rows[0]], places[rows[i]])) {
      std::rotate(rows.begin() + static_cast<std::ptrdiff_t>(found),
                  rows.begin() + static_cast<std::ptrdiff_t>(i),
                  rows.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      ++found;
    }
  }
  return found == D + 1;
}

template <int D>
Triangulation triangulate_in(const PointView<double>& points, std::uint64_t seed,
                             parallel::Progress* progress) {
  const std::vector<PlaceNd<D>> places = places_of<D>(points);
  std::vector<std::uint32_t> rows = distinct_rows<D>(places);
  Triangulation result;
  result.dim = D;
  result.distinct = rows.size();
  if (progress != nullptr) progress->advance(points.size() - rows.size());
  order_rounds<D>(places, rows, seed);
  if (!bring_first_to_front<D>(places, rows)) return result;
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
