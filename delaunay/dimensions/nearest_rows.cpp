// The nearest of a point's neighbours in a Delaunay triangulation is the nearest of all points, and
// the next one is a neighbour of the point or of one that was found: so a queue of neighbours by
// distance gives all in order.
//
// Degenerate: of equal points one is a vertex, the others are found with it; points that do not
// span the space have no simplices, and all are compared.
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/dimensions.h"

namespace delray::delaunay {
namespace {

class NearestSearch {
 public:
  NearestSearch(PointView<double> points, const Triangulation& triangulation)
      : points_(points), vertices_(triangulation.vertices), dim_(triangulation.dim) {
    find_equal();
    first_.resize(points.size() + 1);
    for (const std::uint32_t vertex : vertices_) ++first_[lowest_[vertex] + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    incident_.resize(vertices_.size());
    const auto corners = static_cast<std::size_t>(dim_) + 1;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      incident_[next[lowest_[vertices_[i]]]++] = static_cast<std::uint32_t>(i / corners);
    }
    is_flat_ = triangulation.vertices.empty();
  }

  std::vector<NearRow> nearest(std::uint32_t of, std::size_t count) {
    std::vector<bool> is_seen(points_.size());
    const auto see = [&](std::uint32_t vertex) {
      if (is_seen[vertex]) return;
      is_seen[vertex] = true;
      queue_.push({distance(of, vertex), vertex});
    };
    const auto corners = static_cast<std::size_t>(dim_) + 1;
    std::vector<NearRow> found;
    see(lowest_[of]);
    if (is_flat_) {
      for (const std::uint32_t vertex : lowest_) see(vertex);
    }
    while (!queue_.empty() && found.size() < count) {
      const auto [far, vertex] = queue_.top();
      queue_.pop();
      for (const std::uint32_t row : equal_[vertex]) {
        if (row != of && found.size() < count) found.push_back({row, far});
      }
      for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
        for (std::size_t k = 0; k < corners; ++k)
          see(lowest_[vertices_[std::size_t{incident_[i]} * corners + k]]);
      }
    }
    queue_ = {};
    return found;
  }

 private:
  void find_equal() {
    std::vector<std::uint32_t> order(points_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
      for (int k = 0; k < dim_; ++k) {
        if (points_(a, k) != points_(b, k)) return points_(a, k) < points_(b, k) ? -1 : 1;
      }
      return 0;
    };
    std::ranges::stable_sort(order, [&](auto a, auto b) { return compare(a, b) < 0; });
    lowest_.resize(order.size());
    equal_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool is_first = i == 0 || compare(order[i - 1], order[i]) != 0;
      lowest_[order[i]] = is_first ? order[i] : lowest_[order[i - 1]];
      equal_[lowest_[order[i]]].push_back(order[i]);
    }
  }

  double distance(std::uint32_t a, std::uint32_t b) const {
    double sum = 0;
    for (int k = 0; k < dim_; ++k) {
      const double difference = points_(a, k) - points_(b, k);
      sum += difference * difference;
    }
    return std::sqrt(sum);
  }

  using Near = std::pair<double, std::uint32_t>;
  PointView<double> points_;
  std::span<const std::uint32_t> vertices_;
  int dim_;
  bool is_flat_ = false;
  std::vector<std::uint32_t> lowest_;              // per row: of those that are equal
  std::vector<std::vector<std::uint32_t>> equal_;  // per lowest row: all of them
  // Per lowest row i the simplices around it: incident_[first_[i]] to incident_[first_[i + 1] - 1].
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> incident_;
  std::priority_queue<Near, std::vector<Near>, std::greater<>> queue_;
};

}  // namespace

std::vector<NearRow> nearest_rows(PointView<double> points, const Triangulation& triangulation,
                                  std::uint32_t of, std::size_t count) {
  if (of >= points.size()) {
    throw std::invalid_argument("row " + std::to_string(of) + " is not there");
  }
  for (const std::uint32_t vertex : triangulation.vertices) {
    if (vertex >= points.size()) throw std::invalid_argument("a vertex is no row");
  }
  return NearestSearch(points, triangulation).nearest(of, count);
}

}  // namespace delray::delaunay
