// Writes LAZ files for tests: an encoder of its own, beside the decoder's models of probability.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace delray::tests {

// A LAS file to be written: records of a point format, one after the other.
struct LasFile {
  unsigned format = 0;  // 0 to 10
  std::size_t extra_bytes = 0;
  std::string records;

  std::size_t record_size() const;
  std::size_t count() const { return records.size() / record_size(); }
};

struct LazOptions {
  std::vector<std::size_t> chunks;  // their numbers of points; the last may be smaller
  bool variable = false;            // chunks of several sizes
  int version = 3;                  // of layered items: 3 or 4
  bool table_at_end = false;        // the place of the table of chunks is behind it
};

// The file as LAS 1.4 (1.2 for the formats before 6), coordinates in steps of 0.01.
std::string encode_las(const LasFile& file);
// As LAZ. REQUIRES: format 0 to 3 or 6 to 8.
std::string encode_laz(const LasFile& file, const LazOptions& options);

}  // namespace delray::tests
