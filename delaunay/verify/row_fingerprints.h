// Whether two streams of (row, place) are the same set, in constant memory but for a bit a row.
//
// Each pair is hashed with a secret of this run (XXH3, 128 bits) and added to the sum of its range
// of rows, modulo 2^64 in both halves. Sets that are not equal have equal sums with probability
// 2^-128: nobody can prepare a set against a secret that is not known yet (Carter and Wegman 1979).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

class RowFingerprints {
 public:
  // Of rows below `rows`; `coordinates` of places, from the one numbered `first`. Collective: the
  // secret is that of rank 0.
  RowFingerprints(comm::Communicator& communicator, std::uint64_t rows, int first, int coordinates);

  // Adds a pair. Any thread.
  void add_mesh(const RowPoint& point) { add(mesh_, point); }
  void add_points(const RowPoint& point) { add(points_, point); }
  // Collective: the sums of all ranks.
  void add_up(comm::Communicator& communicator);
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

  // The bits of rows [first, last), 64 to a word, those of row 64 i in word i, without others.
  std::vector<std::uint64_t> words(std::uint64_t first, std::uint64_t last) const;
  // Marks such bits as well, and returns the lowest row that was marked before, if any.
  std::optional<std::uint64_t> merge(std::uint64_t first, std::span<const std::uint64_t> words);
  // Forgets all but rows [first, last).
  void keep(std::uint64_t first, std::uint64_t last);

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace delray::delaunay::internal
