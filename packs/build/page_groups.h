// Which neighbouring pages are simplified together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "packs/build/surface_error.h"
#include "packs/page.h"

namespace delray::packs::internal {

// Space cut by planes into cells with about as many triangles each.
class Cells {
 public:
  Cells() = default;
  // Some `triangles` in each, as the boxes of the pages have them. Odd and even levels are cut at
  // different places. O(pages log pages).
  Cells(std::span<const PageRow> rows, PageRange pages, double triangles, int level);

  std::size_t count() const { return cells_; }
  std::uint32_t cell_of(const glm::vec3& place) const;  // O(log cells)

 private:
  struct Plane {
    int axis = 0;  // of which lower coordinates than `at` are before it
    float at = 0;
    std::uint32_t before = 0, behind = 0;  // a plane, or a cell and kCell
  };
  static constexpr std::uint32_t kCell = 0x80000000U;

  std::uint32_t cut(std::span<const PageRow> rows, std::span<std::uint32_t> pages, double triangles,
                    int level, unsigned cut_axes);

  std::vector<Plane> planes_;  // the first is the root
  std::uint32_t cells_ = 1;
};

// Triangles up to `end` are of a cell.
struct CellRun {
  std::uint32_t cell, end;
};

// Brings the triangles of a mesh into the order of the cells that their middles are in, and what is
// known of them, too; those of one cell stay in order. Returns the runs of cells. Cells with fewer
// than kClusterTriangles leave them to another. O(triangles log triangles).
std::vector<CellRun> order_by_cell(const Cells& cells, scenes::Mesh& mesh, SurfaceErrors& errors);

// Full pages that a group has about. Of more, the largest error among them keeps more from being
// drawn simplified; of fewer, borders that stay do: of a terrain of 2x10^7 triangles on 600 000
// pixels, at a pixel of error, 1.55x10^6 were drawn with 2, 1.29 with 3, 1.39 with 4, 1.75 with 8
// (of pages that were less full the fewer these are).
inline constexpr std::size_t kGroupPages = 4;

// Cells that are halves of larger ones: of each page its cell, of kGroupPages about, numbered so
// that cells 2 i and 2 i + 1 are the halves of one, and so on. Nested cells suit what has no
// borders that have to be cut elsewhere on the next level: a group is where those are that it was
// made of. O(pages log pages).
std::vector<std::uint32_t> nested_cells(std::span<const PageRow> rows, PageRange pages);

// Pages with the same cell, of pages `first` on, in groups, each in ascending order and of
// 2 kGroupPages at most.
std::vector<std::vector<std::uint32_t>> page_groups(std::uint32_t first,
                                                    std::span<const std::uint32_t> cell_of_page);

}  // namespace delray::packs::internal
