// Cavities (Bowyer 1981, Watson 1981) have no vertices within: they are trees of triangles, which
// are walked over their edges and never met twice.
#include "delaunay/raster/cavity_patch.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <utility>

#include "delaunay/predicates.h"
#include "delaunay/raster/triangle_cells.h"
#include "delaunay/tiles/box_tree.h"
#include "delaunay/tiles/circumball.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

CavityPatch::CavityPatch(const PatchTriangles& triangles, std::vector<std::uint8_t> met,
                         bool is_all)
    : triangles_(triangles),
      met_(std::move(met)),
      is_all_(is_all),
      mates_(match_facets(2, triangles.corners, triangles.points.size()).mates),
      marks_(triangles.corners.size() / 3) {}

std::array<glm::dvec2, 3> CavityPatch::places(std::size_t triangle) const {
  const std::uint32_t* v = triangles_.corners.data() + 3 * triangle;
  return {place(v[0]), place(v[1]), place(v[2])};
}

void CavityPatch::mark(std::size_t triangle, Mark mark) {
  std::atomic_ref(marks_[triangle]).fetch_or(mark, std::memory_order_relaxed);
}

unsigned CavityPatch::met(std::size_t triangle) const {
  unsigned bits = met_.empty() ? 0 : met_[triangle];
  for (unsigned k = 0; k < 3; ++k) {
    if (mates_[3 * triangle + k] != FacetMates::kNone) bits |= 1U << k;
  }
  return bits;
}

// The triangles that hold q, which is in the first of them. False where some may be missing.
bool CavityPatch::find_cavity(std::size_t triangle, const glm::dvec2& q, Scratch& scratch) const {
  auto& [cavity, edges, vertices, triangles] = scratch;
  bool complete = true;
  cavity.assign(1, static_cast<std::uint32_t>(triangle));
  edges.clear();  // to cross, of triangles in the cavity
  for (unsigned k = 0; k < 3; ++k) edges.push_back(static_cast<std::uint32_t>(3 * triangle + k));
  while (!edges.empty()) {
    const std::uint32_t edge = edges.back(), mate = mates_[edge];
    edges.pop_back();
    if (mate == FacetMates::kNone) {
      complete = complete && !is_open(edge);
      continue;
    }
    const std::uint32_t next = mate / 3;
    const auto p = places(next);
    if (incircle(p[0], p[1], p[2], q) <= 0) continue;
    cavity.push_back(next);
    assert(cavity.size() <= marks_.size());
    for (unsigned k = 1; k < 3; ++k) edges.push_back(3 * next + (mate + k) % 3);
  }
  return complete;
}

// Vertices are numbered by ascending rows, which is all that counts of these.
double CavityPatch::value(const glm::dvec2& q, Scratch& scratch) const {
  auto& [cavity, edges, vertices, triangles] = scratch;
  vertices.clear();
  for (const std::uint32_t t : cavity) {
    const std::uint32_t* v = triangles_.corners.data() + 3 * std::size_t{t};
    vertices.insert(vertices.end(), v, v + 3);
  }
  const auto by_row = [&](std::uint32_t v) { return row(v); };
  std::ranges::sort(vertices, {}, by_row);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  triangles.clear();
  for (const std::uint32_t t : cavity) {
    CavityTriangle& triangle = triangles.emplace_back();
    triangle.at = places(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t own = row(triangles_.corners[3 * std::size_t{t} + k]);
      const auto at = std::ranges::lower_bound(vertices, own, {}, by_row);
      triangle.rows[k] = static_cast<std::uint32_t>(at - vertices.begin());
      const bool hull = is_all_ && mates_[3 * std::size_t{t} + k] == FacetMates::kNone &&
                        (met_.empty() || (met_[t] >> k & 1) == 0);
      if (hull) triangle.hull |= static_cast<std::uint8_t>(1U << k);
    }
  }
  double sum = 0;
  for (const NaturalNeighbour& neighbour : shares_in_plane(triangles, q)) {
    sum += neighbour.weight * height(vertices[neighbour.row]);
  }
  return sum;
}

void CavityPatch::set_cells_of(std::size_t triangle, const RasterGrid& grid, Scratch& scratch,
                               std::vector<CellHeight>& cells) {
  const std::uint32_t* v = triangles_.corners.data() + 3 * triangle;
  std::array<glm::dvec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = {place(v[k]), height(v[k])};
  if (!may_have_centres(grid, corners[0], corners[1], corners[2])) return;
  const HeightTriangle area(corners);
  const auto for_centres = [&](const auto& f) {
    for_cells(grid, area, [&](const CellRun& run, bool) {
      for (std::uint64_t column = run.first; column < run.last; ++column) {
        f(column, run.row, glm::dvec2(grid.x(column), grid.y(run.row)));
      }
    });
  };
  bool waits = false;
  for_centres([&](std::uint64_t column, std::uint64_t row, const glm::dvec2& q) {
    const auto at_q =
        std::ranges::find_if(corners, [&](const glm::dvec3& p) { return glm::dvec2(p) == q; });
    if (at_q != corners.end()) {
      cells.push_back({column, row, static_cast<float>(at_q->z)});
    } else if (find_cavity(triangle, q, scratch)) {
      cells.push_back({column, row, static_cast<float>(value(q, scratch))});
    } else {
      waits = true;
    }
  });
  if (!waits) return;
  // All of its cells are looked at again, those that are done as well.
  mark(triangle, kHasCells);
  for_centres([&](std::uint64_t, std::uint64_t, const glm::dvec2& q) {
    find_cavity(triangle, q, scratch);
    for (const std::uint32_t each : scratch.cavity) mark(each, kNeeded);
  });
}

void CavityPatch::set_cells(TerrainRaster& raster, std::span<const std::uint8_t> wanted) {
  constexpr std::size_t kTriangles = 1 << 12;  // some milliseconds of fine cells
  parallel::parallel_for(0, (marks_.size() + kTriangles - 1) / kTriangles, 1, [&](std::size_t run) {
    Scratch scratch;
    std::vector<CellHeight> cells;
    const std::size_t end = std::min(marks_.size(), (run + 1) * kTriangles);
    for (std::size_t t = run * kTriangles; t < end; ++t) {
      if (!wanted.empty() && wanted[t] == 0) continue;
      set_cells_of(t, raster.grid(), scratch, cells);
      constexpr std::size_t kMostCells = 1 << 16;
      if (cells.size() < kMostCells) continue;
      raster.set(cells);
      cells.clear();
    }
    raster.set(cells);
  });
}

// From the triangles at the border on, over those whose circles reach it.
void CavityPatch::mark_borders() {
  using Box = geometry::Box<glm::dvec2>;
  std::vector<Box> boxes;
  std::vector<std::uint32_t> front;
  for (std::size_t edge = 0; edge < mates_.size(); ++edge) {
    if (!is_open(edge)) continue;
    const auto p = places(edge / 3);
    Box box;
    box.include(p[(edge + 1) % 3]);
    box.include(p[(edge + 2) % 3]);
    boxes.push_back(box);
    front.push_back(static_cast<std::uint32_t>(edge / 3));
  }
  const BoxTree<glm::dvec2> tree(boxes);
  std::vector<bool> looked_at(marks_.size());
  for (const std::uint32_t t : front) looked_at[t] = true;
  while (!front.empty()) {
    const std::uint32_t t = front.back();
    front.pop_back();
    const Circumball<2> ball(places(t));
    if (!tree.any([&](const Box& box) { return ball.touches(box); },
                  [](std::uint32_t) { return true; })) {
      continue;
    }
    mark(t, kNeeded);
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t mate = mates_[3 * std::size_t{t} + k];
      if (mate == FacetMates::kNone || looked_at[mate / 3]) continue;
      looked_at[mate / 3] = true;
      front.push_back(mate / 3);
    }
  }
}

}  // namespace delray::delaunay::internal
