// Cells of space, and what is in the same one.
#include "packs/build/page_groups.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace delray::packs::internal {
namespace {

constexpr std::uint16_t kFull = 512;

// Pages of equally many triangles at random places of a square.
std::vector<PageRow> pages_in_a_square(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0, 1);
  std::vector<PageRow> rows(static_cast<std::size_t>(n));
  for (PageRow& row : rows) {
    row.triangles = kFull;
    row.box.include({place(random), place(random), 0});
  }
  return rows;
}

TEST(Cells, HaveAboutAsManyTrianglesEach) {
  for (const int level : {1, 2}) {
    const std::vector<PageRow> rows = pages_in_a_square(3000, 7);
    const Cells cells(rows, {0, 3000}, 8.0 * kFull, level);
    std::vector<int> pages(cells.count(), 0);
    for (const PageRow& row : rows) ++pages[cells.cell_of(row.box.centre())];
    EXPECT_NEAR(static_cast<double>(cells.count()), 375, 40);
    EXPECT_GE(*std::ranges::min_element(pages), 4);
    EXPECT_LE(*std::ranges::max_element(pages), 16);
  }
}

// How often two places that are close and in different cells are so on the next levels, too.
TEST(Cells, AreCutElsewhereOnTheNextLevel) {
  const std::vector<PageRow> rows = pages_in_a_square(4000, 9);
  std::vector<Cells> levels;
  for (int level = 1; level <= 3; ++level)
    levels.emplace_back(rows, PageRange{0, 4000}, 4.0 * kFull * (1 << level), level);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 1);
  std::array<int, 2> cut{};
  int all = 0;
  for (int i = 0; i < 200'000; ++i) {
    const glm::vec3 a(place(random), place(random), 0), b = a + glm::vec3(2e-4F, 2e-4F, 0);
    const auto is_cut = [&](const Cells& cells) { return cells.cell_of(a) != cells.cell_of(b); };
    if (!is_cut(levels[0])) continue;
    ++all;
    for (std::size_t k = 0; k < 2; ++k) cut[k] += is_cut(levels[k + 1]);
  }
  ASSERT_GT(all, 1000);
  EXPECT_LT(cut[0], all / 20);
}

TEST(Cells, AreFewWherePlacesAre) {
  std::vector<PageRow> rows(100);
  for (PageRow& row : rows) {
    row.triangles = kFull;
    row.box.include({1, 2, 3});
  }
  EXPECT_EQ(Cells(rows, {0, 100}, kFull, 1).count(), 1U);
  EXPECT_EQ(Cells(rows, {0, 0}, kFull, 1).count(), 1U);
  rows[7].box = {};
  rows[7].box.include({4, 2, 3});
  EXPECT_EQ(Cells(rows, {0, 100}, kFull, 1).count(), 2U);
  EXPECT_EQ(Cells().cell_of({5, 5, 5}), 0U);
}

TEST(NestedCells, AreHalvesOfLargerOnes) {
  for (const int n : {1, 6, 7, 100, 1000, 3000}) {
    const std::vector<PageRow> rows = pages_in_a_square(n, 7);
    std::vector<std::uint32_t> cells = nested_cells(rows, {0, static_cast<std::uint32_t>(n)});
    for (std::uint32_t count = 1 + *std::ranges::max_element(cells);; count /= 2) {
      std::vector<geometry::Box3> boxes(count);
      std::vector<std::uint32_t> sizes(count, 0);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        boxes[cells[i]].include(rows[i].box);
        ++sizes[cells[i]];
      }
      double area = 0;
      for (const geometry::Box3& box : boxes)
        area += static_cast<double>(box.size().x) * static_cast<double>(box.size().y);
      EXPECT_LE(area, 1) << n << ' ' << count;
      EXPECT_LE(*std::ranges::max_element(sizes) - *std::ranges::min_element(sizes),
                static_cast<std::uint32_t>(n) / count / 2 + 1);
      if (count == 1) break;
      EXPECT_EQ(count % 2, 0U);
      for (std::uint32_t& cell : cells) cell /= 2;
    }
  }
}

TEST(NestedCells, HaveSoManyPages) {
  for (std::uint32_t n = 1; n < 300; ++n) {
    const std::vector<PageRow> rows = pages_in_a_square(static_cast<int>(n), n);
    std::map<std::uint32_t, std::size_t> sizes;
    for (const std::uint32_t cell : nested_cells(rows, {0, n})) ++sizes[cell];
    for (const auto& [cell, size] : sizes) {
      EXPECT_LE(size, kGroupPages * 3 / 2 + 1) << n;
      EXPECT_GE(size, std::min<std::size_t>(n, kGroupPages * 3 / 4)) << n;
    }
  }
  std::vector<PageRow> rows = pages_in_a_square(100, 1);
  for (PageRow& row : rows) row.box = rows[0].box;  // at one place
  const std::vector<std::uint32_t> cells = nested_cells(rows, {0, 100});
  EXPECT_EQ(*std::ranges::max_element(cells), 31U);
  EXPECT_TRUE(nested_cells(rows, {0, 0}).empty());
}

TEST(OrderByCell, KeepsTrianglesAndWhatIsKnownOfThem) {
  const std::vector<PageRow> rows = pages_in_a_square(64, 3);
  const Cells cells(rows, {0, 64}, 8.0 * kFull, 2);
  ASSERT_GT(cells.count(), 4U);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(0, 1);
  scenes::Mesh mesh;
  SurfaceErrors errors;
  const std::uint32_t count = 5000;
  for (std::uint32_t t = 0; t < count; ++t) {
    const glm::vec3 at(place(random), place(random), 0);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + glm::vec3(0, 0, k));
    mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    errors.triangles.push_back(static_cast<float>(t));
    errors.nearest.push_back(t);
    errors.beneath.emplace_back(t, t);
  }
  const auto runs = order_by_cell(cells, mesh, errors);
  ASSERT_EQ(mesh.triangles.size(), count);
  std::set<std::uint32_t> seen;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t was = mesh.triangles[t].x / 3;
    seen.insert(was);
    EXPECT_EQ(errors.triangles[t], static_cast<float>(was));
    EXPECT_EQ(errors.nearest[was], t);
    EXPECT_EQ(errors.beneath[was], (std::pair{t, was}));
  }
  EXPECT_EQ(seen.size(), count);
  ASSERT_FALSE(runs.empty());
  EXPECT_EQ(runs.back().end, count);
  std::uint32_t begin = 0, elsewhere = 0;
  std::set<std::uint32_t> of_runs;
  for (const CellRun& run : runs) {
    EXPECT_TRUE(of_runs.insert(run.cell).second);
    EXPECT_GE(run.end - begin, kClusterTriangles);
    for (; begin < run.end; ++begin)
      elsewhere += cells.cell_of(mesh.positions[mesh.triangles[begin].x]) != run.cell ? 1 : 0;
  }
  EXPECT_LT(elsewhere, cells.count() * kClusterTriangles);
}

TEST(PageGroups, AreOfOneCellAndNotTooLarge) {
  std::mt19937 random(6);
  std::vector<std::uint32_t> cells(500);
  for (std::uint32_t& cell : cells) cell = random() % 40;
  for (std::size_t i = 0; i < 100; ++i) cells[5 * i] = 40;
  std::set<std::uint32_t> pages;
  for (const std::vector<std::uint32_t>& group : page_groups(1000, cells)) {
    ASSERT_FALSE(group.empty());
    EXPECT_LE(group.size(), 2 * kGroupPages);
    EXPECT_TRUE(std::ranges::is_sorted(group));
    for (const std::uint32_t page : group) {
      EXPECT_EQ(cells[page - 1000], cells[group.front() - 1000]);
      EXPECT_TRUE(pages.insert(page).second);
    }
  }
  EXPECT_EQ(pages.size(), 500U);
}

}  // namespace
}  // namespace delray::packs::internal
