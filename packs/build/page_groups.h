// Which neighbouring pages are simplified together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "packs/page.h"

namespace delray::packs::internal {

// Pages in a group at most; about half as many at least, where there are so many. Of more, the
// largest error among them keeps more from being drawn simplified than borders that stay cost: of a
// terrain of 10^6 triangles at a pixel of error 0.40 were drawn with 4, 0.46 with 8,
// 0.54 with 16 (before a tenth was added to errors).
inline constexpr std::size_t kGroupPages = 4;

// The pages of a level in groups, each in ascending order. Levels are cut at other places than the
// one before, so that a border between groups, which stays as it is, is within a group on the next
// level. O(pages log pages).
std::vector<std::vector<std::uint32_t>> page_groups(std::span<const PageRow> rows, PageRange pages,
                                                    int level);

}  // namespace delray::packs::internal
