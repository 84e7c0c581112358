// What the pages of a coarser level stand for: triangles of a finer one, which their error is
// measured against.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "files/unnamed_file.h"

namespace delray::packs::internal {

// A triangle of a page, and which of its corners (bit k: corner k) are nearest to triangles of the
// page that stands for it. Others are nearest to a neighbour of that.
struct Reference {
  std::uint32_t page = 0;
  std::uint16_t triangle = 0;
  std::uint8_t corners = 0;
};

// Two bytes each, and eight for each page that they are of. REQUIRES: ascending by page; triangles
// are below 2^13.
std::vector<std::byte> encode(std::span<const Reference> references);

// The references of the pages of one level, one list for each, on disk: some thousand a page.
class ReferenceLists {
 public:
  // In a file without a name in the folder. Throws FileError (device), as all of it does.
  explicit ReferenceLists(const std::filesystem::path& folder);

  // Of the next page, as encode() has it.
  void append(std::span<const std::byte> list);
  // Appends those of the i-th page. Any thread, while nobody appends.
  void read(std::size_t i, std::vector<Reference>& to) const;

 private:
  files::UnnamedFile file_;
  std::vector<std::uint64_t> ends_;  // in the file, by page
};

}  // namespace delray::packs::internal
