// Verification of triangulations of any dimension by local conditions (Mehlhorn et al. 1999,
// Delaunay 1934).
//
// A place o, just inside the first simplex, sees every facet of the boundary from inside, and the
// boundary is closed, so the directions from o are covered equally often by it: as often as
// simplices cover o, which is once. It is convex at every ridge, so it is the boundary of one
// convex body. A place is covered by as many simplices as the boundary winds around it: once
// inside, never outside.
//
// o is the first vertex moved by less and less towards the others, so that no hyperplane of points
// holds it: the first of the vertices that is not on a hyperplane tells its side. The rule for ties
// is written for this file alone.
#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "delaunay/dimensions.h"
#include "delaunay/dimensions/places.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;

struct Objection {
  std::optional<std::size_t> simplex;
  std::string reason;
};
using Check = std::optional<Objection>;

template <int D>
class Verifier {
 public:
  Verifier(const PointView<double>& points, std::span<const std::uint32_t> given)
      : places_(internal::places_of<D>(points)), given_(given), lowest_(places_.size()) {
    std::vector<std::uint32_t> rows(places_.size());
    std::iota(rows.begin(), rows.end(), 0U);
    std::ranges::sort(rows, [&](std::uint32_t a, std::uint32_t b) {
      return places_[a] != places_[b] ? places_[a] < places_[b] : a < b;
    });
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool is_new = i == 0 || places_[rows[i]] != places_[rows[i - 1]];
      lowest_[rows[i]] = is_new ? rows[i] : lowest_[rows[i - 1]];
      distinct_ += is_new ? 1 : 0;
    }
  }

  Verdict verdict() {
    Verdict verdict;
    verdict.distinct = distinct_;
    const auto objects = [&](const Check& objection) {
      if (!objection) return false;
      verdict.simplex = objection->simplex;
      verdict.reason = objection->reason;
      return true;
    };
    if (objects(check_rows())) return verdict;
    vertices_.resize(given_.size());
    for (std::size_t i = 0; i < given_.size(); ++i) vertices_[i] = lowest_[given_[i]];
    if (objects(check_coverage())) return verdict;
    verdict.valid = true;
    if (objects(check_balls(/*ties=*/false))) return verdict;
    verdict.delaunay = true;
    if (objects(check_representatives()) || objects(check_balls(/*ties=*/true))) return verdict;
    verdict.canonical = true;
    return verdict;
  }

 private:
  static constexpr std::size_t kCorners = D + 1;
  using Simplex = std::array<const PlaceNd<D>*, kCorners>;
  // Facet number kCorners * t + k is the one of simplex t opposite to its corner k.
  struct Facet {
    std::array<std::uint32_t, D> vertices;  // ascending
    std::size_t number;
  };
  struct Ridge {
    std::array<std::uint32_t, D - 1> vertices;  // ascending
    std::size_t facet;
    std::uint32_t apex;  // of the facet, not of the ridge
  };

  std::size_t size() const { return given_.size() / kCorners; }
  static std::string row(std::uint32_t vertex) { return "row " + std::to_string(vertex); }

  Simplex simplex(std::size_t t) const {
    Simplex at;
    for (std::size_t k = 0; k < kCorners; ++k) at[k] = &places_[vertices_[t * kCorners + k]];
    return at;
  }
  // With a vertex in the place of the corner that a facet is opposite to: whether both are on the
  // same side of it.
  int side(std::size_t facet, std::uint32_t vertex) const {
    Simplex at = simplex(facet / kCorners);
    at[facet % kCorners] = &places_[vertex];
    return internal::orientation_nd<D>(at);
  }
  int side_of_inner(std::size_t facet) const {
    for (std::size_t k = 0; k < kCorners; ++k) {
      if (const int sign = side(facet, vertices_[k]); sign != 0) return sign;
    }
    return 0;
  }

  Check check_rows() const {
    for (std::size_t i = 0; i < given_.size(); ++i) {
      if (given_[i] >= places_.size()) {
        return Objection{i / kCorners,
                         "vertex " + std::to_string(given_[i]) + " is not a row of the points"};
      }
    }
    return std::nullopt;
  }

  Check check_no_simplices() const {
    std::vector<std::uint32_t> rows = internal::distinct_rows<D>(places_);
    if (!internal::bring_spanning_to_front<D>(places_, rows)) return std::nullopt;
    std::string text;
    for (std::size_t k = 0; k < kCorners; ++k) text += (k == 0 ? "" : ", ") + row(rows[k]);
    return Objection{std::nullopt, "there are no simplices, but " + text + " span the space"};
  }

  Check check_orientation() const {
    for (std::size_t t = 0; t < size(); ++t) {
      const int sign = internal::orientation_nd<D>(simplex(t));
      if (sign <= 0) {
        return Objection{
            t, sign == 0 ? "its vertices are in one hyperplane" : "it is negatively oriented"};
      }
    }
    return std::nullopt;
  }

  // Sorts facets into pairs and the boundary.
  Check match_facets() {
    std::vector<Facet> facets(given_.size());
    for (std::size_t number = 0; number < facets.size(); ++number) {
      facets[number].number = number;
      const std::size_t first = number - number % kCorners;
      for (std::size_t k = 0, i = 0; k < kCorners; ++k) {
        if (first + k != number) facets[number].vertices[i++] = vertices_[first + k];
      }
      std::ranges::sort(facets[number].vertices);
    }
    std::ranges::sort(facets, [](const Facet& a, const Facet& b) {
      return std::tie(a.vertices, a.number) < std::tie(b.vertices, b.number);
    });
    for (std::size_t i = 0; i < facets.size();) {
      std::size_t end = i + 1;
      while (end < facets.size() && facets[end].vertices == facets[i].vertices) ++end;
      const std::size_t number = facets[i].number;
      if (end - i > 2) return Objection{number / kCorners, "a facet has three simplices or more"};
      if (end - i == 1) boundary_.push_back(number);
      if (end - i == 2) {
        const std::size_t mate = facets[i + 1].number;
        if (side(number, vertices_[mate]) >= 0) {
          return Objection{number / kCorners, "simplex " + std::to_string(mate / kCorners) +
                                                  " lies on the same side of a facet"};
        }
        pairs_.emplace_back(number, mate);
      }
      i = end;
    }
    return std::nullopt;
  }

  Check check_boundary() const {
    std::vector<Ridge> ridges;
    for (const std::size_t facet : boundary_) {
      if (side_of_inner(facet) <= 0) {
        return Objection{facet / kCorners, "the boundary is not convex"};
      }
      const std::size_t first = facet - facet % kCorners;
      for (std::size_t k = 0; k < kCorners; ++k) {
        if (first + k == facet) continue;
        Ridge ridge{{}, facet, vertices_[first + k]};
        for (std::size_t j = 0, i = 0; j < kCorners; ++j) {
          if (j != k && first + j != facet) ridge.vertices[i++] = vertices_[first + j];
        }
        std::ranges::sort(ridge.vertices);
        ridges.push_back(ridge);
      }
    }
    std::ranges::sort(ridges, [](const Ridge& a, const Ridge& b) {
      return std::tie(a.vertices, a.facet) < std::tie(b.vertices, b.facet);
    });
    for (std::size_t i = 0; i < ridges.size(); i += 2) {
      const Ridge& ridge = ridges[i];
      const bool is_pair = i + 1 < ridges.size() && ridges[i + 1].vertices == ridge.vertices;
      if (!is_pair || (i + 2 < ridges.size() && ridges[i + 2].vertices == ridge.vertices)) {
        return Objection{ridge.facet / kCorners,
                         "the boundary is not closed at " + row(ridge.vertices[0])};
      }
      if (side(ridge.facet, ridges[i + 1].apex) < 0) {
        return Objection{ridge.facet / kCorners,
                         "the boundary is not convex at " + row(ridge.vertices[0])};
      }
    }
    return std::nullopt;
  }

  // The place just inside the first simplex is in no other.
  Check check_once() const {
    for (std::size_t t = 1; t < size(); ++t) {
      bool is_inside = true;
      for (std::size_t k = 0; k < kCorners && is_inside; ++k) {
        is_inside = side_of_inner(t * kCorners + k) > 0;
      }
      if (is_inside) return Objection{t, "it overlaps simplex 0"};
    }
    return std::nullopt;
  }

  Check check_use() const {
    std::vector<bool> used(places_.size());
    for (const std::uint32_t vertex : vertices_) used[vertex] = true;
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      if (lowest_[i] == i && !used[i]) return Objection{std::nullopt, row(i) + " is in no simplex"};
    }
    return std::nullopt;
  }

  Check check_coverage() {
    if (size() == 0) return check_no_simplices();
    if (Check objection = check_orientation()) return objection;
    if (Check objection = match_facets()) return objection;
    if (Check objection = check_boundary()) return objection;
    if (Check objection = check_once()) return objection;
    return check_use();
  }

  // From the largest in lexicographic order down: the first that can be exchanged for q decides.
  bool counts_as_inside(const Simplex& corners, const PlaceNd<D>& q) const {
    std::array<std::size_t, kCorners> order;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
      return std::ranges::lexicographical_compare(*corners[b], *corners[a]);
    });
    for (const std::size_t k : order) {
      if (std::ranges::lexicographical_compare(*corners[k], q)) return false;
      Simplex replaced = corners;
      replaced[k] = &q;
      if (const int sign = internal::orientation_nd<D>(replaced); sign != 0) return sign > 0;
    }
    return false;
  }

  Check check_balls(bool ties) const {
    for (const auto& [facet, mate] : pairs_) {
      const Simplex corners = simplex(facet / kCorners);
      const PlaceNd<D>& q = places_[vertices_[mate]];
      const int sign = internal::in_sphere_nd<D>(corners, q);
      if (!ties && sign > 0) {
        return Objection{facet / kCorners, row(vertices_[mate]) + " is inside its circumsphere"};
      }
      if (ties && sign == 0 && counts_as_inside(corners, q)) {
        return Objection{facet / kCorners,
                         row(vertices_[mate]) + " is on its circumsphere and counts as inside"};
      }
    }
    return std::nullopt;
  }

  Check check_representatives() const {
    for (std::size_t i = 0; i < given_.size(); ++i) {
      if (given_[i] != vertices_[i]) {
        return Objection{i / kCorners,
                         row(given_[i]) + " is a vertex, but equals " + row(vertices_[i])};
      }
    }
    return std::nullopt;
  }

  std::vector<PlaceNd<D>> places_;
  std::span<const std::uint32_t> given_;
  std::vector<std::uint32_t> lowest_, vertices_;
  std::size_t distinct_ = 0;
  std::vector<std::size_t> boundary_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // of facets; the first is lower
};

template <int D>
Verdict verify_in(const PointView<double>& points, std::span<const std::uint32_t> simplices) {
  if (simplices.size() % (D + 1) != 0) {
    throw std::invalid_argument(std::to_string(simplices.size()) +
                                " vertices are no simplices of " + std::to_string(D + 1));
  }
  return Verifier<D>(points, simplices).verdict();
}

}  // namespace

Verdict verify_dimensions(PointView<double> points, int dim,
                          std::span<const std::uint32_t> simplices) {
  switch (dim) {
    case 2:
      return verify_in<2>(points, simplices);
    case 3:
      return verify_in<3>(points, simplices);
    case 4:
      return verify_in<4>(points, simplices);
    case 5:
      return verify_in<5>(points, simplices);
    case 6:
      return verify_in<6>(points, simplices);
    default:
      throw std::invalid_argument("the dimension is from 2 to " + std::to_string(kMostDimensions) +
                                  ", not " + std::to_string(dim));
  }
}

}  // namespace delray::delaunay
