// The header of files of the Point Cloud Library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "delaunay/files/quantity.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {

enum class PcdEncoding { ascii, binary, compressed };

// A number of a point. Fields of several numbers, and those that are not read, are kSkipped.
struct PcdField {
  Quantity quantity = kSkipped;
  bool packed_colour = false;  // red, green and blue are bytes of one number; quantity is kRed
  char type = 'F';             // F: floating point, I: integer, U: without sign
  std::size_t size = 4;        // of one number, in bytes
  std::size_t count = 1;       // of numbers
  std::size_t offset = 0;      // in a record
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t record_size = 0;
  std::uint64_t points = 0;  // as announced
  PcdEncoding encoding = PcdEncoding::ascii;
  TextPlace body;  // behind the header

  bool has(Quantity quantity) const;
};

// PCD 0.5 to 0.7. `start` is the file, or as much of it as has the header. Throws FileError with
// the line at fault, also for fields without x or y.
PcdHeader parse_pcd_header(const Input& start);

// The number of a field at `data`, unaligned.
double pcd_number(const PcdField& field, const char* data);

}  // namespace delray::delaunay
