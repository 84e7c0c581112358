// A tree of planes across the longest side of the box around the centres of pages, in the middle;
// on odd levels the first one across each axis at a third, so that no plane is near one of an even
// level (alternate partitions: Cignoni, Ganovelli, Gobbetti, Marton, Ponchio and Scopigno, Batched
// Multi Triangulation, 2005).
//
// Nested cells are halves by number, across the longest side, however pages lie.
//
// Degenerate: pages with all centres at one place are in one cell, whatever they have; their groups
// are cut by number.
#include "packs/build/page_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace delray::packs::internal {

Cells::Cells(std::span<const PageRow> rows, PageRange pages, double triangles, int level) {
  std::vector<std::uint32_t> numbers(pages.count);
  std::iota(numbers.begin(), numbers.end(), pages.first);
  cells_ = 0;
  cut(rows, numbers, triangles, level, 0);
}

std::uint32_t Cells::cut(std::span<const PageRow> rows, std::span<std::uint32_t> pages,
                         double triangles, int level, unsigned cut_axes) {
  geometry::Box3 centres;
  double sum = 0;
  for (const std::uint32_t page : pages) {
    centres.include(rows[page].box.centre());
    sum += rows[page].triangles;
  }
  const double count = std::round(sum / triangles);
  if (pages.size() < 2 || count < 2) return cells_++ | kCell;
  const glm::vec3 size = centres.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto coordinate = [&](std::uint32_t page) { return rows[page].box.centre()[axis]; };
  constexpr double kThird = 1.0 / 3.0;
  const bool is_first = (cut_axes >> axis & 1) == 0;
  const double wanted = level % 2 == 1 && is_first ? kThird : 0.5;
  cut_axes |= 1U << axis;
  // So that cells on either side can be alike.
  const double share = std::clamp(std::round(wanted * count), 1.0, count - 1) / count;
  auto first = static_cast<std::size_t>(share * static_cast<double>(pages.size()));
  first = std::clamp(first, std::size_t{1}, pages.size() - 1);
  const auto middle = pages.begin() + static_cast<std::ptrdiff_t>(first);
  std::nth_element(pages.begin(), middle, pages.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return coordinate(a) < coordinate(b); });
  // Where so many have the lowest one, the next above.
  const float low = centres.low[axis];
  float at = coordinate(*middle);
  if (!(at > low)) {
    at = centres.high[axis];
    for (const std::uint32_t page : pages)
      if (const float c = coordinate(page); c > low) at = std::min(at, c);
    if (!(at > low)) return cells_++ | kCell;
  }
  const auto end = std::partition(pages.begin(), pages.end(),
                                  [&](std::uint32_t page) { return coordinate(page) < at; });
  const auto before = static_cast<std::size_t>(end - pages.begin());
  const auto number = static_cast<std::uint32_t>(planes_.size());
  planes_.push_back({axis, at, 0, 0});
  const std::uint32_t child = cut(rows, pages.first(before), triangles, level, cut_axes);
  planes_[number].before = child;
  const std::uint32_t other = cut(rows, pages.subspan(before), triangles, level, cut_axes);
  planes_[number].behind = other;
  return number;
}

std::uint32_t Cells::cell_of(const glm::vec3& place) const {
  if (planes_.empty()) return 0;
  std::uint32_t at = 0;
  while ((at & kCell) == 0) {
    const Plane& plane = planes_[at];
    at = place[plane.axis] < plane.at ? plane.before : plane.behind;
  }
  return at & ~kCell;
}

namespace {

// Brings pages into order across the longest side of the box around their centres; returns how many
// are in the first half.
std::size_t cut_in_half(std::span<const PageRow> rows, std::span<std::uint32_t> pages) {
  const std::size_t half = pages.size() / 2;
  geometry::Box3 centres;
  for (const std::uint32_t page : pages) centres.include(rows[page].box.centre());
  if (centres.empty()) return half;
  const glm::vec3 size = centres.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto key = [&](std::uint32_t page) {
    return std::pair(rows[page].box.centre()[axis], page);
  };
  std::nth_element(pages.begin(), pages.begin() + static_cast<std::ptrdiff_t>(half), pages.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return half;
}

// Cells that have few of the triangles leave them to the one that has most, in place of pages that
// are nearly empty and narrow strips between borders.
void give_small_shares(std::span<std::uint32_t> cell_of_triangle) {
  std::unordered_map<std::uint32_t, std::uint32_t> sizes;
  for (const std::uint32_t cell : cell_of_triangle) ++sizes[cell];
  std::uint32_t largest = 0, most = 0;
  for (const std::uint32_t cell : cell_of_triangle) {
    if (const std::uint32_t size = sizes[cell]; size > most) {
      most = size;
      largest = cell;
    }
  }
  for (std::uint32_t& cell : cell_of_triangle)
    if (sizes[cell] < kClusterTriangles) cell = largest;
}

}  // namespace

std::vector<CellRun> order_by_cell(const Cells& cells, scenes::Mesh& mesh, SurfaceErrors& errors) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::uint32_t> cell(count), order(count), number(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    constexpr float kThird = 1.0F / 3.0F;
    cell[t] = cells.cell_of(mesh.positions[v.x] * kThird + mesh.positions[v.y] * kThird +
                            mesh.positions[v.z] * kThird);
  }
  give_small_shares(cell);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return cell[a] < cell[b]; });
  std::vector<glm::uvec3> triangles(count);
  std::vector<float> of_triangles(count);
  std::vector<CellRun> runs;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t t = order[i];
    number[t] = i;
    triangles[i] = mesh.triangles[t];
    of_triangles[i] = errors.triangles[t];
    if (runs.empty() || runs.back().cell != cell[t]) runs.push_back({cell[t], i});
    runs.back().end = i + 1;
  }
  mesh.triangles = std::move(triangles);
  errors.triangles = std::move(of_triangles);
  for (std::uint32_t& nearest : errors.nearest)
    if (nearest != scenes::kNone) nearest = number[nearest];
  for (auto& [simplified, fine] : errors.beneath) simplified = number[simplified];
  return runs;
}

std::vector<std::uint32_t> nested_cells(std::span<const PageRow> rows, PageRange pages) {
  std::vector<std::uint32_t> order(pages.count), cells(pages.count);
  std::iota(order.begin(), order.end(), pages.first);
  // In halves as long as there are more than half as many pages again as a group should have, as
  // both halves of those would have fewer than they should by as much.
  std::vector<std::size_t> ends{order.size()};
  while (order.size() * 2 > ends.size() * kGroupPages * 3) {
    std::vector<std::size_t> halves;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      const auto part = std::span(order).subspan(begin, end - begin);
      halves.push_back(begin + cut_in_half(rows, part));
      halves.push_back(end);
      begin = end;
    }
    ends = std::move(halves);
  }
  std::size_t begin = 0;
  for (std::uint32_t cell = 0; cell < ends.size(); begin = ends[cell++])
    for (std::size_t i = begin; i < ends[cell]; ++i) cells[order[i] - pages.first] = cell;
  return cells;
}

std::vector<std::vector<std::uint32_t>> page_groups(std::uint32_t first,
                                                    std::span<const std::uint32_t> cell_of_page) {
  constexpr std::size_t kMost = 2 * kGroupPages;
  std::vector<std::uint32_t> pages(cell_of_page.size());
  std::iota(pages.begin(), pages.end(), 0U);
  std::stable_sort(pages.begin(), pages.end(), [&](std::uint32_t a, std::uint32_t b) {
    return cell_of_page[a] < cell_of_page[b];
  });
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const bool is_new = i == 0 || cell_of_page[pages[i]] != cell_of_page[pages[i - 1]];
    if (is_new || groups.back().size() == kMost) groups.emplace_back();
    groups.back().push_back(first + pages[i]);
  }
  return groups;
}

}  // namespace delray::packs::internal
