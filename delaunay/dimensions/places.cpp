// Equal places are found by sorting; independent vectors by elimination in fractions, of which few
// are needed as a rule.
#include "delaunay/dimensions/places.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace delray::delaunay::internal {
namespace {

using Fraction = boost::multiprecision::cpp_rational;

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

}  // namespace

template <int D>
std::vector<PlaceNd<D>> places_of(const PointView<double>& points) {
  if (points.count > 0 && points.stride < D * sizeof(double)) {
    throw std::invalid_argument("points that lie " + std::to_string(points.stride) +
                                " bytes apart do not have " + std::to_string(D) + " coordinates");
  }
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
bool bring_spanning_to_front(const std::vector<PlaceNd<D>>& places,
                             std::vector<std::uint32_t>& rows) {
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

#define DELRAY_DIMENSION(D)                                                             \
  template std::vector<PlaceNd<D>> places_of<D>(const PointView<double>&);              \
  template std::vector<std::uint32_t> distinct_rows<D>(const std::vector<PlaceNd<D>>&); \
  template bool bring_spanning_to_front<D>(const std::vector<PlaceNd<D>>&,              \
                                           std::vector<std::uint32_t>&);
DELRAY_DIMENSION(2)
DELRAY_DIMENSION(3)
DELRAY_DIMENSION(4)
DELRAY_DIMENSION(5)
DELRAY_DIMENSION(6)
#undef DELRAY_DIMENSION

}  // namespace delray::delaunay::internal
