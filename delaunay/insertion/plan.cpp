// Splits points into parts of equal size for threads (Kohout 2004, 7.8.7) and orders each part.
//
// Strips and rings come from nested selections of the nth smallest key, which is cheaper than
// sorting; ties go by the point's number, so that the parts do not depend on the standard library.
// Every part begins its curve at another place, since threads that keep pace would otherwise work
// side by side. O(n log n); the parts are ordered by several threads.
#include "delaunay/insertion/plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/methods.h"
#include "parallel/team.h"

namespace delray::delaunay {
namespace {

// Puts the smallest keys into the first part and so on. Ties go by number, so that the result does
// not depend on the library.
void split_by(std::span<std::uint32_t> numbers, std::span<const double> keys,
              std::span<const std::size_t> begins) {
  if (begins.size() <= 2) return;
  const std::size_t middle = begins.size() / 2;
  const auto less = [&](std::uint32_t i, std::uint32_t j) {
    return keys[i] != keys[j] ? keys[i] < keys[j] : i < j;
  };
  const auto at = [&](std::size_t place) {
    return numbers.begin() + static_cast<std::ptrdiff_t>(place - begins.front());
  };
  if (begins[middle] < begins.back()) {
    std::nth_element(numbers.begin(), at(begins[middle]), numbers.end(), less);
  }
  split_by({numbers.begin(), at(begins[middle])}, keys, begins.first(middle + 1));
  split_by({at(begins[middle]), numbers.end()}, keys, begins.subspan(middle));
}

double distance_from_origin(const glm::dvec2& p) { return std::hypot(p.x, p.y); }
double distance_from_origin(const glm::dvec3& p) { return std::hypot(p.x, p.y, p.z); }

// Puts every part into ascending order, so that what is done within it depends on its points alone.
void sort_within_parts(Plan& plan) {
  std::vector<std::uint32_t> part_of(plan.points.size());
  for (std::uint32_t part = 0; part < plan.parts(); ++part) {
    for (std::size_t i = plan.begins[part]; i < plan.begins[part + 1]; ++i) {
      part_of[plan.points[i]] = part;
    }
  }
  std::vector<std::size_t> next(plan.begins.begin(), plan.begins.end() - 1);
  for (std::uint32_t point = 0; point < part_of.size(); ++point) {
    plan.points[next[part_of[point]]++] = point;
  }
}

void check_name(const char* what, std::string_view name, std::span<const Choice> legal) {
  if (std::ranges::find(legal, name, &Choice::name) != legal.end()) return;
  throw std::invalid_argument(std::string("there is no ") + what + " \"" + std::string(name) +
                              "\"");
}

template <class Point>
Plan plan_of(std::span<const Point> points, std::size_t parts, std::string_view split,
             std::string_view order, std::uint64_t seed, std::size_t threads) {
  if (parts < 1) throw std::invalid_argument("a plan has at least one part");
  if (parts > 1) check_name("split", split, splits());
  check_name("order", order, orders());
  Plan plan;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i <= parts; ++i) plan.begins.push_back(n * i / parts);
  if (parts == 1) {
    plan.points = insertion_order(points, order, seed, 0, threads);
    return plan;
  }
  if (split == "slabs" || split == "distance") {
    plan.points.resize(n);
    std::iota(plan.points.begin(), plan.points.end(), 0U);
    std::vector<double> keys(n);
    for (std::size_t i = 0; i < n; ++i) {
      keys[i] = split == "slabs" ? points[i].x : distance_from_origin(points[i]);
    }
    split_by(plan.points, keys, plan.begins);
  } else {
    assert(split == "random" || split == "curve");
    plan.points = insertion_order(points, split == "curve" ? "hilbert" : "random", seed);
  }
  sort_within_parts(plan);
  const auto order_part = [&](std::size_t part) {
    const std::size_t begin = plan.begins[part], end = plan.begins[part + 1];
    std::vector<Point> own(end - begin);
    std::vector<std::uint32_t> numbers(end - begin);
    for (std::size_t i = begin; i < end; ++i) own[i - begin] = points[plan.points[i]];
    // Threads that keep pace would conflict if they began at the same place.
    const double start = static_cast<double>(part) / static_cast<double>(parts);
    const std::vector<std::uint32_t> places =
        insertion_order(std::span<const Point>(own), order, seed + 1 + part, start);
    for (std::size_t i = 0; i < places.size(); ++i) numbers[i] = plan.points[begin + places[i]];
    std::copy(numbers.begin(), numbers.end(),
              plan.points.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  // A thread takes about as long to start as to put this many points in order.
  constexpr std::size_t kPointsPerThread = 1024;
  if (n < parts * kPointsPerThread) {
    for (std::size_t part = 0; part < parts; ++part) order_part(part);
  } else {
    parallel::Team team;
    team.run(parts, order_part);
  }
  return plan;
}

}  // namespace

Plan make_plan(std::span<const glm::dvec2> points, std::size_t parts, std::string_view split,
               std::string_view order, std::uint64_t seed, std::size_t threads) {
  return plan_of(points, parts, split, order, seed, threads);
}

Plan make_plan(std::span<const glm::dvec3> points, std::size_t parts, std::string_view split,
               std::string_view order, std::uint64_t seed, std::size_t threads) {
  return plan_of(points, parts, split, order, seed, threads);
}

}  // namespace delray::delaunay
