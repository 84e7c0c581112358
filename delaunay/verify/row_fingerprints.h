// Whether two streams of (row, place) are the same set, in constant memory but for a bit a row.
//
// Each pair is hashed with a secret of this run (XXH3, 128 bits) and added to the sum of its range
// of rows, modulo 2^64 in both halves. Sets that are not equal have equal sums with probability
// 2^-128: nobody can prepare a set against a secret that is not known yet (Carter and Wegman 1979).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

class RowFingerprints {
 public:
  // Of rows below `rows`; `coordinates` of places, from the one numbered `first`.
  RowFingerprints(std::uint64_t rows, int first, int coordinates);

  // Adds a pair. Any thread.
  void add_mesh(const RowPoint& point) { add(mesh_, point); }
  void add_points(const RowPoint& point) { add(points_, point); }
  // The first range of rows whose sums are different: from, and until before.
  struct Range {
    std::uint64_t first, last;
  };
  std::optional<Range> first_difference() const;

 private:
  struct Sum {
    std::uint64_t low = 0, high = 0;
  };
  void add(std::vector<Sum>& sums, const RowPoint& point) const;

  static constexpr std::size_t kSecretBytes = 192;
  std::uint64_t rows_;
  int shift_, first_, coordinates_;
  std::array<std::uint8_t, kSecretBytes> secret_;
  std::vector<Sum> mesh_, points_;
};

// A bit for each row.
class RowMarks {
 public:
  explicit RowMarks(std::uint64_t rows) : words_((rows + 63) / 64) {}
  // Whether it was not marked before. Any thread.
  bool mark(std::uint64_t row);
  bool is_marked(std::uint64_t row) const { return (words_[row / 64] >> row % 64 & 1) != 0; }
  // The first marked one from `row` on.
  std::optional<std::uint64_t> next(std::uint64_t row) const;

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace delray::delaunay::internal
