// Greedy insertion for simplified terrains (Puppo, Davis, De Menthon and Teng 1994; Garland and
// Heckbert 1995).
//
// The triangulation starts with the hull's corners (Andrew 1979). Each triangle keeps a list of the
// places in it and a candidate, the farthest one beyond the bound; a priority queue gives the worst
// of all, which is inserted by flips, and the places of the changed triangles are shared out among
// those around the new vertex. O(n log n) for usual terrains, O(n) for each kept point at worst.
//
// Degenerate: places on one line keep nothing. Whether a place is beyond the bound is an exact
// predicate, so rounding may affect the order of insertions but never the bound; errors that
// overflow count as infinite.
#include "delaunay/simplify_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <string>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/insertion/first_triangle.h"
#include "delaunay/insertion/insertion_order.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/access.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

constexpr std::uint32_t kNoPlace = 0xffffffffU;

// Distinct places, along a Hilbert curve.
struct Places {
  std::vector<glm::dvec2> points;
  std::vector<double> heights;
  std::vector<std::uint32_t> rows;  // of several rows at a place the lowest
};

// The corners of the convex hull of points in lexicographic order, as indices (Andrew 1979).
std::vector<std::uint32_t> hull_corners(const std::vector<glm::dvec2>& points) {
  std::vector<std::uint32_t> chain;
  std::size_t fixed = 1;  // of the chain before
  const auto add = [&](std::uint32_t i) {
    while (chain.size() > fixed &&
           orient2d(points[chain[chain.size() - 2]], points[chain.back()], points[i]) <= 0) {
      chain.pop_back();
    }
    chain.push_back(i);
  };
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i) add(i);
  fixed = chain.size();
  for (std::uint32_t i = n - 1; i-- > 0;) add(i);
  chain.pop_back();  // the first again
  return chain;
}

// z + bound, or the next double below where that is none.
double sum_from_below(double z, double bound) {
  const double sum = z + bound;
  if (sum == std::numeric_limits<double>::infinity()) return std::numeric_limits<double>::max();
  // The error that rounding added (Knuth 1969).
  const double part = sum - z;
  const double lost = (z - (sum - part)) + (bound - part);
  return lost < 0 ? std::nextafter(sum, -std::numeric_limits<double>::infinity()) : sum;
}

class Simplification {
 public:
  Simplification(Places places, double max_error, parallel::Progress* progress)
      : places_(std::move(places)),
        max_error_(max_error),
        progress_(progress),
        is_kept_(places_.points.size(), false),
        next_(places_.points.size(), kNoPlace) {}

  // REQUIRES: corners of the hull, at least three, in an order that is good for insertion.
  void start(const std::vector<std::uint32_t>& corners);
  // Inserts until the bound holds.
  void refine();
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

  void insert(std::uint32_t place, SimplexNumber triangle);
  void reserve(std::size_t triangles);
  void own(SimplexNumber triangle, std::uint32_t place) {
    next_[place] = first_[triangle];
    first_[triangle] = place;
  }
  void share_out(std::uint32_t place, SimplexNumber triangle);
  void find_candidate(SimplexNumber triangle);
  glm::dvec3 at(std::uint32_t place) const {
    return {places_.points[place], places_.heights[place]};
  }
  double error(SimplexNumber triangle, std::uint32_t place) const;
  bool is_beyond(SimplexNumber triangle, std::uint32_t place) const;

  Places places_;
  double max_error_;
  parallel::Progress* progress_;
  std::vector<bool> is_kept_;
  Mesh<2> mesh_;
  internal::SoleAccess access_{4};
  std::vector<CornerNumber> suspects_;
  // The places in a triangle, its boundary included, that are not kept: a list for each triangle.
  std::vector<std::uint32_t> first_, next_;
  std::vector<Candidate> candidates_;  // per triangle
  std::priority_queue<Entry> queue_;   // with entries that no longer count
  std::vector<CornerNumber> star_;
  std::vector<std::uint32_t> orphans_;
};

void Simplification::reserve(std::size_t triangles) {
  if (triangles <= mesh_.size()) return;
  mesh_.grow(std::max<std::size_t>(triangles, 2 * mesh_.size()));
  first_.resize(mesh_.size(), kNoPlace);
  candidates_.resize(mesh_.size());
}

void Simplification::insert(std::uint32_t place, SimplexNumber triangle) {
  reserve(std::size_t{access_.used()} + 2);
  internal::subdivide(mesh_, triangle, place, access_, suspects_);
  internal::legalize(mesh_, places_.points, access_, suspects_);
  is_kept_[place] = true;
}

// In floating point, and infinite where that fails.
double Simplification::error(SimplexNumber triangle, std::uint32_t place) const {
  const glm::dvec3 q = at(place);
  std::array<glm::dvec3, 3> p;
  for (unsigned k = 0; k < 3; ++k) p[k] = at(mesh_.vertex(corner_of(triangle, k))) - q;
  const auto area = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; };
  const double a = area(p[1], p[2]), b = area(p[2], p[0]), c = area(p[0], p[1]);
  const double result = std::abs((a * p[0].z + b * p[1].z + c * p[2].z) / (a + b + c));
  return std::isfinite(result) ? result : std::numeric_limits<double>::infinity();
}

bool Simplification::is_beyond(SimplexNumber triangle, std::uint32_t place) const {
  const glm::dvec3 a = at(mesh_.vertex(corner_of(triangle, 0)));
  const glm::dvec3 b = at(mesh_.vertex(corner_of(triangle, 1)));
  const glm::dvec3 c = at(mesh_.vertex(corner_of(triangle, 2)));
  glm::dvec3 q = at(place);
  const double z = q.z;
  q.z = sum_from_below(z, max_error_);
  if (orient3d(a, b, c, q) < 0) return true;
  q.z = -sum_from_below(-z, max_error_);
  return orient3d(a, b, c, q) > 0;
}

void Simplification::find_candidate(SimplexNumber triangle) {
  Candidate best;
  for (std::uint32_t place = first_[triangle]; place != kNoPlace; place = next_[place]) {
    const Candidate candidate{error(triangle, place), place};
    if (best.place != kNoPlace && !(Entry{best, 0} < Entry{candidate, 0})) continue;
    if (is_beyond(triangle, place)) best = candidate;
  }
  candidates_[triangle] = best;
  if (best.place != kNoPlace) queue_.push({best, triangle});
}

void Simplification::start(const std::vector<std::uint32_t>& corners) {
  const auto turn =
      orient2d(places_.points[corners[0]], places_.points[corners[1]], places_.points[corners[2]]);
  reserve(2 * corners.size());
  internal::start_mesh(mesh_, {corners[0], corners[turn > 0 ? 1 : 2], corners[turn > 0 ? 2 : 1]});
  for (int k = 0; k < 3; ++k) is_kept_[corners[k]] = true;
  std::uint32_t random = 1;
  SimplexNumber near = 0;
  for (std::size_t i = 3; i < corners.size(); ++i) {
    const glm::dvec2& q = places_.points[corners[i]];
    near = walk(mesh_, places_.points, near, q, random).simplex;
    insert(corners[i], near);
  }
  for (std::uint32_t place = 0; place < places_.points.size(); ++place) {
    constexpr std::uint32_t kPlacesPerLook = 1024;
    if (progress_ != nullptr && place % kPlacesPerLook == 0) progress_->advance(0);
    if (is_kept_[place]) continue;
    near = walk(mesh_, places_.points, near, places_.points[place], random).simplex;
    own(near, place);
  }
  for (SimplexNumber triangle = 0; triangle < access_.used(); ++triangle) find_candidate(triangle);
}

// The triangles that an insertion changed are those around the new vertex, so what they own is
// shared out among them: by turning about the vertex from where the place before was.
void Simplification::share_out(std::uint32_t place, SimplexNumber triangle) {
  CornerNumber corner = corner_of(triangle, 0);
  while (mesh_.vertex(corner) != place) corner = next_corner(corner);
  star_.clear();
  orphans_.clear();
  const CornerNumber first = corner;
  do {
    star_.push_back(corner);
    std::uint32_t& owned = first_[simplex_of(corner)];
    for (; owned != kNoPlace; owned = next_[owned]) {
      if (owned != place) orphans_.push_back(owned);
    }
    corner = next_corner(mesh_.neighbour(next_corner(corner)));
  } while (corner != first);

  const glm::dvec2& centre = places_.points[place];
  const auto side = [&](CornerNumber end, const glm::dvec2& q) {
    const VertexNumber vertex = mesh_.vertex(end);
    return vertex == kInfiniteVertex ? 0 : orient2d(centre, places_.points[vertex], q);
  };
  std::size_t i = 0;
  while (mesh_.is_ghost(simplex_of(star_[i]))) ++i;
  for (const std::uint32_t orphan : orphans_) {
    const glm::dvec2& q = places_.points[orphan];
    while (side(next_corner(star_[i]), q) < 0) i = (i == 0 ? star_.size() : i) - 1;
    while (side(previous_corner(star_[i]), q) > 0) i = i + 1 == star_.size() ? 0 : i + 1;
    own(simplex_of(star_[i]), orphan);
  }
  for (const CornerNumber changed : star_) find_candidate(simplex_of(changed));
}

void Simplification::refine() {
  while (!queue_.empty()) {
    const Entry entry = queue_.top();
    queue_.pop();
    if (candidates_[entry.triangle] != entry.candidate) continue;
    if (progress_ != nullptr) progress_->advance();
    insert(entry.candidate.place, entry.triangle);
    share_out(entry.candidate.place, entry.triangle);
  }
}

SimplifiedTerrain Simplification::result() const {
  SimplifiedTerrain result;
  Triangulation& triangulation = result.triangulation;
  triangulation.distinct = places_.points.size();
  for (std::uint32_t place = 0; place < places_.points.size(); ++place) {
    if (is_kept_[place]) result.kept.push_back(places_.rows[place]);
  }
  std::ranges::sort(result.kept);
  for (SimplexNumber triangle = 0; triangle < access_.used(); ++triangle) {
    if (mesh_.is_ghost(triangle)) {
      ++triangulation.hull_facets;
      continue;
    }
    for (unsigned k = 0; k < 3; ++k) {
      triangulation.vertices.push_back(places_.rows[mesh_.vertex(corner_of(triangle, k))]);
    }
    for (std::uint32_t place = first_[triangle]; place != kNoPlace; place = next_[place]) {
      // They are all within the bound, whatever rounding says.
      result.largest_error =
          std::max(result.largest_error, std::min(error(triangle, place), max_error_));
    }
  }
  return result;
}

// The lowest row of each place, in lexicographic order.
Places distinct_places(const PointView<double>& points) {
  std::vector<std::uint32_t> rows(points.size());
  std::iota(rows.begin(), rows.end(), 0U);
  const auto at = [&](std::uint32_t row) { return glm::dvec2(points(row, 0), points(row, 1)); };
  std::ranges::sort(rows, [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec2 a = at(i), b = at(j);
    return a == b ? i < j : lexicographically_less(a, b);
  });
  Places places;
  for (const std::uint32_t row : rows) {
    const glm::dvec2 p = at(row) + 0.0;
    if (!places.points.empty() && places.points.back() == p) continue;
    places.points.push_back(p);
    places.rows.push_back(row);
  }
  return places;
}

void check(const PointView<double>& points, double max_error) {
  if (!(max_error >= 0 && std::isfinite(max_error))) {
    throw std::invalid_argument("the largest error must be finite and not negative");
  }
  if (points.size() > kMaximumSimplices / 2) throw std::invalid_argument("more than 2^29 points");
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (int k = 0; k < 3; ++k) {
      if (std::isfinite(points(row, k))) continue;
      throw std::invalid_argument("row " + std::to_string(row) +
                                  " has a coordinate that is not finite");
    }
  }
}

}  // namespace

SimplifiedTerrain simplify_terrain(PointView<double> points, double max_error,
                                   parallel::Progress* progress) {
  internal::check_view(points, 3);
  check(points, max_error);
  if (progress != nullptr) progress->start(points.size());
  Places sorted = distinct_places(points);
  const std::size_t n = sorted.points.size();
  std::vector<std::uint32_t> corners;
  if (n > 2) corners = hull_corners(sorted.points);
  if (corners.size() < 3) {
    SimplifiedTerrain result;
    result.triangulation.distinct = n;
    if (progress != nullptr) progress->advance(points.size());
    return result;
  }

  const std::vector<std::uint32_t> order = insertion_order(sorted.points, "hilbert", 1);
  Places places;
  std::vector<std::uint32_t> number(n);  // along the curve
  for (const std::uint32_t i : order) {
    number[i] = static_cast<std::uint32_t>(places.points.size());
    places.points.push_back(sorted.points[i]);
    places.rows.push_back(sorted.rows[i]);
    places.heights.push_back(points(sorted.rows[i], 2) + 0.0);
  }
  sorted = {};
  std::vector<glm::dvec2> ends;
  for (std::uint32_t& corner : corners) {
    corner = number[corner];
    ends.push_back(places.points[corner]);
  }
  std::vector<std::uint32_t> shuffled;
  for (const std::uint32_t i : insertion_order(ends, "brio", 1)) shuffled.push_back(corners[i]);

  Simplification simplification(std::move(places), max_error, progress);
  simplification.start(shuffled);
  simplification.refine();
  SimplifiedTerrain result = simplification.result();
  if (progress != nullptr) progress->advance(points.size() - progress->done());
  return result;
}

PointCloud select_rows(const PointCloud& cloud, const std::vector<std::uint32_t>& rows) {
  internal::check_attributes(cloud);
  for (const std::uint32_t row : rows) {
    if (row >= cloud.size())
      throw std::invalid_argument("row " + std::to_string(row) + " does not exist");
  }
  const auto select = [&](auto& to, const auto& from) {
    if (from.empty()) return;
    to.reserve(rows.size());
    for (const std::uint32_t row : rows) to.push_back(from[row]);
  };
  PointCloud result;
  result.has_z = cloud.has_z;
  select(result.positions, cloud.positions);
  select(result.colours, cloud.colours);
  select(result.intensity, cloud.intensity);
  select(result.classification, cloud.classification);
  select(result.returns, cloud.returns);
  return result;
}

}  // namespace delray::delaunay
