// Sorts points by the cells of a grid and drops duplicates, in memory little larger than the
// result.
//
// A first pass counts the points in coarse squares; squares that follow each other along the curve
// share a bucket until it has enough points for the second-level cache. A second pass scatters the
// points to the buckets, and each bucket is then sorted by cell number with two counting passes on
// the highest bits that differ. O(n) unless clusters are nested very deeply.
//
// Degenerate: a cell with many points is ordered by a grid over its own bounding box, recursively;
// few points of one cell are sorted lexicographically, and of equal points the lowest row stays.
#include "delaunay/order/cell_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "delaunay/mesh/blocks.h"
#include "delaunay/order/finite_points.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

// A cell number above an index, so that one comparison orders both.
using Entry = std::uint64_t;

constexpr std::uint32_t cell_of(Entry entry) { return static_cast<std::uint32_t>(entry >> 32); }
constexpr std::uint32_t index_of(Entry entry) { return static_cast<std::uint32_t>(entry); }

// Points with their rows, side by side.
struct Rows {
  std::span<glm::dvec2> points;
  std::span<std::uint32_t> rows;

  Rows part(std::size_t first, std::size_t count) const {
    return {points.subspan(first, count), rows.subspan(first, count)};
  }
};

// Memory for ordering one bucket after the other, kept between them.
struct Scratch {
  std::vector<glm::dvec2> points;
  std::vector<std::uint32_t> rows;
  std::vector<Entry> entries, spare;

  void make_room(std::size_t n) {
    if (points.size() >= n) return;
    points.resize(n);
    rows.resize(n);
    entries.resize(n);
    spare.resize(n);
  }
};

std::size_t order_cell(const Rows& all);

// Sorts few entries, which stay in the cache, by the sixteen highest bits in which cells differ,
// and those that have them in common by the rest. Returns where the result is.
std::span<const Entry> sort_cells(std::span<Entry> entries, std::span<Entry> spare, Entry differ) {
  constexpr int kDigitBits = 8;
  constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
  constexpr Entry kMask = kValues - 1;
  const int high = std::max(static_cast<int>(std::bit_width(differ)) - kDigitBits, 0);
  const int low = std::max(high - kDigitBits, 0);
  std::array<std::array<std::uint32_t, kValues>, 2> places = {};
  for (const Entry entry : entries) {
    ++places[0][entry >> low & kMask];
    ++places[1][entry >> high & kMask];
  }
  std::array<std::uint32_t, 2> place = {};
  for (std::size_t value = 0; value < kValues; ++value) {
    place[0] += std::exchange(places[0][value], place[0]);
    place[1] += std::exchange(places[1][value], place[1]);
  }
  for (const Entry entry : entries) spare[places[0][entry >> low & kMask]++] = entry;
  for (const Entry entry : spare) entries[places[1][entry >> high & kMask]++] = entry;
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i - 1] <= entries[i]) continue;
    std::size_t first = i - 1, last = i + 1;
    const auto same = [&](Entry entry) { return (entry ^ entries[i]) >> low == 0; };
    while (first > 0 && same(entries[first - 1])) --first;
    while (last < entries.size() && same(entries[last])) ++last;
    std::sort(entries.begin() + first, entries.begin() + last);
    i = last - 1;
  }
  return entries;
}

// Orders points by the cells of a grid and drops duplicates; returns how many are left.
std::size_t order_by_grid(const Rows& all, const CellGrid& grid, Scratch& scratch) {
  const std::size_t n = all.points.size();
  scratch.make_room(n);
  Entry differ = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 p = all.points[i];
    scratch.points[i] = p;
    scratch.rows[i] = all.rows[i];
    scratch.entries[i] = Entry{grid.number(p)} << 32 | i;
    differ |= scratch.entries[i] ^ scratch.entries[0];
  }
  const std::span<const Entry> sorted =
      sort_cells(std::span(scratch.entries).first(n), std::span(scratch.spare).first(n), differ);
  std::size_t kept = 0;
  for (std::size_t next = 0; next < n;) {
    const std::uint32_t cell = cell_of(sorted[next]);
    std::size_t count = 0;
    do {
      const std::uint32_t i = index_of(sorted[next++]);
      all.points[kept + count] = scratch.points[i];
      all.rows[kept + count] = scratch.rows[i];
      ++count;
    } while (next < n && cell_of(sorted[next]) == cell);
    if (count > 1) count = order_cell(all.part(kept, count));
    kept += count;
  }
  return kept;
}

struct RowPoint {
  glm::dvec2 point;
  std::uint32_t row;
};

// Orders the points of one cell and drops duplicates; returns how many are left.
std::size_t order_cell(const Rows& all) {
  std::size_t n = all.points.size();
  if (n > kSmallCell) {
    const Box2d box = box_of(all.points);
    if (box.low == box.high) {
      all.rows[0] = *std::ranges::min_element(all.rows);
      return 1;
    }
    Scratch scratch;
    n = order_by_grid(all, CellGrid(box), scratch);
    if (n > kSmallCell) return n;
  }
  // Nearly all cells with more than one point have two or three.
  std::array<RowPoint, kSmallCell> few;
  const std::span<RowPoint> sorted(few.data(), n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = {all.points[i], all.rows[i]};
  std::ranges::sort(sorted, [](const RowPoint& a, const RowPoint& b) {
    return a.point == b.point ? a.row < b.row : lexicographically_less(a.point, b.point);
  });
  std::size_t kept = 0;
  for (const RowPoint& p : sorted) {
    if (kept > 0 && all.points[kept - 1] == p.point) continue;
    all.points[kept] = p.point;
    all.rows[kept++] = p.row;
  }
  return kept;
}

// Neighbours along the curve that are assigned together.
class Buckets {
 public:
  // Counts the points in squares of cells.
  Buckets(const PointView<double>& points, const CellGrid& grid, const Blocks& blocks)
      : blocks_(blocks),
        bits_(std::clamp((static_cast<int>(std::bit_width(points.size())) - 6) / 2, 1, kMostBits)) {
    const std::size_t squares = std::size_t{1} << 2 * bits_;
    std::vector<Array<std::uint32_t>> counts(blocks.count());
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      auto& count = counts[block] = Array<std::uint32_t>(squares);
      std::fill_n(count.data(), squares, 0U);
      for (std::size_t row = first; row < last; ++row) {
        ++count[grid.square(point_at(points, row), bits_)];
      }
    });
    assign_squares(counts);
    places_.resize(blocks.count());
    blocks.for_each([&](std::size_t block, std::size_t, std::size_t) {
      places_[block].assign(begin_.size(), 0);
      for (std::size_t square = 0; square < squares; ++square) {
        places_[block][bucket_of_[square]] += counts[block][square];
      }
    });
    for (std::size_t bucket = 0; bucket + 1 < begin_.size(); ++bucket) {
      std::uint32_t place = begin_[bucket];
      for (auto& places : places_) place += std::exchange(places[bucket], place);
    }
  }

  // Bucket i has the points [begin()[i], begin()[i + 1]).
  std::span<const std::uint32_t> begin() const { return begin_; }

  // Copies every point to its bucket. May be called once.
  void scatter(const PointView<double>& points, const CellGrid& grid, CellOrder& order) {
    blocks_.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      auto& places = places_[block];
      for (std::size_t row = first; row < last; ++row) {
        const glm::dvec2 p = point_at(points, row);
        const std::uint32_t place = places[bucket_of_[grid.square(p, bits_)]]++;
        order.points[place] = p;
        order.rows[place] = static_cast<std::uint32_t>(row);
      }
    });
  }

 private:
  static constexpr int kMostBits = 8;
  // Points of a bucket and what ordering them needs stay in the second-level cache.
  static constexpr std::size_t kPoints = 2048;
  // So many places can be written to in turn without missing translations and caches too often.
  static constexpr std::size_t kMost = 2048;

  // Squares that follow each other along the curve share a bucket while they have few points.
  void assign_squares(const std::vector<Array<std::uint32_t>>& counts) {
    const std::size_t enough = std::max(kPoints, blocks_.size() / kMost);
    const std::uint32_t squares = std::uint32_t{1} << 2 * bits_;
    bucket_of_.resize(squares);
    std::uint32_t end = 0;
    begin_ = {0};
    for (std::uint32_t place = 0; place < squares; ++place) {
      const std::size_t square = CellGrid::square_at(place, bits_);
      std::uint32_t count = 0;
      for (const auto& of_block : counts) count += of_block[square];
      if (end > begin_.back() && end + count - begin_.back() > enough) begin_.push_back(end);
      bucket_of_[square] = static_cast<std::uint16_t>(begin_.size() - 1);
      end += count;
    }
    begin_.push_back(end);
  }

  Blocks blocks_;
  int bits_;                                        // 2^bits_ squares across
  std::vector<std::uint16_t> bucket_of_;            // of each square
  std::vector<std::uint32_t> begin_;                // of each bucket, and the end of the last
  std::vector<std::vector<std::uint32_t>> places_;  // where a block's next point of a bucket goes
};

// Orders the points of each bucket; drops the duplicates from the whole.
void order_buckets(std::span<const std::uint32_t> begin, const CellGrid& grid, const Blocks& blocks,
                   CellOrder& order) {
  struct Range {
    std::size_t first, count;
  };
  std::vector<Range> ordered(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t from, std::size_t to) {
    const auto own = [&](std::size_t i) { return std::ranges::lower_bound(begin, i); };
    Scratch scratch;
    const Rows all{{order.points.data(), order.points.size()},
                   {order.rows.data(), order.rows.size()}};
    std::size_t kept = *own(from);
    ordered[block].first = kept;
    for (auto bucket = own(from); bucket != own(to); ++bucket) {
      const std::size_t first = *bucket;
      const Rows part = all.part(first, *(bucket + 1) - first);
      const std::size_t count = order_by_grid(part, grid, scratch);
      if (kept != first) {
        std::copy_n(part.points.begin(), count, all.points.begin() + kept);
        std::copy_n(part.rows.begin(), count, all.rows.begin() + kept);
      }
      kept += count;
    }
    ordered[block].count = kept - ordered[block].first;
  });
  std::size_t kept = 0;
  for (const auto& [first, count] : ordered) {
    if (kept != first) {
      std::copy_n(order.points.data() + first, count, order.points.data() + kept);
      std::copy_n(order.rows.data() + first, count, order.rows.data() + kept);
    }
    kept += count;
  }
  order.points.shrink(kept);
  order.rows.shrink(kept);
}

}  // namespace

CellOrder cell_order(PointView<double> points, int threads) {
  const std::size_t n = points.size();
  CellOrder order;
  if (n == 0) return order;
  const Blocks blocks(n, threads);
  order.box = finite_box(points, threads);
  const CellGrid grid(order.box);
  order.points = Array<glm::dvec2>(n);
  order.rows = Array<std::uint32_t>(n);
  Buckets buckets(points, grid, blocks);
  buckets.scatter(points, grid, order);
  order_buckets(buckets.begin(), grid, blocks, order);
  return order;
}

}  // namespace delray::delaunay::internal
