// Location by jump and walk (Muecke, Saias and Zhu 1999) and nearest vertices by greedy steps over
// Delaunay edges.
//
// The walk starts at the nearest of about n^(1/3) vertices and leaves each simplex by a facet that
// the point lies beyond, which never cycles in a Delaunay triangulation (Edelsbrunner 1990).
// O(n^(1/3)) expected for evenly spread points.
//
// Degenerate: a point on a facet is in either simplex. Without simplices nothing contains a point,
// and the nearest vertex is found by looking at all of them.
#include "delaunay/query.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "delaunay/mesh/arguments.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

double squared_distance(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return glm::dot(d, d);
}

// The side of q of the facet opposite to corner k: > 0 on that of the corner.
int side_of(int dim, std::array<glm::dvec3, 4> p, std::size_t k, const glm::dvec3& q) {
  p[k] = q;
  return dim == 2 ? orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y})
                  : orient3d(p[0], p[1], p[2], p[3]);
}

}  // namespace

Query::Query(PointView<double> points, const Triangulation& triangulation)
    : points_(points),
      triangulation_(triangulation),
      adjacency_((internal::check_view(points, triangulation.dim),
                  delaunay::adjacency(triangulation, points.size()))) {}

glm::dvec3 Query::position(std::uint32_t row) const {
  return {points_(row, 0), points_(row, 1), triangulation_.dim == 3 ? points_(row, 2) : 0.0};
}

// Leaves a simplex by any facet that has q strictly beyond it. In a Delaunay triangulation no such
// walk goes round in circles (Edelsbrunner 1990).
Query::Stop Query::walk(const glm::dvec3& q, std::uint32_t start) const {
  const std::size_t corners = static_cast<std::size_t>(triangulation_.dim) + 1;
  std::uint32_t here = start, before = kNone;
  for (;;) {
    std::array<glm::dvec3, 4> p{};
    for (std::size_t k = 0; k < corners; ++k) {
      p[k] = position(triangulation_.vertices[here * corners + k]);
    }
    std::uint32_t exit = here;
    bool out = false;
    for (std::size_t k = 0; k < corners && exit == here; ++k) {
      const std::uint32_t next = adjacency_.neighbours[here * corners + k];
      if ((next != kNone && next == before) || side_of(triangulation_.dim, p, k, q) >= 0) continue;
      if (next == kNone) {
        out = true;
        break;
      }
      exit = next;
    }
    if (exit == here) return {here, !out};
    before = here;
    here = exit;
  }
}

std::uint32_t Query::start_near(const glm::dvec3& q) const {
  const std::size_t n = triangulation_.vertices.size();
  const auto samples = static_cast<std::size_t>(std::cbrt(static_cast<double>(n))) + 1;
  std::size_t best = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t corner = i * (n - 1) / samples;
    const double d = squared_distance(position(triangulation_.vertices[corner]), q);
    if (d < distance) {
      distance = d;
      best = corner;
    }
  }
  return static_cast<std::uint32_t>(best / static_cast<std::size_t>(triangulation_.dim + 1));
}

std::uint32_t Query::locate(const glm::dvec3& q, std::uint32_t near) const {
  if (triangulation_.size() == 0) return kNone;
  const glm::dvec3 asked(q.x, q.y, triangulation_.dim == 3 ? q.z : 0.0);
  internal::check_place(asked);
  if (near != kNone && near >= triangulation_.size())
    throw std::invalid_argument("simplex " + std::to_string(near) + " does not exist");
  const Stop stop = walk(asked, near == kNone ? start_near(asked) : near);
  return stop.inside ? stop.simplex : kNone;
}

std::uint32_t Query::locate(const glm::dvec3& q) const { return locate(q, kNone); }

std::uint32_t Query::nearest(const glm::dvec3& q) const {
  const glm::dvec3 asked(q.x, q.y, triangulation_.dim == 3 ? q.z : 0.0);
  internal::check_place(asked);
  std::uint32_t best = kNone;
  double distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](std::uint32_t row) {
    const double d = squared_distance(position(row), asked);
    if (best != kNone && !(d < distance)) return false;
    best = row;
    distance = d;
    return true;
  };
  if (triangulation_.size() == 0) {
    for (std::uint32_t row = 0; row < points_.size(); ++row) consider(row);
    return best;
  }
  const std::size_t corners = static_cast<std::size_t>(triangulation_.dim) + 1;
  const std::uint32_t simplex = walk(asked, start_near(asked)).simplex;
  for (std::size_t k = 0; k < corners; ++k)
    consider(triangulation_.vertices[simplex * corners + k]);
  // A vertex that is not the nearest has a neighbour that is nearer.
  for (bool moved = true; moved;) {
    moved = false;
    for (const std::uint32_t row : vertices_around(triangulation_, adjacency_, best)) {
      moved |= consider(row);
    }
  }
  return best;
}

}  // namespace delray::delaunay
