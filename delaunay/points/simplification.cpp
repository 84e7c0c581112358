// The triangulation starts with the hull's corners. A priority queue gives the worst candidate of
// all, which is inserted by flips, and the places of the changed triangles are shared out among
// those around the new vertex. O(n log n) for usual terrains, O(n) for each kept point at worst.
#include "delaunay/points/simplification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <queue>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/predicates.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::size_t kPlacesPerBlock = 512;  // some 30 microseconds

// z + bound, or the next double below where that is none.
double sum_from_below(double z, double bound) {
  const double sum = z + bound;
  if (sum == std::numeric_limits<double>::infinity()) return std::numeric_limits<double>::max();
  // The error that rounding added (Knuth 1969).
  const double part = sum - z;
  const double lost = (z - (sum - part)) + (bound - part);
  return lost < 0 ? std::nextafter(sum, -std::numeric_limits<double>::infinity()) : sum;
}

}  // namespace

void Simplification::insert(std::uint32_t place, SimplexNumber triangle) {
  const SimplexNumber used = access_.used();
  subdivide(mesh_, triangle, place, access_, suspects_);
  for (SimplexNumber made = used; made < access_.used(); ++made) start_lists(made);
  legalize(mesh_, places_.points, access_, suspects_);
  is_kept_[place] = 1;
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

// To the list of the run, which is the last one unless that is of another triangle.
void Simplification::add(std::vector<Run>& runs, SimplexNumber triangle, std::uint32_t place) {
  if (runs.empty() || runs.back().triangle != triangle) {
    runs.push_back({triangle, {}, kNoPlace, place});
  }
  Run& run = runs.back();
  next_[place] = run.first;
  run.first = place;
  const Candidate candidate{error(triangle, place), place};
  if (candidate.is_better_than(run.candidate) && is_beyond(triangle, place)) {
    run.candidate = candidate;
  }
}

void Simplification::keep(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    next_[run.last] = first_[run.triangle];
    first_[run.triangle] = run.first;
    Candidate& best = candidates_[run.triangle];
    if (run.candidate.is_better_than(best)) best = run.candidate;
  }
}

template <class AddPlaces>
void Simplification::share_out_blocks(std::size_t n, AddPlaces&& add_places) {
  struct Block {
    std::size_t first;
    std::vector<Run> runs;
  };
  std::mutex mutex;
  std::vector<Block> blocks;
  parallel::parallel_blocks(0, n, kPlacesPerBlock, [&](std::size_t first, std::size_t last) {
    if (progress_ != nullptr) progress_->advance(0);
    Block block{first, {}};
    add_places(first, last, block.runs);
    const std::scoped_lock lock(mutex);
    blocks.push_back(std::move(block));
  });
  std::ranges::sort(blocks, {}, &Block::first);
  for (const Block& block : blocks) keep(block.runs);
}

void Simplification::start(const std::vector<std::uint32_t>& corners) {
  const auto turn =
      orient2d(places_.points[corners[0]], places_.points[corners[1]], places_.points[corners[2]]);
  start_mesh(mesh_, {corners[0], corners[turn > 0 ? 1 : 2], corners[turn > 0 ? 2 : 1]});
  for (SimplexNumber made = 0; made < access_.used(); ++made) start_lists(made);
  for (int k = 0; k < 3; ++k) is_kept_[corners[k]] = 1;
  std::uint32_t random = 1;
  SimplexNumber near = 0;
  for (std::size_t i = 3; i < corners.size(); ++i) {
    const glm::dvec2& q = places_.points[corners[i]];
    near = walk(mesh_, places_.points, near, q, random).simplex;
    insert(corners[i], near);
  }
  const auto add_places = [&](std::size_t first, std::size_t last, std::vector<Run>& runs) {
    SimplexNumber nearby = near;
    std::uint32_t choices = 1;
    for (std::size_t i = first; i < last; ++i) {
      const auto place = static_cast<std::uint32_t>(i);
      if (is_kept_[place] != 0) continue;
      nearby = walk(mesh_, places_.points, nearby, places_.points[place], choices).simplex;
      add(runs, nearby, place);
    }
  };
  share_out_blocks(places_.points.size(), add_places);
}

void Simplification::take_places(SimplexNumber triangle, std::uint32_t but,
                                 std::vector<std::uint32_t>& taken) {
  std::uint32_t& owned = first_[triangle];
  for (; owned != kNoPlace; owned = next_[owned]) {
    if (owned != but) taken.push_back(owned);
  }
}

void Simplification::find_star(std::uint32_t place, SimplexNumber triangle,
                               std::vector<CornerNumber>& star) const {
  CornerNumber corner = corner_of(triangle, 0);
  while (mesh_.vertex(corner) != place) corner = next_corner(corner);
  star.clear();
  const CornerNumber first = corner;
  do {
    star.push_back(corner);
    corner = next_corner(mesh_.neighbour(next_corner(corner)));
  } while (corner != first);
}

// By turning about the vertex from where the place before was.
void Simplification::share_out(std::uint32_t place, const std::vector<CornerNumber>& star,
                               const std::vector<std::uint32_t>& orphans, std::vector<Run>& runs) {
  const glm::dvec2& centre = places_.points[place];
  const auto side = [&](CornerNumber end, const glm::dvec2& q) {
    const VertexNumber vertex = mesh_.vertex(end);
    return vertex == kInfiniteVertex ? 0 : orient2d(centre, places_.points[vertex], q);
  };
  std::size_t finite = 0;
  while (mesh_.is_ghost(simplex_of(star[finite]))) ++finite;
  for (const CornerNumber corner : star) candidates_[simplex_of(corner)] = {};
  const auto add_orphans = [&](std::size_t first, std::size_t last, std::vector<Run>& added) {
    std::size_t i = finite;
    for (std::size_t k = first; k < last; ++k) {
      const glm::dvec2& q = places_.points[orphans[k]];
      while (side(next_corner(star[i]), q) < 0) i = (i == 0 ? star.size() : i) - 1;
      while (side(previous_corner(star[i]), q) > 0) i = i + 1 == star.size() ? 0 : i + 1;
      add(added, simplex_of(star[i]), orphans[k]);
    }
  };
  if (orphans.size() > 2 * kPlacesPerBlock) {
    return share_out_blocks(orphans.size(), add_orphans);
  }
  runs.clear();
  add_orphans(0, orphans.size(), runs);
  keep(runs);
}

std::vector<Simplification::Entry> Simplification::candidates_above(double least) const {
  std::vector<Entry> entries;
  for (SimplexNumber triangle = 0; triangle < access_.used(); ++triangle) {
    const Candidate& candidate = candidates_[triangle];
    if (candidate.place != kNoPlace && candidate.error > least) {
      entries.push_back({candidate, triangle});
    }
  }
  return entries;
}

void Simplification::refine(double least, std::size_t triangles) {
  // With entries that no longer count.
  std::priority_queue<Entry> queue(std::less<Entry>(), candidates_above(least));
  while (!queue.empty() && access_.used() < triangles) {
    const Entry entry = queue.top();
    queue.pop();
    if (candidates_[entry.triangle] != entry.candidate) continue;
    if (progress_ != nullptr) progress_->advance();
    insert(entry.candidate.place, entry.triangle);
    // The triangles that an insertion changed are those around the new vertex.
    find_star(entry.candidate.place, entry.triangle, star_);
    orphans_.clear();
    for (const CornerNumber corner : star_) {
      take_places(simplex_of(corner), entry.candidate.place, orphans_);
    }
    share_out(entry.candidate.place, star_, orphans_, runs_);
    for (const CornerNumber corner : star_) {
      const SimplexNumber triangle = simplex_of(corner);
      const Candidate& candidate = candidates_[triangle];
      if (candidate.place != kNoPlace && candidate.error > least) queue.push({candidate, triangle});
    }
  }
}

// Those of the vertices of all triangles but the ghosts, three by three.
std::vector<std::uint32_t> Simplification::rows_of_triangles() const {
  constexpr std::size_t kGrain = 8192;
  const std::size_t blocks = (access_.used() + kGrain - 1) / kGrain;
  const auto for_each_of = [&](std::size_t block, auto&& f) {
    const std::size_t end = std::min<std::size_t>(access_.used(), (block + 1) * kGrain);
    for (auto t = static_cast<SimplexNumber>(block * kGrain); t < end; ++t) {
      if (!mesh_.is_dead(t) && !mesh_.is_ghost(t)) f(t);
    }
  };
  std::vector<std::size_t> first(blocks + 1, 0);
  parallel::parallel_for(0, blocks, 1, [&](std::size_t block) {
    for_each_of(block, [&](SimplexNumber) { first[block + 1] += 3; });
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> rows(first.back());
  parallel::parallel_for(0, blocks, 1, [&](std::size_t block) {
    std::size_t i = first[block];
    for_each_of(block, [&](SimplexNumber t) {
      for (unsigned k = 0; k < 3; ++k) rows[i++] = places_.rows[mesh_.vertex(corner_of(t, k))];
    });
  });
  return rows;
}

SimplifiedTerrain Simplification::result() const {
  SimplifiedTerrain result;
  Triangulation& triangulation = result.triangulation;
  triangulation.distinct = places_.points.size();
  std::vector<std::uint8_t> is_kept_row(std::ranges::max(places_.rows) + std::size_t{1}, 0);
  for (std::uint32_t place = 0; place < places_.points.size(); ++place)
    is_kept_row[places_.rows[place]] = is_kept_[place];
  for (std::size_t row = 0; row < is_kept_row.size(); ++row) {
    if (is_kept_row[row] != 0) result.kept.push_back(static_cast<std::uint32_t>(row));
  }
  triangulation.vertices = rows_of_triangles();
  // A sphere of triangles and ghosts, two fewer than twice its vertices with the infinite one.
  triangulation.hull_facets = 2 * result.kept.size() - 2 - triangulation.vertices.size() / 3;
  // They are all within the bound, whatever rounding says.
  const auto error_of = [&](std::size_t first, std::size_t last) {
    double largest = 0;
    for (std::size_t t = first; t < last; ++t) {
      const auto triangle = static_cast<SimplexNumber>(t);
      for (std::uint32_t place = first_[t]; place != kNoPlace; place = next_[place])
        largest = std::max(largest, std::min(error(triangle, place), max_error_));
    }
    return largest;
  };
  constexpr std::size_t kTrianglesPerBlock = 1024;
  result.largest_error =
      parallel::parallel_reduce(0, access_.used(), kTrianglesPerBlock, 0.0, error_of,
                                [](double a, double b) { return std::max(a, b); });
  return result;
}

}  // namespace delray::delaunay::internal
