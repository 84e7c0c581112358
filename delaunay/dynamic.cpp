#include "delaunay/dynamic.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "delaunay/conflict.h"
#include "delaunay/insertion_order.h"
#include "delaunay/internal/flip.h"
#include "delaunay/internal/refill.h"
#include "delaunay/predicates.h"
#include "delaunay/walk.h"

namespace delray::delaunay {
namespace {

// -0 made equal to 0 in every bit.
glm::dvec2 checked(double x, double y, std::size_t row) {
  if (!std::isfinite(x) || !std::isfinite(y)) {
    throw std::invalid_argument("row " + std::to_string(row) +
                                " has a coordinate that is not finite");
  }
  return {x + 0.0, y + 0.0};
}

std::uint32_t next_random(std::uint32_t& state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

}  // namespace

std::size_t DynamicTriangulation::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15;
  hash = (hash ^ (hash >> 32) ^ std::bit_cast<std::uint64_t>(key.y)) * 0xd6e8feb86659fd93;
  return hash ^ (hash >> 32);
}

SimplexNumber DynamicTriangulation::create() {
  if (free_slots_.empty()) return used_++;
  const SimplexNumber slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

void DynamicTriangulation::retire(SimplexNumber simplex) {
  mesh_.set_vertex(corner_of(simplex, 0), kDeadVertex);
  free_slots_.push_back(simplex);
}

void DynamicTriangulation::reserve(std::size_t simplices) {
  if (simplices <= mesh_.size()) return;
  Mesh<2> larger(std::max<std::size_t>({simplices, 2 * mesh_.size(), 64}));
  for (SimplexNumber t = 0; t < used_; ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      larger.set_vertex(corner_of(t, k), mesh_.vertex(corner_of(t, k)));
      if (!mesh_.is_dead(t)) larger.link(corner_of(t, k), mesh_.neighbour(corner_of(t, k)));
    }
  }
  mesh_ = std::move(larger);
}

std::uint32_t DynamicTriangulation::add_row(const glm::dvec2& point) {
  const auto row = static_cast<std::uint32_t>(site_of_.size());
  if (row >= kMaximumSimplices / 2) throw std::invalid_argument("more than 2^29 points");
  const auto [place, is_new] = site_at_.try_emplace({point.x, point.y}, kNoSite);
  if (is_new) {
    if (free_sites_.empty()) {
      place->second = static_cast<std::uint32_t>(positions_.size());
      positions_.emplace_back();
      rows_.emplace_back();
      near_.push_back(0);
    } else {
      place->second = free_sites_.back();
      free_sites_.pop_back();
    }
    positions_[place->second] = point;
  }
  rows_[place->second].push_back(row);
  site_of_.push_back(place->second);
  ++live_;
  return row;
}

// The first triangle, a, b, c counterclockwise, and the ghosts around it.
void DynamicTriangulation::start_mesh(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  reserve(4);
  used_ = 4;
  free_slots_.clear();
  last_ = 0;
  meshed_ = true;
  const std::uint32_t sites[3] = {a, b, c};
  for (unsigned k = 0; k < 3; ++k) {
    mesh_.set_vertex(corner_of(0, k), sites[k]);
    near_[sites[k]] = 0;
    const SimplexNumber ghost = 1 + k;
    mesh_.set_vertex(corner_of(ghost, 0), sites[(k + 2) % 3]);
    mesh_.set_vertex(corner_of(ghost, 1), sites[(k + 1) % 3]);
    mesh_.set_vertex(corner_of(ghost, 2), kInfiniteVertex);
    mesh_.link(corner_of(ghost, 2), corner_of(0, k));
    mesh_.link(corner_of(ghost, 1), corner_of(1 + (k + 1) % 3, 0));
  }
}

// The nearest of n^(1/3) random sites and the last place, whose simplex need only be somewhere
// near (Muecke, Saias, Zhu 1999).
SimplexNumber DynamicTriangulation::start_near(const glm::dvec2& q) {
  const auto distance = [&](const glm::dvec2& p) { return glm::dot(p - q, p - q); };
  SimplexNumber best = last_;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned k = 0; k < 3; ++k) {
    const VertexNumber vertex = mesh_.vertex(corner_of(last_, k));
    if (vertex != kInfiniteVertex) least = std::min(least, distance(positions_[vertex]));
  }
  auto samples = static_cast<std::size_t>(std::cbrt(static_cast<double>(positions_.size())));
  for (; samples > 0; --samples) {
    const std::uint32_t site = next_random(random_) % static_cast<std::uint32_t>(positions_.size());
    const SimplexNumber simplex = near_[site];
    if (rows_[site].empty() || simplex >= used_ || mesh_.is_dead(simplex)) continue;
    if (const double d = distance(positions_[site]); d < least) {
      least = d;
      best = simplex;
    }
  }
  return best;
}

void DynamicTriangulation::insert_site(std::uint32_t site) {
  reserve(std::size_t{used_} + 2);
  const Place place =
      walk(mesh_, positions_, start_near(positions_[site]), positions_[site], random_);
  Access access{*this};
  internal::subdivide(mesh_, place.simplex, site, access, suspects_);
  near_[site] = last_ = place.simplex;
  internal::legalize(mesh_, positions_, access, suspects_);
}

void DynamicTriangulation::add_site(std::uint32_t site) {
  if (meshed_) {
    insert_site(site);
    return;
  }
  // Those before are on one line: any two of them tell whether this one is on it.
  const auto is_on_line = [&](std::uint32_t s) {
    return s != site && s < positions_.size() && !rows_[s].empty() && near_[s] != kDeadVertex;
  };
  if (line_[0] == line_[1] || !is_on_line(line_[0]) || !is_on_line(line_[1])) {
    int found = 0;
    for (std::uint32_t s = 0; s < positions_.size() && found < 2; ++s) {
      if (is_on_line(s)) line_[found++] = s;
    }
    if (found < 2) {
      line_ = {kNoSite, kNoSite};
      near_[site] = 0;
      return;
    }
  }
  near_[site] = 0;
  const auto other = line_;
  const int turn = orient2d(positions_[other[0]], positions_[other[1]], positions_[site]);
  if (turn == 0) return;
  start_mesh(other[turn > 0 ? 0 : 1], other[turn > 0 ? 1 : 0], site);
  for (std::uint32_t s = 0; s < positions_.size(); ++s) {
    if (s == site || s == other[0] || s == other[1]) continue;
    if (is_on_line(s)) insert_site(s);
  }
}

std::uint32_t DynamicTriangulation::insert(const glm::dvec2& point) {
  const auto row = static_cast<std::uint32_t>(site_of_.size());
  add_row(checked(point.x, point.y, row));
  if (rows_[site_of_[row]].size() == 1) add_site(site_of_[row]);
  return row;
}

std::uint32_t DynamicTriangulation::insert(PointView<double> points) {
  const std::size_t first = site_of_.size();
  if (points.size() > kMaximumSimplices / 2 - first) {
    throw std::invalid_argument("more than 2^29 points");
  }
  std::vector<glm::dvec2> batch(points.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    batch[i] = checked(points(i, 0), points(i, 1), first + i);
  }
  std::vector<bool> is_first(batch.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t site = site_of_[add_row(batch[i])];
    is_first[i] = rows_[site].size() == 1;
    if (is_first[i]) near_[site] = kDeadVertex;  // not of the mesh yet, nor of the line
  }
  reserve(2 * positions_.size() + 2);
  for (const std::uint32_t i : insertion_order(batch, "brio", 1)) {
    if (is_first[i]) add_site(site_of_[first + i]);
  }
  return static_cast<std::uint32_t>(first);
}

void DynamicTriangulation::flatten() {
  meshed_ = false;
  used_ = 0;
  free_slots_.clear();
  std::ranges::fill(near_, 0);
}

void DynamicTriangulation::remove_site(std::uint32_t site) {
  const Place place =
      walk(mesh_, positions_, start_near(positions_[site]), positions_[site], random_);
  CornerNumber corner = corner_of(place.simplex, 0);
  while (mesh_.vertex(corner) != site) corner = next_corner(corner);
  internal::Ring ring = internal::ring_around(mesh_, corner);
  if (ring.vertices.size() == site_at_.size() && internal::is_flat(ring, positions_)) {
    // Only infinity and points of one line are left.
    flatten();
    return;
  }
  std::vector<SimplexNumber> slots = ring.simplices;
  internal::refill(mesh_, positions_, ring, slots);
  last_ = ring.simplices.back();
  for (const SimplexNumber slot : slots) retire(slot);
  for (const VertexNumber vertex : ring.vertices) {
    if (vertex != kInfiniteVertex) near_[vertex] = last_;
  }
}

bool DynamicTriangulation::remove(std::uint32_t row) {
  if (!is_live(row)) return false;
  const std::uint32_t site = site_of_[row];
  std::vector<std::uint32_t>& rows = rows_[site];
  if (rows.size() == 1) {
    if (meshed_) remove_site(site);
    site_at_.erase({positions_[site].x, positions_[site].y});
    free_sites_.push_back(site);
  }
  rows.erase(std::ranges::find(rows, row));
  site_of_[row] = kNoSite;
  --live_;
  return true;
}

Triangulation DynamicTriangulation::triangulation() const {
  Triangulation result;
  result.distinct = site_at_.size();
  for (SimplexNumber t = 0; meshed_ && t < used_; ++t) {
    if (mesh_.is_dead(t)) continue;
    if (mesh_.is_ghost(t)) {
      ++result.hull_facets;
      continue;
    }
    for (unsigned k = 0; k < 3; ++k) {
      result.vertices.push_back(rows_[mesh_.vertex(corner_of(t, k))].front());
    }
  }
  return result;
}

}  // namespace delray::delaunay
