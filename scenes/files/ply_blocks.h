// Where runs of rows of a PLY file are, so that they can be read at the same time.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/files/ply_header.h"
#include "scenes/files/ply_rows.h"

namespace delray::scenes::internal {

// Finds blocks of the elements of a body one after the other. Elements without lists are cut at
// multiples of their size; where there are lists, or the body is text, it is passed over.
class PlyBlocks {
 public:
  PlyBlocks(const PlyFile& file);

  // The next element's. Where the file ends before, or a list cannot be as long as it says, the
  // last block has all that is left, and reading it fails. Binary.
  std::vector<PlyBlock> next(const PlyElement& element);
  // As above if all lists of the element are as long as those of its first row, of which it must
  // have one. Empty where they cannot be. Does not move on.
  std::vector<PlyBlock> even(const PlyElement& element) const;
  std::uint64_t begin() const { return at_; }
  // Fails where text has more rows than its elements.
  void require_end() const;
  // Moves on to where an element that was read otherwise ends.
  void move_to(std::uint64_t byte) { at_ = byte; }

 private:
  struct TextRange {
    std::uint64_t rows = 0, lines = 0;  // those with words, and all
  };

  std::vector<PlyBlock> next_of_text(const PlyElement& element);
  std::vector<PlyBlock> next_with_lists(const PlyElement& element);

  const PlyFile& file_;
  std::uint64_t at_;                         // binary: where the next element begins
  std::vector<std::uint64_t> range_begins_;  // text, with the end
  std::vector<std::uint64_t> rows_before_, lines_before_;
  std::uint64_t row_ = 0;  // of the next element
};

}  // namespace delray::scenes::internal
