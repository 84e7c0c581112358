// The values of a run of rows of a PLY file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/file_bytes.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/ply_header.h"
#include "scenes/files/text_lines.h"

namespace delray::scenes::internal {

struct PlyFile {
  const Source& source;
  const files::FileBytes& bytes;
  const PlyHeader& header;

  bool is_text() const { return header.coding == PlyCoding::text; }
  bool swap() const;  // values have not the byte order of this machine
};

// Rows [first, first + rows) of an element.
struct PlyBlock {
  std::uint64_t begin = 0, bytes = 0;  // where they are
  std::uint64_t first = 0, rows = 0;
  std::uint64_t line = 1, skipped = 0;  // text: number of the first line, rows before the first
};

// A value at `data`, which need not be aligned.
double ply_value(const char* data, PlyType type, bool swap);

// Hands out the values of a block one after the other, from text or binary.
class PlyRows {
 public:
  PlyRows(const PlyFile& file, const PlyBlock& block);

  void start_row();
  double next(PlyType type);
  void next_list(const PlyProperty& property, std::vector<double>& values);
  // Fails where a line of text has more values.
  void end_row();
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const PlyFile& file_;
  PlyBlock block_;
  GrowthWatch watch_;
  bool is_text_, swap_;
  std::string buffer_;
  std::string_view rest_;
  Lines lines_;
  Words words_{""};
};

}  // namespace delray::scenes::internal
