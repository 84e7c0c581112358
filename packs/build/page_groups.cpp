// Halves pages across the longest side of the box around their centres, until they are few: in the
// middle on even levels, at a third and two thirds in turn on odd ones (alternate groupings:
// Ponchio 2008).
#include "packs/build/page_groups.h"

#include <algorithm>
#include <numeric>

namespace delray::packs::internal {
namespace {

using Numbers = std::span<std::uint32_t>;

void cut(std::span<const PageRow> rows, Numbers pages, int level, int depth,
         std::vector<std::vector<std::uint32_t>>& groups) {
  if (pages.size() <= kGroupPages) {
    groups.emplace_back(pages.begin(), pages.end());
    std::sort(groups.back().begin(), groups.back().end());
    return;
  }
  geometry::Box3 centres;
  for (const std::uint32_t page : pages) centres.include(rows[page].box.centre());
  const glm::vec3 size = centres.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::size_t first = pages.size() / 2;
  if (level % 2 == 1) first = depth % 2 == 0 ? pages.size() / 3 : pages.size() - pages.size() / 3;
  std::nth_element(pages.begin(), pages.begin() + static_cast<std::ptrdiff_t>(first), pages.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float of_a = rows[a].box.centre()[axis];
                     const float of_b = rows[b].box.centre()[axis];
                     return of_a < of_b || (of_a == of_b && a < b);
                   });
  cut(rows, pages.first(first), level, depth + 1, groups);
  cut(rows, pages.subspan(first), level, depth + 1, groups);
}

}  // namespace

std::vector<std::vector<std::uint32_t>> page_groups(std::span<const PageRow> rows, PageRange pages,
                                                    int level) {
  std::vector<std::uint32_t> numbers(pages.count);
  std::iota(numbers.begin(), numbers.end(), pages.first);
  std::vector<std::vector<std::uint32_t>> groups;
  if (!numbers.empty()) cut(rows, numbers, level, 0, groups);
  return groups;
}

}  // namespace delray::packs::internal
